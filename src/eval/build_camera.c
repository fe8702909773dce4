/* camera { … }. POV-Ray 3.5 and later apply the modifiers in a fixed order, whatever their order in the text: right,
 * direction, angle (sets the length of direction from that of right), up, sky, location, look_at (turns all three vectors),
 * orthographic (scales right and up to what a perspective camera sees at look_at), transforms. */
#include "eval/build_parts.h"

typedef struct CameraDraft {
    Camera camera;
    Vec3 sky, look_at;
    double angle; /* 0: not given */
    bool has_right, has_up, has_look_at;
    Span look_at_span;
    Transform transform;
} CameraDraft;

static const double DEFAULT_ASPECT = 1.33; /* POV-Ray's right vector */

static void read_orthographic(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 0, 0)) ((CameraDraft *)target)->camera.kind = CAMERA_ORTHOGRAPHIC;
}

static void read_right(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    draft->has_right =
        word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &draft->camera.right);
}

static void read_up(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    draft->has_up = word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &draft->camera.up);
}

static void read_look_at(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    draft->look_at_span = word->span;
    draft->has_look_at = word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &draft->look_at);
}

static void read_angle(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    double angle;
    if (!word_arguments(reader, word, 1, 2) || !word_float(reader, word, 0, &angle)) return;
    if (angle > 0 && angle < 180)
        draft->angle = angle;
    else
        reader_error(reader, word->arguments[0].span,
                     "the camera's angle must lie between 0 and 180 degrees, found %g", angle);
}

#define FIELD(name) offsetof(CameraDraft, name)
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(camera.inert), NULL, false }
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
static const WordRule rules[] = {
    IGNORED("perspective"),
    {"orthographic", WORD_CUSTOM, 0, read_orthographic, false},
    {"location", WORD_VECTOR, FIELD(camera.location), NULL, false},
    {"direction", WORD_VECTOR, FIELD(camera.direction), NULL, false},
    {"right", WORD_CUSTOM, 0, read_right, false},
    {"up", WORD_CUSTOM, 0, read_up, false},
    {"sky", WORD_VECTOR, FIELD(sky), NULL, false},
    {"look_at", WORD_CUSTOM, 0, read_look_at, false},
    {"angle", WORD_CUSTOM, 0, read_angle, false},
    INERT("fisheye"),
    INERT("ultra_wide_angle"),
    INERT("omnimax"),
    INERT("panoramic"),
    INERT("spherical"),
    INERT("cylinder"),
    INERT("mesh_camera"),
    INERT("aperture"),
    INERT("bokeh"),
    INERT("user_defined"),
    IGNORED("focal_point"),
    IGNORED("blur_samples"),
    IGNORED("confidence"),
    IGNORED("variance"),
    IGNORED("smooth"),
};

static void apply_angle(CameraDraft *draft) {
    double length = vec3_length(draft->camera.right) / tan(draft->angle * VTS_RADIANS / 2) / 2;
    draft->camera.direction = vec3_scale(vec3_normalize(draft->camera.direction), length);
}

/* Keeps the lengths of the three vectors and their handedness. */
static bool apply_look_at(Reader *reader, CameraDraft *draft) {
    Camera *c = &draft->camera;
    double direction_length = vec3_length(c->direction), up_length = vec3_length(c->up),
           right_length = vec3_length(c->right);
    double handedness = vec3_dot(vec3_cross(c->up, c->direction), c->right);
    Vec3 view = vec3_sub(draft->look_at, c->location);
    if (vec3_length_squared(view) < 1e-10) {
        reader_error(reader, draft->look_at_span, "the camera looks at its own location");
        return false;
    }
    view = vec3_normalize(view);
    Vec3 right = vec3_cross(draft->sky, view);
    if (vec3_length(right) < 1e-10) {
        diag_warning(reader->context->diags, draft->look_at_span,
                     "the camera looks along its sky vector: the picture's horizon follows 'right'");
        right = c->right;
    }
    right = vec3_normalize(right);
    c->up = vec3_scale(vec3_cross(view, right), up_length);
    c->direction = vec3_scale(view, direction_length);
    c->right = vec3_scale(right, handedness > 0 ? right_length : -right_length);
    return true;
}

static void apply_orthographic(CameraDraft *draft) {
    Camera *c = &draft->camera;
    if (c->kind != CAMERA_ORTHOGRAPHIC || ((draft->has_up || draft->has_right) && draft->angle == 0)) return;
    double distance = vec3_length(vec3_sub(draft->look_at, c->location)), length = vec3_length(c->direction);
    if (distance < 1e-10 || length < 1e-10) return;
    c->right = vec3_scale(c->right, distance / length);
    c->up = vec3_scale(c->up, distance / length);
}

static void place(Camera *c, const Transform *t) {
    c->location = transform_point(t, c->location);
    c->direction = transform_vector(t, c->direction);
    c->right = transform_vector(t, c->right);
    c->up = transform_vector(t, c->up);
}

/* A flat or skewed frame is legal, but rarely meant. */
static bool check_frame(Reader *reader, const Camera *c) {
    double volume = vec3_dot(vec3_cross(c->up, c->direction), c->right);
    double lengths = vec3_length(c->up) * vec3_length(c->direction) * vec3_length(c->right);
    if (!(lengths > 0) || fabs(volume) < 1e-12 * lengths) {
        reader_error(reader, reader->block->word_span, "the camera's direction, right and up span no space");
        return false;
    }
    if (fabs(volume) < (1 - 1e-8) * lengths)
        diag_warning(reader->context->diags, reader->block->word_span,
                     "the camera's vectors are not perpendicular");
    return true;
}

static bool on_transform(Reader *reader, const Argument *value, void *target) {
    (void)reader;
    return take_transform(value, target);
}

static bool store(BuildContext *context, const EvalBlock *block, Camera camera, Value *out) {
    Camera *made = arena_new(context->arena, Camera);
    *made = camera;
    made->span = block->span;
    *out = (Value){.kind = VALUE_CAMERA, .as.camera = made};
    return true;
}

bool build_camera(BuildContext *context, const EvalBlock *block, Value *out) {
    CameraDraft draft = {.camera = camera_default(DEFAULT_ASPECT),
                         .sky = {0, 1, 0},
                         .look_at = {0, 0, 1},
                         .transform = transform_identity()};
    Reader reader = reader_begin(context, block);
    Argument declared;
    bool copy = reader_take_value(&reader, VALUE_CAMERA, &declared); /* only transforms may follow */
    if (copy)
        draft.camera = *declared.value.as.camera;
    else
        reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &draft.transform);
    reader.on_value = on_transform;
    reader.value_target = &draft.transform;
    if (!reader_run(&reader)) return false;
    if (draft.angle > 0) apply_angle(&draft);
    if (draft.has_look_at && !apply_look_at(&reader, &draft)) return false;
    if (!copy) apply_orthographic(&draft);
    place(&draft.camera, &draft.transform);
    return check_frame(&reader, &draft.camera) && store(context, block, draft.camera, out);
}
