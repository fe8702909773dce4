/* camera { … }. POV-Ray 3.5 and later apply the modifiers in a fixed order, whatever their order in the text: right,
 * direction, angle (sets the length of direction from that of right), up, sky, location, look_at (turns all three vectors),
 * orthographic (scales right and up to what a perspective camera sees at look_at), transforms. */
#include "eval/build_parts.h"

#include <string.h>

typedef struct CameraDraft {
    Camera camera;
    Vec3 sky, look_at;
    double angle; /* 0: not given */
    Span angle_span;
    double angle_v; /* likewise: the second number of `angle` */
    Vec3 focal_point;
    bool has_right, has_up, has_look_at, has_focal_point;
    Span look_at_span;
    Transform transform;
} CameraDraft;

static const double DEFAULT_ASPECT = 1.33; /* POV-Ray's right vector */
enum { MOST_BLUR_SAMPLES = 1 << 20 };

static const struct {
    const char *word;
    CameraKind kind;
} kinds[] = {
    {"perspective", CAMERA_PERSPECTIVE},
    {"orthographic", CAMERA_ORTHOGRAPHIC},
    {"fisheye", CAMERA_FISHEYE},
    {"ultra_wide_angle", CAMERA_ULTRA_WIDE},
    {"omnimax", CAMERA_OMNIMAX},
    {"panoramic", CAMERA_PANORAMIC},
    {"spherical", CAMERA_SPHERICAL},
    {"cylinder", CAMERA_CYLINDER_1},
    {"mesh_camera", CAMERA_MESH},
};

/* As in POV-Ray, since the kind decides what the words after it mean. */
static void expect_first(Reader *reader, const Word *word) {
    for (size_t i = 0; i + 1 < reader->next; i++) {
        Word before;
        bool kind = false;
        if (item_as_word(&reader->block->items[i], &before))
            for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++)
                kind = kind || strcmp(kinds[k].word, before.text) == 0;
        if (kind) continue;
        reader_error(reader, word->span, "the kind of a camera comes first");
        return;
    }
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
    if (!word_arguments(reader, word, 1, 2) || !word_float(reader, word, 0, &draft->angle)) return;
    if (word->count > 1 && !word_float(reader, word, 1, &draft->angle_v)) return;
    draft->angle_span = word->arguments[0].span;
    if (draft->angle < 0)
        reader_error(reader, draft->angle_span, "the camera's angle cannot be negative, found %g",
                     draft->angle);
}

static void read_cylinder(Reader *reader, const Word *word, CameraDraft *draft) {
    double type = 1;
    if (!word->count || !word_float(reader, word, 0, &type)) return;
    if (!(type >= 1 && type < 5))
        reader_error(reader, word->arguments[0].span, "the types of cylindrical cameras are 1 to 4, found %g",
                     type);
    else
        draft->camera.kind = (CameraKind)(CAMERA_CYLINDER_1 + (int)type - 1);
}

/* The numbers before a mesh_camera's meshes, and these. */
typedef struct MeshDraft {
    struct {
        CameraMesh *items;
        size_t count, capacity;
    } meshes;
    double numbers[2];
    size_t number_count;
    bool smooth;
} MeshDraft;

static bool on_mesh(Reader *reader, const Argument *value, void *target) {
    MeshDraft *draft = target;
    if (value->value.kind == VALUE_FLOAT && draft->number_count < 2 && !draft->meshes.count) {
        draft->numbers[draft->number_count++] = value->value.as.number;
        return true;
    }
    const Object *object = value->value.kind == VALUE_OBJECT ? value->value.as.object : NULL;
    if (!object || object->kind != OBJECT_TRIANGLES) return false;
    *list_push(reader->context->arena, &draft->meshes) = (CameraMesh){object->as.mesh, object_transform(object)};
    return true;
}

