/* The rarer solids and sheets. Their blocks are lists of numbers with words between them, and the same numbers may stand
 * after a word (`linear_spline 4, <0,0>, …`) or alone: all are put in one row first, and read from it at the end. */
#include "eval/build_rare.h"

#include <limits.h>
#include <string.h>

/* ---- the row ---- */

static void push(RareDraft *draft, const Argument *argument) {
    *list_push(draft->reader->context->arena, &draft->row) = *argument;
}

static void push_from(RareDraft *draft, const Word *word, size_t first) {
    for (size_t i = first; i < word->count; i++) push(draft, &word->arguments[i]);
}

static bool row_error(RareDraft *draft, const char *what) {
    Span end = draft->reader->block->span;
    if (end.end > end.begin) end.begin = end.end - 1;
    Span span = draft->next < draft->row.count ? draft->row.items[draft->next].span : end;
    reader_error(draft->reader, span, "'%s': expected %s", draft->reader->block->word->text, what);
    return false;
}

bool rare_float(RareDraft *draft, const char *what, double *out) {
    if (draft->next >= draft->row.count) return row_error(draft, what);
    return argument_float(draft->reader, &draft->row.items[draft->next++], what, out);
}

/* Components of a vector, or a float for all of them. */
static bool components(RareDraft *draft, const char *what, double *out, size_t count) {
    if (draft->next >= draft->row.count) return row_error(draft, what);
    const Argument *argument = &draft->row.items[draft->next];
    const Value *v = &argument->value;
    for (size_t i = 0; i < count; i++) {
        if (v->kind == VALUE_FLOAT)
            out[i] = v->as.number;
        else if (v->kind == VALUE_VECTOR)
            out[i] = i < v->size ? v->as.components[i] : 0;
        else
            return row_error(draft, what);
        if (!isfinite(out[i])) return row_error(draft, "finite numbers");
    }
    draft->next++;
    return true;
}

bool rare_vector(RareDraft *draft, const char *what, Vec3 *out) {
    double c[3];
    if (!components(draft, what, c, 3)) return false;
    *out = vec3(c[0], c[1], c[2]);
    return true;
}

bool rare_vector4(RareDraft *draft, const char *what, double out[4]) {
    return components(draft, what, out, 4);
}

bool rare_point2(RareDraft *draft, const char *what, Point2 *out) {
    double c[2];
    if (!components(draft, what, c, 2)) return false;
    *out = (Point2){c[0], c[1]};
    return true;
}

bool rare_count(RareDraft *draft, const char *what, size_t least, size_t *out) {
    double number;
    if (!rare_float(draft, what, &number)) return false;
    if (number >= (double)least && number < 1e7) {
        *out = (size_t)number;
        return true;
    }
    draft->next--;
    reader_error(draft->reader, draft->row.items[draft->next].span,
                 "%s of '%s' must be at least %zu, found %g", what, draft->reader->block->word->text, least,
                 number);
    return false;
}

bool rare_numbers_left(const RareDraft *draft) { return draft->next < draft->row.count; }

/* ---- words ---- */

static RareDraft *draft_of(void *target) { return target; }

static CurveKind curve_of(const char *word) {
    switch (word[0]) {
    case 'q': return CURVE_QUADRATIC;
    case 'c': return CURVE_CUBIC;
    case 'l': return CURVE_LINEAR;
    default: return word[1] == '_' ? CURVE_B_SPLINE : CURVE_BEZIER;
    }
}

static void read_curve(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->curve = curve_of(word->text);
    push_from(target, word, 0);
}

static void read_row(Reader *reader, const Word *word, void *target) {
    (void)reader;
    push_from(target, word, 0);
}

static void read_conic(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->conic = true;
    push_from(target, word, 0);
}

static void read_open(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->open = true;
    push_from(target, word, 0);
}

static void read_smooth(Reader *reader, const Word *word, void *target) {
    double on = 1;
    if (word->count) word_float(reader, word, 0, &on);
    draft_of(target)->smooth = on != 0;
}

/* A word with one number of its own; what follows belongs to the row. */
static void read_one(Reader *reader, const Word *word, double *out, void *target) {
    word_float(reader, word, 0, out);
    push_from(target, word, 1);
}

static void skip_one(Reader *reader, const Word *word, void *target) {
    (void)reader;
    push_from(target, word, 1);
}

