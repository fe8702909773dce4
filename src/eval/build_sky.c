/* What is behind everything: sky_sphere, background; and the air before it: fog, rainbow. */
#include "eval/build_parts.h"

typedef struct SkyDraft {
    struct {
        const Pigment **items;
        size_t count, capacity;
    } layers;
    Transform transform;
    Color emission;
} SkyDraft;

static bool on_sky_value(Reader *reader, const Argument *value, void *target) {
    SkyDraft *draft = target;
    if (value->value.kind == VALUE_SKY_SPHERE) {
        const SkySphere *sky = value->value.as.sky_sphere;
        for (size_t i = 0; i < sky->count; i++)
            *list_push(reader->context->arena, &draft->layers) = sky->layers[i];
        draft->emission = sky->emission;
        return true;
    }
    if (value->value.kind != VALUE_PIGMENT) return take_transform(value, &draft->transform);
    *list_push(reader->context->arena, &draft->layers) = value->value.as.pigment;
    return true;
}

static const Pigment *pigment_placed(BuildContext *context, const Pigment *pigment, const Transform *t) {
    if (transform_is_identity(t)) return pigment;
    Pigment *placed = arena_copy(context->arena, pigment, sizeof *pigment);
    placed->transform = transform_then(&pigment->transform, t);
    pigment_rehash(placed);
    return placed;
}

bool build_sky_sphere(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule sky_rules[] = {{"emission", WORD_COLOR, offsetof(SkyDraft, emission), NULL, false}};
    SkyDraft draft = {.transform = transform_identity(), .emission = {1, 1, 1, 0, 0}};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, sky_rules, VTS_ARRAY_COUNT(sky_rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_sky_value;
    reader.value_target = &draft;
    if (!reader_run(&reader)) return false;
    if (draft.layers.count == 0) {
        reader_error(&reader, block->word_span, "'sky_sphere' without a pigment");
        return false;
    }
    for (size_t i = 0; i < draft.layers.count; i++)
        draft.layers.items[i] = pigment_placed(context, draft.layers.items[i], &draft.transform);
    SkySphere *sky = arena_new(context->arena, SkySphere);
    *sky = (SkySphere){draft.layers.items, draft.layers.count, draft.emission};
    *out = (Value){.kind = VALUE_SKY_SPHERE, .as.sky_sphere = sky};
    return true;
}

static bool on_color(Reader *reader, const Argument *value, void *target) {
    if (value->value.kind != VALUE_COLOR && value->value.kind != VALUE_VECTOR && value->value.kind != VALUE_FLOAT)
        return false;
    argument_color(reader, value, arena_printf(reader->context->arena, "'%s'", reader->block->word->text),
                   target);
    return true;
}

/* background { [background { … }] [colour] } */
bool background_read(BuildContext *context, const EvalBlock *block, Color *out) {
    Reader reader = reader_begin(context, block);
    Word declared;
    if (reader_take_word(&reader, "background", &declared) && !background_read(context, declared.body, out))
        return false;
    const BlockItem *item = reader_peek(&reader);
    if (item && item->kind == ITEM_VALUE &&
        on_color(&reader, &(Argument){item->value, item->span}, out))
        reader.next++;
    return reader_run(&reader);
}

typedef struct FogDraft {
    Fog fog;
    Pigment turbulence; /* of it the words of turbulence alone */
} FogDraft;

static bool on_fog_value(Reader *reader, const Argument *value, void *target) {
    FogDraft *draft = target;
    Transform ignored = transform_identity();
    if (value->value.kind == VALUE_FOG) {
        draft->fog = *value->value.as.fog;
        if (draft->fog.turbulence) draft->turbulence = *draft->fog.turbulence;
        return true;
    }
    return take_transform(value, &ignored) || on_color(reader, value, &draft->fog.color);
}

static void read_fog_type(Reader *reader, const Word *word, void *target) {
    double type = 1;
    if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &type)) ((FogDraft *)target)->fog.ground = type == 2;
}

static void read_octaves(Reader *reader, const Word *word, void *target) {
    double octaves = 6;
    if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &octaves))
        ((FogDraft *)target)->turbulence.octaves = double_to_int(octaves, 1, 10);
}