static void read_meshes(Reader *reader, const Word *word, CameraDraft *draft) {
    static const WordRule mesh_rules[] = {{"smooth", WORD_MARK, offsetof(MeshDraft, smooth), NULL, false}};
    MeshDraft meshes = {.number_count = 0};
    if (!word->body) return; /* grammar_word() has told */
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, mesh_rules, VTS_ARRAY_COUNT(mesh_rules), &meshes);
    body.on_value = on_mesh;
    body.value_target = &meshes;
    reader_run(&body);
    reader_end_nested(reader, &body);
    double rays = meshes.numbers[0], spread = meshes.numbers[1];
    if (!(rays >= 1 && rays <= MOST_BLUR_SAMPLES && spread >= 0 && spread <= 3) || meshes.number_count < 2)
        reader_error(reader, word->span, "'mesh_camera' takes the rays of a pixel, at least 1, and their distribution, 0 to 3");
    else if (!meshes.meshes.count || ((int)spread == MESH_SPREAD_RAYS && (double)meshes.meshes.count < floor(rays)))
        reader_error(reader, word->span, "'mesh_camera' has fewer meshes than it needs");
    else {
        MeshCamera *made = arena_new(reader->context->arena, MeshCamera);
        *made = (MeshCamera){.rays = spread < MESH_SPREAD_ASIDE ? (int)rays : 1, .spread = (MeshSpread)(int)spread, .smooth = meshes.smooth,
                             .meshes = meshes.meshes.items, .mesh_count = meshes.meshes.count};
        draft->camera.mesh = made;
    }
}

/* Of the camera's own vectors these alone count, as they are written. */
static void aim_meshes(Reader *reader, Camera *camera) {
    if (camera->kind != CAMERA_MESH || !camera->mesh) return;
    MeshCamera *made = arena_new(reader->context->arena, MeshCamera);
    *made = *camera->mesh;
    made->ahead = camera->location.z;
    made->backwards = camera->direction.z < 0;
    camera->mesh = made;
}

static void read_kind(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    expect_first(reader, word);
    grammar_word(reader, word);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++)
        if (strcmp(kinds[k].word, word->text) == 0) draft->camera.kind = kinds[k].kind;
    if (strcmp(word->text, "cylinder") == 0) read_cylinder(reader, word, draft);
    if (strcmp(word->text, "mesh_camera") == 0) read_meshes(reader, word, draft);
}

/* One number is the most; of two the first is the least. */
static void read_blur_samples(Reader *reader, const Word *word, void *target) {
    Camera *camera = &((CameraDraft *)target)->camera;
    double low = 0, high = 1;
    grammar_word(reader, word);
    if (!word->count || !word_float(reader, word, word->count - 1, &high)) return;
    if (word->count > 1 && !word_float(reader, word, 0, &low)) return;
    if (high < 1)
        reader_error(reader, word->arguments[word->count - 1].span,
                     "'blur_samples' must be at least 1, found %g", high);
    camera->least_blur_samples = double_to_int(low, 0, MOST_BLUR_SAMPLES);
    camera->most_blur_samples = double_to_int(high, 1, MOST_BLUR_SAMPLES);
}

static void read_focal_point(Reader *reader, const Word *word, void *target) {
    CameraDraft *draft = target;
    draft->has_focal_point =
        word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &draft->focal_point);
}

#define FIELD(name) offsetof(CameraDraft, name)
#define INERT(word)                                                                                          \
    { word, WORD_INERT, FIELD(camera.inert), NULL, false }
#define IGNORED(word)                                                                                        \
    { word, WORD_IGNORED, 0, NULL, false }
#define KIND(word)                                                                                           \
    { word, WORD_CUSTOM, 0, read_kind, false }
static const WordRule rules[] = {
    KIND("perspective"),
    KIND("orthographic"),
    {"location", WORD_VECTOR, FIELD(camera.location), NULL, false},
    {"direction", WORD_VECTOR, FIELD(camera.direction), NULL, false},
    {"right", WORD_CUSTOM, 0, read_right, false},
    {"up", WORD_CUSTOM, 0, read_up, false},
    {"sky", WORD_VECTOR, FIELD(sky), NULL, false},
    {"look_at", WORD_CUSTOM, 0, read_look_at, false},
    {"angle", WORD_CUSTOM, 0, read_angle, false},
    KIND("fisheye"),
    KIND("ultra_wide_angle"),
    KIND("omnimax"),
    KIND("panoramic"),
    KIND("spherical"),
    KIND("cylinder"),
    KIND("mesh_camera"),
    {"aperture", WORD_FLOAT, FIELD(camera.aperture), NULL, false},
    INERT("bokeh"),
    INERT("user_defined"),
    {"focal_point", WORD_CUSTOM, 0, read_focal_point, false},
    {"blur_samples", WORD_CUSTOM, 0, read_blur_samples, false},
    {"confidence", WORD_FLOAT, FIELD(camera.confidence), NULL, false},
    {"variance", WORD_FLOAT, FIELD(camera.variance), NULL, false},
};