static void read_threshold(Reader *reader, const Word *word, void *target) {
    read_one(reader, word, &draft_of(target)->threshold, target);
}
static void read_accuracy(Reader *reader, const Word *word, void *target) {
    read_one(reader, word, &draft_of(target)->accuracy, target);
}
static void read_max_gradient(Reader *reader, const Word *word, void *target) {
    read_one(reader, word, &draft_of(target)->max_gradient, target);
}
static void read_method(Reader *reader, const Word *word, void *target) {
    static const char *const names[] = {"auto", "interval", "affine", "reduced_affine", "reduced_affine_optimised"};
    (void)reader;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(names); i++)
        if (strcmp(names[i], word->text) == 0) draft_of(target)->method = (IsosurfaceMethod)i;
    push_from(target, word, 0);
}
static void read_full(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->full_detail = true;
    push_from(target, word, 0);
}
static void read_water_level(Reader *reader, const Word *word, void *target) {
    read_one(reader, word, &draft_of(target)->water_level, target);
}
static void read_iterations(Reader *reader, const Word *word, void *target) {
    read_one(reader, word, &draft_of(target)->iterations, target);
}

/* Any solid that has an end; an empty block leaves the container as it is. */
static void read_contained_by(Reader *reader, const Word *word, void *target) {
    const EvalBlock *body = word->body;
    if (body && body->count == 0) return;
    const Argument value = {body && body->count ? body->items[0].value : (Value){0}, word->span};
    draft_of(target)->container = body && body->count && body->items[0].kind == ITEM_VALUE
                                      ? object_from_value(reader->context, &value)
                                      : NULL;
    if (!draft_of(target)->container || draft_of(target)->container->kind == OBJECT_PLANE || body->count > 1)
        reader_error(reader, word->span, "'contained_by' takes one solid that has an end");
}

static void read_slice(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->slice_at = draft_of(target)->row.count + 1;
    push_from(target, word, 0);
}

static void read_julia_algebra(Reader *reader, const Word *word, void *target) {
    (void)reader;
    draft_of(target)->hypercomplex = word->text[0] == 'h';
}

static const char *const julia_words[] = {"sqr",  "cube",  "exp",  "reciprocal", "sin",  "asin",
                                          "sinh", "asinh", "cos",  "acos",       "cosh", "acosh",
                                          "tan",  "atan",  "tanh", "atanh",      "log",  "pwr"};

static void read_julia_function(Reader *reader, const Word *word, void *target) {
    (void)reader;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(julia_words); i++)
        if (strcmp(julia_words[i], word->text) == 0) draft_of(target)->function = (JuliaFunction)i;
}

/* strength, radius, centre: POV-Ray's older way to write a sphere of a blob. */
static void read_component(Reader *reader, const Word *word, void *target) {
    BlobPart part = {.transform = transform_identity()};
    if (!word_float(reader, word, 0, &part.strength) || !word_float(reader, word, 1, &part.radius) ||
        !word_vector(reader, word, 2, &part.base))
        return;
    part.cap = part.base;
    *list_push(reader->context->arena, &draft_of(target)->parts) = part;
}

static void read_picture(Reader *reader, const Word *word, void *target) {
    if (word->count == 0) return;
    draft_of(target)->picture_span = word->arguments[0].span;
    word_string(reader, word, 0, &draft_of(target)->picture);
    draft_of(target)->potential = strcmp(word->text, "pot") == 0;
}

#define CUSTOM(word, handler)                                                                                \
    { word, WORD_CUSTOM, 0, handler, false }
/* Four corners of the texture; the points may follow them. */
static void read_patch_uvs(Reader *reader, const Word *word, void *target) {
    for (size_t i = 0; i < 4; i++) {
        Vec3 corner;
        if (!word_vector(reader, word, i, &corner)) return;
    }
    push_from(target, word, 4);
}

static const WordRule rules[] = {
    CUSTOM("uv_vectors", read_patch_uvs),
    CUSTOM("xyz", read_row),
    CUSTOM("linear_spline", read_curve),
    CUSTOM("quadratic_spline", read_curve),
    CUSTOM("cubic_spline", read_curve),
    CUSTOM("bezier_spline", read_curve),
    CUSTOM("b_spline", read_curve),
    CUSTOM("linear_sweep", read_row),
    CUSTOM("conic_sweep", read_conic),
    CUSTOM("open", read_open),
    CUSTOM("ttf", read_row),
    CUSTOM("internal", read_row),
    CUSTOM("tolerance", skip_one),
    CUSTOM("type", skip_one),
    CUSTOM("flatness", skip_one),
    CUSTOM("u_steps", skip_one),
    CUSTOM("v_steps", skip_one),
    CUSTOM("threshold", read_threshold),
    CUSTOM("accuracy", read_accuracy),
    CUSTOM("max_gradient", read_max_gradient),
    CUSTOM("max_iteration", read_iterations),
    CUSTOM("precision", skip_one),
    CUSTOM("water_level", read_water_level),
    CUSTOM("smooth", read_smooth),
    CUSTOM("contained_by", read_contained_by),
    CUSTOM("slice", read_slice),
    CUSTOM("quaternion", read_julia_algebra),
    CUSTOM("hypercomplex", read_julia_algebra),
    CUSTOM("component", read_component),
    {"evaluate", WORD_IGNORED, 0, NULL, false},
    {"max_trace", WORD_IGNORED, 0, NULL, false},
    {"all_intersections", WORD_IGNORED, 0, NULL, false},
    {"precompute", WORD_IGNORED, 0, NULL, false},
    {"method", WORD_IGNORED, 0, NULL, false},
    {"detail", WORD_IGNORED, 0, NULL, false},
    CUSTOM("interval", read_method),
    CUSTOM("affine", read_method),
    CUSTOM("reduced_affine", read_method),
    CUSTOM("reduced_affine_optimised", read_method),
    {"auto", WORD_IGNORED, 0, NULL, false}, /* of method and detail: what they are without it */
    CUSTOM("full", read_full),
    {"gamma", WORD_IGNORED, 0, NULL, false},
};

