/* What is behind everything: sky_sphere, background, fog. */
#include "eval/build_parts.h"

typedef struct SkyDraft {
    struct {
        const Pigment **items;
        size_t count, capacity;
    } layers;
    Transform transform;
} SkyDraft;

static bool on_sky_value(Reader *reader, const Argument *value, void *target) {
    SkyDraft *draft = target;
    if (value->value.kind == VALUE_SKY_SPHERE) {
        const SkySphere *sky = value->value.as.sky_sphere;
        for (size_t i = 0; i < sky->count; i++)
            *list_push(reader->context->arena, &draft->layers) = sky->layers[i];
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
    static const WordRule sky_rules[] = {{"emission", WORD_IGNORED, 0, NULL, false}};
    SkyDraft draft = {.transform = transform_identity()};
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
    *sky = (SkySphere){draft.layers.items, draft.layers.count};
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

static bool on_fog_value(Reader *reader, const Argument *value, void *target) {
    Fog *fog = target;
    Transform ignored = transform_identity();
    if (value->value.kind == VALUE_FOG) {
        *fog = *value->value.as.fog;
        return true;
    }
    return take_transform(value, &ignored) || on_color(reader, value, &fog->color);
}

static void read_fog_type(Reader *reader, const Word *word, void *target) {
    double type = 1;
    if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &type)) ((Fog *)target)->ground = type == 2;
}

bool build_fog(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule fog_rules[] = {
        {"distance", WORD_FLOAT, offsetof(Fog, distance), NULL, false},
        {"fog_type", WORD_CUSTOM, 0, read_fog_type, false},
        {"fog_offset", WORD_FLOAT, offsetof(Fog, offset), NULL, false},
        {"fog_alt", WORD_FLOAT, offsetof(Fog, altitude), NULL, false},
        {"turbulence", WORD_INERT, offsetof(Fog, inert), NULL, false},
        {"turb_depth", WORD_IGNORED, 0, NULL, false},
        {"octaves", WORD_IGNORED, 0, NULL, false},
        {"omega", WORD_IGNORED, 0, NULL, false},
        {"lambda", WORD_IGNORED, 0, NULL, false},
        {"up", WORD_VECTOR, offsetof(Fog, up), NULL, false},
    };
    Fog *fog = arena_new(context->arena, Fog);
    fog->up = vec3(0, 1, 0);
    Transform turned = transform_identity();
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, fog_rules, VTS_ARRAY_COUNT(fog_rules), fog);
    reader_add_table(&reader, transform_rules, transform_rule_count, &turned);
    reader.on_value = on_fog_value;
    reader.value_target = fog;
    if (!reader_run(&reader)) return false;
    fog->span = block->span;
    fog->up = vec3_normalize(transform_vector(&turned, fog->up));
    if (!(fog->altitude > 0)) fog->ground = false;
    if (fog->distance <= 0)
        diag_warning(context->diags, block->word_span, "this fog has no distance greater than 0: it has no effect");
    *out = (Value){.kind = VALUE_FOG, .as.fog = fog};
    return true;
}
