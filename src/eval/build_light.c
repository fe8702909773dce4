#include "eval/build_parts.h"

typedef struct LightDraft {
    Light light;
    bool parallel;
    Transform transform;
} LightDraft;

static void read_parallel(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 0, 0)) ((LightDraft *)target)->parallel = true;
}

static void read_spotlight(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 0, 0)) ((LightDraft *)target)->light.kind = LIGHT_SPOT;
}

#define FIELD(name) offsetof(LightDraft, light.name)
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(inert), NULL, false }
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
static const WordRule rules[] = {
    {"parallel", WORD_CUSTOM, 0, read_parallel, false},
    {"spotlight", WORD_CUSTOM, 0, read_spotlight, false},
    {"point_at", WORD_VECTOR, FIELD(point_at), NULL, false},
    {"radius", WORD_FLOAT, FIELD(radius), NULL, false},
    {"falloff", WORD_FLOAT, FIELD(falloff), NULL, false},
    {"tightness", WORD_FLOAT, FIELD(tightness), NULL, false},
    {"shadowless", WORD_MARK, FIELD(shadowless), NULL, false},
    {"fade_distance", WORD_FLOAT, FIELD(fade_distance), NULL, false},
    {"fade_power", WORD_FLOAT, FIELD(fade_power), NULL, false},
    INERT("area_light"),
    INERT("looks_like"),
    INERT("projected_through"),
    INERT("cylinder"),
    INERT("goniometric"),
    INERT("ies"),
    IGNORED("adaptive"),
    IGNORED("jitter"),
    IGNORED("circular"),
    IGNORED("orient"),
    IGNORED("area_illumination"),
    IGNORED("media_interaction"),
    IGNORED("media_attenuation"),
    IGNORED("groups"),
    IGNORED("photons"),
    IGNORED("global_lights"),
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    LightDraft *draft = target;
    if (take_transform(value, &draft->transform)) return true;
    if (value->value.kind != VALUE_COLOR) return false;
    reader_error(reader, value->span, "a light's place and colour stand before its other words");
    return true;
}

/* A place, and then a colour if one follows: `light_source { rgb 1 }` has forgotten the first. */
static bool read_place(Reader *reader, Light *light) {
    Argument color;
    if (!reader_vector(reader, "the location", &light->location, NULL)) return false;
    const BlockItem *item = reader_peek(reader);
    ValueKind kind = item && item->kind == ITEM_VALUE ? item->value.kind : VALUE_ERROR;
    bool colored = kind == VALUE_COLOR || kind == VALUE_VECTOR || kind == VALUE_FLOAT;
    if (!colored) return true;
    reader_take_value(reader, kind, &color);
    return argument_color(reader, &color, "the light's colour", &light->color);
}

const Light *light_placed(const BuildContext *context, const Light *light, const Transform *t) {
    Light *placed = arena_copy(context->arena, light, sizeof *light);
    placed->location = transform_point(t, light->location);
    placed->point_at = transform_point(t, light->point_at);
    placed->to_light = vec3_normalize(vec3_sub(placed->location, placed->point_at));
    return placed;
}

static bool finish(Reader *reader, LightDraft *draft, Value *out) {
    Light *light = &draft->light;
    if (draft->parallel && light->kind == LIGHT_POINT) light->kind = LIGHT_PARALLEL;
    if (light->kind != LIGHT_POINT && vec3_length_squared(vec3_sub(light->location, light->point_at)) == 0)
        diag_warning(reader->context->diags, reader->block->word_span,
                     "this light has no direction, for it stands where it points at: it lights nothing");
    *out = (Value){.kind = VALUE_LIGHT, .as.light = light_placed(reader->context, light, &draft->transform)};
    return true;
}

bool build_light(BuildContext *context, const EvalBlock *block, Value *out) {
    LightDraft draft = {
        .light = {.color = {1, 1, 1, 0, 0}, .point_at = {0, 0, 1}, .radius = 30, .falloff = 45},
        .transform = transform_identity()};
    Reader reader = reader_begin(context, block);
    Argument declared;
    if (reader_take_value(&reader, VALUE_LIGHT, &declared))
        draft.light = *declared.value.as.light;
    else if (!read_place(&reader, &draft.light))
        return false;
    draft.light.span = block->span;
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_value;
    reader.value_target = &draft;
    return reader_run(&reader) && finish(&reader, &draft, out);
}
