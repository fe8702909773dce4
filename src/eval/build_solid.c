#include "eval/build_parts.h"

#include <string.h>

/* POV-Ray squares radii, so a negative one draws what its absolute value does. */
static double radius(Reader *reader, const char *what, double value, Span span) {
    if (value < 0)
        diag_warning(reader->context->diags, span, "%s of '%s' is negative: %g is taken as %g", what,
                     reader->block->word->text, value, -value);
    if (value == 0)
        diag_warning(reader->context->diags, span, "%s of '%s' is 0: nothing will be seen", what,
                     reader->block->word->text);
    return fabs(value);
}

static bool read_radius(Reader *reader, const char *what, double *out) {
    Span span;
    if (!reader_float(reader, what, out, &span)) return false;
    *out = radius(reader, what, *out, span);
    return true;
}

/* The strength of a component of a blob, with or without its word. */
static bool read_strength(Reader *reader, double *out) {
    Argument strength;
    Word word;
    if (!reader->block->outer || strcmp(reader->block->outer->text, "blob") != 0) return true;
    if (reader_take_word(reader, "strength", &word)) return word_float(reader, &word, 0, out);
    return !reader_take_value(reader, VALUE_FLOAT, &strength) ||
           argument_float(reader, &strength, "the strength", out);
}

bool build_sphere(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, OBJECT_SPHERE);
    return reader_vector(&reader, "the center", &draft.object.as.sphere.center, NULL) &&
           read_radius(&reader, "the radius", &draft.object.as.sphere.radius) &&
           read_strength(&reader, &draft.object.as.sphere.strength) && object_finish(&reader, &draft, out);
}

bool build_box(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, OBJECT_BOX);
    Vec3 a, b;
    if (!reader_vector(&reader, "the first corner", &a, NULL) ||
        !reader_vector(&reader, "the second corner", &b, NULL))
        return false;
    draft.object.as.box.corner1 = vec3_min(a, b);
    draft.object.as.box.corner2 = vec3_max(a, b);
    return object_finish(&reader, &draft, out);
}

static void read_open(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 0, 0)) ((ObjectDraft *)target)->object.as.cone.open = true;
}

static bool read_cone_ends(Reader *reader, Object *object) {
    double *base_radius = &object->as.cone.base_radius, *cap_radius = &object->as.cone.cap_radius, value;
    Span first, second;
    bool cone = object->kind == OBJECT_CONE;
    if (!reader_vector(reader, "the base point", &object->as.cone.base, &first)) return false;
    if (cone && !reader_float(reader, "the base radius", base_radius, NULL)) return false;
    *base_radius = fabs(*base_radius); /* a tip has radius 0 */
    if (!reader_vector(reader, "the cap point", &object->as.cone.cap, &second)) return false;
    if (!reader_float(reader, cone ? "the cap radius" : "the radius", &value, &first)) return false;
    *cap_radius = cone ? fabs(value) : radius(reader, "the radius", value, first);
    if (!cone) *base_radius = *cap_radius;
    if (vec3_length_squared(vec3_sub(object->as.cone.cap, object->as.cone.base)) > 0) return true;
    Diagnostic *d = reader_error(reader, reader_after(reader, first), "this %s is degenerate: its base and cap points are the same",
                                 reader->block->word->text);
    diag_note(reader->context->diags, d, second, "the same point again");
    return false;
}

/* cylinder and cone */
bool build_cone(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule cone_rules[] = {{"open", WORD_CUSTOM, 0, read_open, false}};
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, block->word->text[1] == 'o' ? OBJECT_CONE : OBJECT_CYLINDER);
    if (!read_cone_ends(&reader, &draft.object) || !read_strength(&reader, &draft.object.as.cone.strength))
        return false;
    reader_add_table(&reader, cone_rules, VTS_ARRAY_COUNT(cone_rules), &draft);
    return object_finish(&reader, &draft, out);
}

static bool read_normal(Reader *reader, const char *what, Vec3 *normal, double *length) {
    Span span;
    if (!reader_vector(reader, what, normal, &span)) return false;
    *length = vec3_length(*normal);
    if (*length == 0) {
        reader_error(reader, span, "%s of '%s' has no length", what, reader->block->word->text);
        return false;
    }
    *normal = vec3_scale(*normal, 1 / *length);
    return true;
}

/* POV-Ray draws nothing of a disc without a normal. */
static bool read_disc_normal(Reader *reader, ObjectDraft *draft, bool *flat) {
    Vec3 *normal = &draft->object.as.disc.normal;
    Span span;
    if (!reader_vector(reader, "the normal", normal, &span)) return false;
    *flat = vec3_length_squared(*normal) > 0;
    if (!*flat)
        diag_warning(reader->context->diags, span,
                     "the normal of 'disc' has no length: nothing will be seen");
    *normal = *flat ? vec3_normalize(*normal) : vec3(0, 1, 0);
    return true;
}

/* The distance counts along the unit normal, as in POV-Ray. */
bool build_plane(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, OBJECT_PLANE);
    double length;
    return read_normal(&reader, "the normal", &draft.object.as.plane.normal, &length) &&
           reader_float(&reader, "the distance", &draft.object.as.plane.distance, NULL) &&
           object_finish(&reader, &draft, out);
}

bool build_disc(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, OBJECT_DISC);
    bool flat;
    if (!reader_vector(&reader, "the center", &draft.object.as.disc.center, NULL) ||
        !read_disc_normal(&reader, &draft, &flat) ||
        !read_radius(&reader, "the radius", &draft.object.as.disc.radius))
        return false;
    if (!flat) draft.object.as.disc.radius = 0;
    Argument hole;
    if (reader_take_value(&reader, VALUE_FLOAT, &hole) &&
        argument_float(&reader, &hole, "the radius of the hole", &draft.object.as.disc.hole_radius))
        draft.object.as.disc.hole_radius = fabs(draft.object.as.disc.hole_radius);
    return object_finish(&reader, &draft, out);
}

bool build_torus(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    Reader reader = reader_begin(context, block);
    ObjectDraft draft = object_begin(block, OBJECT_TORUS);
    return read_radius(&reader, "the major radius", &draft.object.as.torus.major_radius) &&
           read_radius(&reader, "the minor radius", &draft.object.as.torus.minor_radius) &&
           object_finish(&reader, &draft, out);
}