bool build_fog(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule fog_rules[] = {
        {"distance", WORD_FLOAT, offsetof(FogDraft, fog.distance), NULL, false},
        {"fog_type", WORD_CUSTOM, 0, read_fog_type, false},
        {"fog_offset", WORD_FLOAT, offsetof(FogDraft, fog.offset), NULL, false},
        {"fog_alt", WORD_FLOAT, offsetof(FogDraft, fog.altitude), NULL, false},
        {"turbulence", WORD_VECTOR, offsetof(FogDraft, turbulence.turbulence), NULL, false},
        {"turb_depth", WORD_FLOAT, offsetof(FogDraft, fog.turbulence_depth), NULL, false},
        {"octaves", WORD_CUSTOM, 0, read_octaves, false},
        {"omega", WORD_FLOAT, offsetof(FogDraft, turbulence.omega), NULL, false},
        {"lambda", WORD_FLOAT, offsetof(FogDraft, turbulence.lambda), NULL, false},
        {"up", WORD_VECTOR, offsetof(FogDraft, fog.up), NULL, false},
    };
    FogDraft draft = {.fog = {.up = {0, 1, 0}, .turbulence_depth = 0.5}, .turbulence = pigment_default()};
    Transform turned = transform_identity();
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, fog_rules, VTS_ARRAY_COUNT(fog_rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &turned);
    reader.on_value = on_fog_value;
    reader.value_target = &draft;
    if (!reader_run(&reader)) return false;
    Fog *fog = arena_copy(context->arena, &draft.fog, sizeof draft.fog);
    fog->span = block->span;
    fog->up = vec3_normalize(transform_vector(&turned, fog->up));
    if (!(fog->altitude > 0)) fog->ground = false;
    if (!draft.turbulence.noise_generator) draft.turbulence.noise_generator = build_noise_generator(context);
    if (vec3_length_squared(draft.turbulence.turbulence) > 0)
        fog->turbulence = arena_copy(context->arena, &draft.turbulence, sizeof draft.turbulence);
    if (fog->distance <= 0)
        diag_warning(context->diags, block->word_span, "this fog has no distance greater than 0: it has no effect");
    *out = (Value){.kind = VALUE_FOG, .as.fog = fog};
    return true;
}

typedef struct RainbowDraft {
    Rainbow bow;
    const ColorMap *map;
    double arc, falloff; /* of the whole; < 0: not given */
    Transform transform;
} RainbowDraft;

static bool on_rainbow_value(Reader *reader, const Argument *value, void *target) {
    (void)reader;
    RainbowDraft *draft = target;
    if (value->value.kind == VALUE_COLOR_MAP) draft->map = value->value.as.color_map;
    return value->value.kind == VALUE_COLOR_MAP || take_transform(value, &draft->transform);
}

/* A gradient from the inner rim to the outer. */
static const Pigment *bow_colors(const BuildContext *context, const ColorMap *map) {
    Pigment *colors = arena_new(context->arena, Pigment);
    *colors = pigment_default();
    colors->span = map->span;
    colors->kind = PATTERN_GRADIENT;
    colors->direction = vec3(1, 0, 0);
    colors->entries = map->entries;
    colors->entry_count = map->count;
    pigment_measure(colors);
    pigment_rehash(colors);
    return colors;
}

static bool finish_rainbow(Reader *reader, RainbowDraft *draft, Value *out) {
    Rainbow *bow = &draft->bow;
    BuildContext *context = reader->context;
    if (draft->arc >= 0) {
        bow->arc = draft->arc / 2;
        bow->falloff = draft->falloff >= 0 ? draft->falloff / 2 : bow->arc;
    }
    if (bow->arc >= 0 && bow->falloff > bow->arc) {
        reader_error(reader, reader->block->word_span, "the rainbow's 'falloff_angle' is larger than its 'arc_angle'");
        return false;
    }
    bow->direction = transform_vector(&draft->transform, bow->direction);
    bow->right = vec3_cross(transform_vector(&draft->transform, bow->up), bow->direction);
    if (!(vec3_length_squared(bow->direction) > 0) || !(vec3_length_squared(bow->right) > 0)) {
        reader_error(reader, reader->block->word_span, "this rainbow has no direction, or one along its 'up'");
        return false;
    }
    bow->direction = vec3_normalize(bow->direction);
    bow->right = vec3_normalize(bow->right);
    bow->up = vec3_cross(bow->direction, bow->right);
    if (draft->map) bow->colors = bow_colors(context, draft->map);
    bow->span = reader->block->word_span;
    *out = (Value){.kind = VALUE_RAINBOW, .as.rainbow = arena_copy(context->arena, bow, sizeof *bow)};
    return true;
}

bool build_rainbow(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule rules[] = {
        {"direction", WORD_VECTOR, offsetof(RainbowDraft, bow.direction), NULL, false},
        {"up", WORD_VECTOR, offsetof(RainbowDraft, bow.up), NULL, false},
        {"angle", WORD_FLOAT, offsetof(RainbowDraft, bow.angle), NULL, false},
        {"width", WORD_FLOAT, offsetof(RainbowDraft, bow.width), NULL, false},
        {"distance", WORD_FLOAT, offsetof(RainbowDraft, bow.distance), NULL, false},
        {"jitter", WORD_FLOAT, offsetof(RainbowDraft, bow.jitter), NULL, false},
        {"arc_angle", WORD_FLOAT, offsetof(RainbowDraft, arc), NULL, false},
        {"falloff_angle", WORD_FLOAT, offsetof(RainbowDraft, falloff), NULL, false},
    };
    RainbowDraft draft = {.bow = {.up = {0, 1, 0}, .arc = -1}, .arc = -1, .falloff = -1, .transform = transform_identity()};
    Reader reader = reader_begin(context, block);
    Argument declared;
    if (reader_take_value(&reader, VALUE_RAINBOW, &declared)) draft.bow = *declared.value.as.rainbow;
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_rainbow_value;
    reader.value_target = &draft;
    return reader_run(&reader) && finish_rainbow(&reader, &draft, out);
}
