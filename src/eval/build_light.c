#include "eval/build_parts.h"
#include "eval/eval_files.h"
#include "tape/tape.h"

#include <string.h>

typedef struct LightDraft {
    Light light;
    bool parallel;
    bool turned; /* its table or where it points is new */
    Transform transform;
} LightDraft;

static void read_parallel(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 0, 0)) ((LightDraft *)target)->parallel = true;
}

/* The word sets what the rim is without others. */
static void read_kind(Reader *reader, const Word *word, void *target) {
    Light *light = &((LightDraft *)target)->light;
    bool spot = strcmp(word->text, "spotlight") == 0;
    if (!word_arguments(reader, word, 0, 0)) return;
    light->kind = spot ? LIGHT_SPOT : LIGHT_CYLINDER;
    light->radius = spot ? 30 : 0.75;
    light->falloff = spot ? 45 : 1;
    light->tightness = 0;
}

enum { MOST_AREA_LIGHTS = 10000 }; /* along one side */

static void read_area(Reader *reader, const Word *word, void *target) {
    Light *light = &((LightDraft *)target)->light;
    double size_u = 1, size_v = 1;
    grammar_word(reader, word);
    if (word->count < 4 || !word_vector(reader, word, 0, &light->axis_u) ||
        !word_vector(reader, word, 1, &light->axis_v) || !word_float(reader, word, 2, &size_u) ||
        !word_float(reader, word, 3, &size_v))
        return;
    light->size_u = double_to_int(size_u, 1, MOST_AREA_LIGHTS);
    light->size_v = double_to_int(size_v, 1, MOST_AREA_LIGHTS);
}

static const Object *placed_like(const BuildContext *context, const Object *object, const Transform *t) {
    if (!object) return NULL;
    Transform own = object_transform(object), all = transform_then(&own, t);
    Object copy = object_copy(object);
    return object_keep(context->arena, &copy, &all);
}

typedef struct LikeDraft {
    const Object *object;
    Transform transform;
} LikeDraft;

static bool on_like_value(Reader *reader, const Argument *value, void *target) {
    LikeDraft *draft = target;
    if (take_transform(value, &draft->transform)) return true;
    draft->object = object_from_value(reader->context, value);
    return draft->object != NULL;
}

/* looks_like { O … }, projected_through { O … }: the first about the origin, which is to be the light's place. */
static const Object *read_like(Reader *reader, const Word *word) {
    LikeDraft draft = {.transform = transform_identity()};
    if (!grammar_word(reader, word) || !word->body) return NULL;
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, transform_rules, transform_rule_count, &draft.transform);
    body.on_value = on_like_value;
    body.value_target = &draft;
    reader_run(&body);
    reader_end_nested(reader, &body);
    return placed_like(reader->context, draft.object, &draft.transform);
}

static void read_looks_like(Reader *reader, const Word *word, void *target) {
    ((LightDraft *)target)->light.looks_like = read_like(reader, word);
}

static void read_projected(Reader *reader, const Word *word, void *target) {
    ((LightDraft *)target)->light.projected_through = read_like(reader, word);
}

static void read_point_at(Reader *reader, const Word *word, void *target) {
    LightDraft *draft = target;
    if (word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &draft->light.point_at)) draft->light.aimed = draft->turned = true;
}

static void read_ies(Reader *reader, const Word *word, void *target) {
    LightDraft *draft = target;
    const char *name;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &name)) return;
    const SourceFile *file = eval_find_text(reader->context->eval, name, word->arguments[0].span);
    draft->light.lamp = file ? lamp_read(file, reader->context->diags, reader->context->arena) : NULL;
    draft->turned = true;
    reader->failed |= !draft->light.lamp;
}

static void read_goniometric(Reader *reader, const Word *word, void *target) {
    Light *light = &((LightDraft *)target)->light;
    Argument function;
    if (word->count == 1) function = word->arguments[0];
    else if (!reader_take_value(reader, VALUE_FUNCTION, &function)) {
        reader_error(reader, word->span, "'goniometric' needs its function(theta) { … }");
        return;
    }
    /* Of a spline, whose points are the table of a lamp, the first number counts. */
    bool table = function.value.kind == VALUE_FUNCTION && tape_output_count(function.value.as.function->tape) <= LIGHT_GONIOMETRIC_OUTPUTS;
    int outputs = table ? tape_output_count(function.value.as.function->tape) : 1;
    argument_function(reader, &function, "'goniometric'", 1, outputs, &light->goniometric);
}

static void read_interaction(Reader *reader, const Word *word, void *target) {
    double on = 1;
    if (word_arguments(reader, word, 0, 1) && (word->count == 0 || word_float(reader, word, 0, &on))) ((LightDraft *)target)->light.unscattered = on == 0;
}