static void apply_angle(CameraDraft *draft) {
    double length = vec3_length(draft->camera.right) / tan(draft->angle * VTS_RADIANS / 2) / 2;
    draft->camera.direction = vec3_scale(vec3_normalize(draft->camera.direction), length);
}

/* POV-Ray blames the whole camera at its end, if that is on another line. */
static Span at_close(const Reader *reader, Span span) {
    SourceSet *sources = reader->context->diags->sources;
    Span close = reader_close(reader);
    return source_locate(sources, close).line == source_locate(sources, span).line ? span : close;
}

/* Keeps the lengths of the three vectors and their handedness. */
static bool apply_look_at(Reader *reader, CameraDraft *draft) {
    Camera *c = &draft->camera;
    double direction_length = vec3_length(c->direction), up_length = vec3_length(c->up),
           right_length = vec3_length(c->right);
    double handedness = vec3_dot(vec3_cross(c->up, c->direction), c->right);
    Vec3 view = vec3_sub(draft->look_at, c->location);
    if (vec3_length_squared(view) < 1e-10) {
        reader_error(reader, at_close(reader, draft->look_at_span), "the camera looks at its own location");
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
static void check_frame(Reader *reader, const Camera *c) {
    double volume = vec3_dot(vec3_cross(c->up, c->direction), c->right);
    double lengths = vec3_length(c->up) * vec3_length(c->direction) * vec3_length(c->right);
    if (!(lengths > 0) || fabs(volume) < 1e-12 * lengths)
        diag_warning(reader->context->diags, reader->block->word_span,
                     "the camera's direction, right and up span no space");
    else if (fabs(volume) < (1 - 1e-8) * lengths)
        diag_warning(reader->context->diags, reader->block->word_span,
                     "the camera's vectors are not perpendicular");
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    (void)reader;
    CameraDraft *draft = target;
    if (value->value.kind != VALUE_NORMAL) return take_transform(value, &draft->transform);
    draft->camera.normal = value->value.as.normal;
    return true;
}

static bool is_flat(const Camera *c) { return c->kind == CAMERA_PERSPECTIVE || c->kind == CAMERA_ORTHOGRAPHIC; }

/* POV-Ray's limit: a flat picture cannot see behind itself. */
static bool check_angle(Reader *reader, CameraDraft *draft) {
    if (!is_flat(&draft->camera) || draft->angle < 180) return true;
    reader_error(reader, at_close(reader, draft->angle_span),
                 "the angle of this camera must be less than 180 degrees, found %g", draft->angle);
    return false;
}

static void apply_wide_angle(CameraDraft *draft) {
    Camera *c = &draft->camera;
    c->angle = draft->angle > 0 ? draft->angle : c->kind == CAMERA_SPHERICAL ? 360 : 90;
    c->angle_v = draft->angle_v > 0 ? draft->angle_v : c->angle / 2;
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
    reader.on_value = on_value;
    reader.value_target = &draft;
    if (!reader_run(&reader) || !check_angle(&reader, &draft)) return false;
    if (!copy) apply_wide_angle(&draft);
    if (!copy) aim_meshes(&reader, &draft.camera);
    if (draft.angle > 0 && is_flat(&draft.camera)) apply_angle(&draft);
    if (draft.has_look_at && !apply_look_at(&reader, &draft)) return false;
    if (!copy) apply_orthographic(&draft);
    Vec3 to_focus = draft.has_focal_point ? vec3_sub(draft.focal_point, draft.camera.location) : draft.camera.direction;
    if (!copy) draft.camera.focal_distance = vec3_length(to_focus);
    place(&draft.camera, &draft.transform);
    check_frame(&reader, &draft.camera);
    return store(context, block, draft.camera, out);
}