/* Words that only one kind of block knows, and that mean something else elsewhere. */
static const WordRule julia_rules[] = {
    CUSTOM("sqr", read_julia_function),  CUSTOM("cube", read_julia_function),
    CUSTOM("exp", read_julia_function),  CUSTOM("reciprocal", read_julia_function),
    CUSTOM("sin", read_julia_function),  CUSTOM("asin", read_julia_function),
    CUSTOM("sinh", read_julia_function), CUSTOM("asinh", read_julia_function),
    CUSTOM("cos", read_julia_function),  CUSTOM("acos", read_julia_function),
    CUSTOM("cosh", read_julia_function), CUSTOM("acosh", read_julia_function),
    CUSTOM("tan", read_julia_function),  CUSTOM("atan", read_julia_function),
    CUSTOM("tanh", read_julia_function), CUSTOM("atanh", read_julia_function),
    CUSTOM("log", read_julia_function),  CUSTOM("ln", read_julia_function),
    CUSTOM("pwr", read_julia_function),
};
static const WordRule picture_rules[] = {
    CUSTOM("gif", read_picture),  CUSTOM("tga", read_picture), CUSTOM("png", read_picture),
    CUSTOM("ppm", read_picture),  CUSTOM("pgm", read_picture), CUSTOM("jpeg", read_picture),
    CUSTOM("tiff", read_picture), CUSTOM("sys", read_picture), CUSTOM("pot", read_picture),
    CUSTOM("exr", read_picture),  CUSTOM("hdr", read_picture), CUSTOM("iff", read_picture),
};

/* ---- values ---- */

static bool take_blob_part(RareDraft *draft, const Object *object) {
    BlobPart part = {.transform = object_transform(object), .texture = object->texture};
    if (object->kind == OBJECT_SPHERE) {
        part.base = part.cap = object->as.sphere.center;
        part.radius = object->as.sphere.radius;
        part.strength = object->as.sphere.strength;
    } else if (object->kind == OBJECT_CYLINDER) {
        part.base = object->as.cone.base;
        part.cap = object->as.cone.cap;
        part.radius = object->as.cone.base_radius;
        part.strength = object->as.cone.strength;
    } else {
        return false;
    }
    *list_push(draft->reader->context->arena, &draft->parts) = part;
    return true;
}

static bool on_rare_value(Reader *reader, const Argument *value, void *target) {
    RareDraft *draft = target;
    switch (value->value.kind) {
    case VALUE_FLOAT:
    case VALUE_VECTOR:
    case VALUE_STRING:
    case VALUE_FUNCTION: push(draft, value); return true;
    case VALUE_OBJECT:
        if (draft->takes_parts) return take_blob_part(draft, value->value.as.object);
        return false;
    default: return object_on_value(reader, value, &draft->common);
    }
}

bool rare_begin(RareDraft *draft, Reader *reader) {
    const char *word = reader->block->word->text;
    draft->reader = reader;
    draft->common = object_begin(reader->block, OBJECT_SOLID);
    if (vec3_length_squared(draft->turned) > 0) draft->common.transform = transform_rotate(draft->turned);
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), draft);
    if (strcmp(word, "julia_fractal") == 0)
        reader_add_table(reader, julia_rules, VTS_ARRAY_COUNT(julia_rules), draft);
    if (strcmp(word, "height_field") == 0)
        reader_add_table(reader, picture_rules, VTS_ARRAY_COUNT(picture_rules), draft);
    reader->on_value = on_rare_value;
    reader->value_target = draft;
    return object_read(reader, &draft->common);
}

bool rare_end(RareDraft *draft, Value *out) {
    Arena *arena = draft->reader->context->arena;
    if (draft->reader->failed) return false;
    if (draft->next < draft->row.count) return row_error(draft, "no more numbers here");
    Solid *solid = arena_copy(arena, &draft->solid, sizeof *solid);
    solid->word = draft->common.word;
    solid_rehash(solid);
    draft->common.object.as.solid = solid;
    return object_make(draft->reader, &draft->common, out);
}