#define FIELD(name) offsetof(LightDraft, light.name)
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
static const WordRule rules[] = {
    {"parallel", WORD_CUSTOM, 0, read_parallel, false},
    {"spotlight", WORD_CUSTOM, 0, read_kind, false},
    {"cylinder", WORD_CUSTOM, 0, read_kind, false},
    {"point_at", WORD_CUSTOM, 0, read_point_at, false},
    {"radius", WORD_FLOAT, FIELD(radius), NULL, false},
    {"falloff", WORD_FLOAT, FIELD(falloff), NULL, false},
    {"tightness", WORD_FLOAT, FIELD(tightness), NULL, false},
    {"shadowless", WORD_MARK, FIELD(shadowless), NULL, false},
    {"fade_distance", WORD_FLOAT, FIELD(fade_distance), NULL, false},
    {"fade_power", WORD_FLOAT, FIELD(fade_power), NULL, false},
    {"area_light", WORD_CUSTOM, 0, read_area, false},
    {"jitter", WORD_MARK, FIELD(jitter), NULL, false},
    {"circular", WORD_MARK, FIELD(circular), NULL, false},
    {"orient", WORD_FLAG, FIELD(orient), NULL, false},
    {"area_illumination", WORD_FLAG, FIELD(area_illumination), NULL, false},
    {"looks_like", WORD_CUSTOM, 0, read_looks_like, false},
    {"projected_through", WORD_CUSTOM, 0, read_projected, false},
    {"goniometric", WORD_CUSTOM, 0, read_goniometric, false},
    {"ies", WORD_CUSTOM, 0, read_ies, false},
    IGNORED("adaptive"), /* shadows are sampled by the error that remains */
    {"media_interaction", WORD_CUSTOM, 0, read_interaction, false},
    {"media_attenuation", WORD_FLAG, FIELD(through_air), NULL, false},
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

/* Transforms may have sheared the frame of a lamp's table. */
static void square_up(Light *light) {
    Vec3 *turns = light->lamp_turns, axis = light->to_light;
    for (int i = 0; i < 2; i++) {
        turns[i] = vec3_madd(turns[i], axis, -vec3_dot(turns[i], axis));
        if (i) turns[1] = vec3_madd(turns[1], turns[0], -vec3_dot(turns[1], turns[0]));
        turns[i] = vec3_normalize(turns[i]);
    }
}

/* The lamp hangs with its height 0 downwards, turn 0 to the right and 90 away, counterclockwise from above as it is measured; the shortest turn brings it to
 * where it points. Straight up, where each is as short, that is one about x. */
static void turn_lamp(Light *light) {
    Vec3 down = vec3_normalize(vec3_sub(light->point_at, light->location)), sum = vec3(down.x, down.y - 1, down.z);
    const Vec3 hung[2] = {vec3(1, 0, 0), vec3(0, 0, 1)};
    for (int i = 0; i < 2; i++) {
        double along = vec3_dot(hung[i], sum) / (1 - down.y);
        light->lamp_turns[i] = down.y > 1 - 1e-9 ? vec3_scale(hung[i], i ? -1 : 1) : vec3_madd(hung[i], sum, -along);
    }
}

const Light *light_placed(const BuildContext *context, const Light *light, const Transform *t) {
    Light *placed = arena_copy(context->arena, light, sizeof *light);
    placed->location = transform_point(t, light->location);
    placed->point_at = transform_point(t, light->point_at);
    placed->axis_u = transform_vector(t, light->axis_u);
    placed->axis_v = transform_vector(t, light->axis_v);
    placed->looks_like = placed_like(context, light->looks_like, t);
    placed->projected_through = placed_like(context, light->projected_through, t);
    placed->to_light = vec3_normalize(vec3_sub(placed->location, placed->point_at));
    for (int i = 0; i < 2; i++) placed->lamp_turns[i] = transform_vector(t, light->lamp_turns[i]);
    square_up(placed);
    return placed;
}

/* Where a distribution's axis goes when nothing was said: off the light's area, or down, as makers of lamps measure. */
static void aim(Light *light) {
    Vec3 off = vec3_cross(light->axis_u, light->axis_v);
    Vec3 axis = vec3_length(off) > 0 ? vec3_normalize(off) : vec3(0, -1, 0);
    light->point_at = vec3_add(light->location, axis);
    light->aimed = true;
}

/* `copy`: of a declared light, whose looks_like stands where it belongs. */
static bool finish(Reader *reader, LightDraft *draft, bool copy, Value *out) {
    Light *light = &draft->light;
    if (draft->parallel && light->kind == LIGHT_POINT) light->kind = LIGHT_PARALLEL;
    light->parallel = light->parallel || draft->parallel;
    bool uneven = light->goniometric || light->lamp;
    if (uneven && light->kind == LIGHT_POINT && !light->aimed) aim(light);
    if (light->lamp && draft->turned) turn_lamp(light);
    if (uneven && light_is_parallel(light))
        diag_warning(reader->context->diags, reader->block->word_span, "all rays of a parallel light leave it at the same angle: '%s' has no effect",
                     light->lamp ? "ies" : "goniometric");
    if (light->kind != LIGHT_POINT && vec3_length_squared(vec3_sub(light->location, light->point_at)) == 0)
        diag_warning(reader->context->diags, reader->block->word_span,
                     "this light has no direction, for it stands where it points at: it lights nothing");
    Transform shift = transform_translate(light->location);
    if (!copy) light->looks_like = placed_like(reader->context, light->looks_like, &shift);
    *out = (Value){.kind = VALUE_LIGHT, .as.light = light_placed(reader->context, light, &draft->transform)};
    return true;
}

bool build_light(BuildContext *context, const EvalBlock *block, Value *out) {
    LightDraft draft = {
        .light = {.color = {1, 1, 1, 0, 0}, .point_at = {0, 0, 1}, .radius = 30, .falloff = 45},
        .transform = transform_identity()};
    Reader reader = reader_begin(context, block);
    Argument declared;
    bool copy = reader_take_value(&reader, VALUE_LIGHT, &declared);
    if (copy)
        draft.light = *declared.value.as.light;
    else if (!read_place(&reader, &draft.light))
        return false;
    draft.light.span = block->span;
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_value;
    reader.value_target = &draft;
    return reader_run(&reader) && finish(&reader, &draft, copy, out);
}
