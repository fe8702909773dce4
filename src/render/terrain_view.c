#include "render/terrain_view.h"

#include "base/stopwatch.h"
#include "pattern/pattern.h"
#include "render/lighting.h"
#include "render/view_reach.h"
#include "scene/scene_hash.h"
#include "shape/tessellate.h"
#include "terrain/ground_horizon.h"

#include <string.h>

/* How far the ground may be from where it is drawn, in pixels, for the default error (slopes, and with them the light, then are off by
 * about three quarters of that error; both fall alike); what is out of the picture or hidden behind nearer ground shows by its shadows and
 * in mirrors. */
static const double PIXELS_OFF = 0.2, PIXELS_OFF_EXACT = 0.05, DEFAULT_MAX_ERROR = 1.0 / 255;
static const double OUTSIDE = 8;
/* What is out of the picture, and cannot cast a shadow into it, is seen in mirrors and hides the sky alone: as in a picture whose pixels are no narrower than this, in radians. */
static const double UNSEEN_PIXEL = 1e-3;
/* How far a lamp without a place is taken to be, against what can be seen. */
static const double LAMP_DISTANCE = 1000;
/* What stands on the ground is seen over it: a skin's height, and as much for functions that make it higher, wind and jitter. */
static const double RISE = 2;
/* Cells of skins: what changes along a skin changes over them. */
static const double CELL_PIXELS = 8;
enum { VAST = 500000 };

/* One terrain at one place. */
typedef struct Stand {
    const Terrain *terrain;
    Transform to_world;
    double longest_side; /* of cells, scene units; HUGE_VAL: no skin on it */
    double rise;         /* of its skins, scene units */
    bool slope_grows;    /* a skin is as high as the slope of its ground says */
    const MeshData *mesh;
} Stand;

/* A group of objects that was looked through. */
typedef struct SeenGroup {
    const ObjectGroup *group;
    bool has_terrain;
} SeenGroup;

typedef struct Lowering {
    const Scene *scene;
    const View *view;
    const TerrainViewOptions *options;
    Arena *arena, *scratch;
    DiagList *diags;
    BuiltTerrains *built;
    struct { Stand *items; size_t count, capacity; } stands;
    struct { SeenGroup *items; size_t count, capacity; } groups; /* open addressing */
    double spread, width; /* of the narrowest pixel: growth with the distance, and at the camera */
    bool failed;
} Lowering;

/* ---- how fine ---- */

/* How much a pixel widens with the distance: of one that is narrow, as at the poles of a panorama, where one place is as wide as the picture, the
 * longer side. */
static double pixel_spread(const View *view, double x, double y, const Cone *cone) {
    if (view_is_flat(view) || cone->width > 0) return cone->spread;
    double most = cone->spread;
    const double beside[2][2] = {{x > view->width / 2.0 ? x - 1 : x + 1, y}, {x, y > view->height / 2.0 ? y - 1 : y + 1}};
    for (int k = 0; k < 2; k++) {
        Cone other = view_cone(view, beside[k][0], beside[k][1], 1);
        if (vec3_length_squared(other.direction) > 0) most = fmax(most, vec3_length(vec3_sub(other.direction, cone->direction)));
    }
    return most;
}

/* The least of the pixels' widths: those of a flat picture's corners are smaller than those of its middle. */
static void measure_pixels(Lowering *l) {
    enum { STEPS = 4 };
    l->spread = l->width = HUGE_VAL;
    for (int j = 0; j <= STEPS; j++)
        for (int i = 0; i <= STEPS; i++) {
            const double x = (double)i / STEPS * l->view->width, y = (double)j / STEPS * l->view->height;
            Cone cone = view_cone(l->view, x, y, 1);
            if (vec3_length_squared(cone.direction) == 0) continue;
            l->spread = fmin(l->spread, pixel_spread(l->view, x, y, &cone));
            l->width = fmin(l->width, cone.width);
        }
    if (!isfinite(l->spread)) l->spread = l->width = 0;
}

typedef struct Allowance {
    const Lowering *lowering;
    const Stand *stand;
    GroundHorizon *horizon; /* or NULL */
    const ViewReach *reaches; /* of lamps that cast shadows; NULL: anything may shade the picture */
    size_t reach_count;
    double stretch, pixels_off;
} Allowance;

static bool is_hidden(const Allowance *a, const GroundSpot *spot) {
    const double rise = a->stand->rise / a->stretch;
    return a->horizon && ground_horizon_hides(a->horizon, spot->centre, spot->radius + rise, spot->top + rise, a->lowering->spread);
}

/* Neither seen nor between the picture and a lamp. */
static bool is_unseen(const Allowance *a, Box3 box) {
    if (!a->reaches) return false;
    for (size_t i = 0; i < a->reach_count; i++)
        if (!view_reach_misses(&a->reaches[i], box)) return false;
    return true;
}

static void allow(const void *context, const GroundSpot *spot, double *error, double *side) {
    const Allowance *a = context;
    const Lowering *l = a->lowering;
    Vec3 at = transform_point(&a->stand->to_world, spot->centre);
    double reach = spot->radius * a->stretch, distance = fmax(0, vec3_length(vec3_sub(at, l->view->camera.location)) - reach);
    double pixel = (l->width + l->spread * distance) / a->stretch;
    const Box3 box = {vec3_sub(at, vec3_splat(reach)), vec3_add(at, vec3_splat(reach))};
    if (!l->options->exact && view_misses(l->view, box)) pixel = OUTSIDE * (is_unseen(a, box) ? fmax(pixel, UNSEEN_PIXEL * distance / a->stretch) : pixel);
    else if (!l->options->exact && is_hidden(a, spot)) pixel *= OUTSIDE;
    *error = pixel * a->pixels_off;
    *side = isfinite(a->stand->longest_side) ? fmax(CELL_PIXELS * pixel, a->stand->longest_side / a->stretch) : HUGE_VAL;
}

/* Slopes that tell how high a skin is show by more than their light: a little error moves the border of a wood by many pixels, where the ground bends slowly. */
static double pixels_off(const TerrainViewOptions *options, const Stand *stand) {
    if (options->exact || stand->slope_grows) return PIXELS_OFF_EXACT;
    return double_clamp(PIXELS_OFF * options->max_error / DEFAULT_MAX_ERROR, PIXELS_OFF_EXACT, 2);
}

/* Of what lines of sight that begin at one point alone meet. */
static GroundHorizon *horizon_of(const Lowering *l, const Stand *stand) {
    const View *view = l->view;
    const bool point = view->camera.kind != CAMERA_ORTHOGRAPHIC && view->camera.kind < CAMERA_CYLINDER_1 && !view_has_lens(view);
    if (l->options->exact || stand->terrain->every_post || !point || transform_is_singular(&stand->to_world)) return NULL;
    const Transform back = transform_inverse(&stand->to_world);
    return ground_horizon_create(stand->terrain->ground, transform_point(&back, view->camera.location), l->scratch);
}

/* From the camera to the farthest corner of the ground. */
static double farthest(const Lowering *l, const Stand *stand) {
    const Box3 b = stand->terrain->ground->bounds;
    double far = 0;
    for (int k = 0; k < 8; k++) {
        const Vec3 corner = vec3(k & 1 ? b.max.x : b.min.x, k & 2 ? b.max.y : b.min.y, k & 4 ? b.max.z : b.min.z);
        far = fmax(far, vec3_length(vec3_sub(transform_point(&stand->to_world, corner), l->view->camera.location)));
    }
    return far;
}

/* Of flat pictures, whose lines of sight all lie in one pyramid. */
static void find_reaches(const Lowering *l, const Stand *stand, Allowance *out) {
    const View *view = l->view;
    const double far = farthest(l, stand);
    if (view->camera.kind != CAMERA_PERSPECTIVE || view->camera.normal || view_has_lens(view) || !isfinite(far)) return;
    ViewReach *reaches = arena_new_array(l->scratch, ViewReach, l->scene->light_count + 1);
    for (size_t i = 0; i < l->scene->light_count; i++) {
        const Light *light = &l->scene->lights[i];
        if (light->shadowless) continue;
        const Vec3 away = vec3_madd(view->camera.location, light->to_light, LAMP_DISTANCE * far);
        reaches[out->reach_count++] = view_reach(view, far, light_is_parallel(light) ? away : light->location);
    }
    out->reaches = reaches;
}

static void keep_account(Lowering *l, const Stand *stand, size_t needed, double seconds) {
    const Ground *ground = stand->terrain->ground;
    const MeshData *mesh = stand->mesh;
    const size_t bytes = mesh->vertex_count * 2 * sizeof(Vec3) + mesh->triangle_count * sizeof *mesh->triangles;
    *list_push(l->arena, l->built) = (BuiltTerrain){.terrain = stand->terrain, .columns = ground->source.columns, .rows = ground->source.rows,
        .needed = needed, .triangles = mesh->triangle_count, .bytes = bytes, .seconds = seconds};
}

static const MeshData *mesh_of(Lowering *l, Stand *stand) {
    if (stand->mesh) return stand->mesh;
    const Ground *ground = stand->terrain->ground;
    const double start = stopwatch_wall();
    ArenaMark mark = arena_mark(l->scratch);
    Allowance allowance = {.lowering = l, .stand = stand, .horizon = horizon_of(l, stand), .stretch = tessellate_stretch(&stand->to_world.linear), .pixels_off = pixels_off(l->options, stand)};
    find_reaches(l, stand, &allowance);
    const GroundDetail detail = {.allow = allow, .context = &allowance, .every_post = stand->terrain->every_post, .most_vertices = l->options->most_vertices};
    MeshData *mesh = arena_new(l->arena, MeshData);
    GroundErrors errors;
    size_t needed;
    ground_errors_build(&ground->source, l->options->pool, l->scratch, &errors);
    if (!ground_mesh_build(&ground->source, &errors, &detail, l->scratch, l->arena, mesh, &needed)) {
        Diagnostic *d = diag_error(l->diags, stand->terrain->span, "this terrain needs more than %zu vertices", l->options->most_vertices);
        if (stand->terrain->every_post) diag_hint(l->diags, d, "it has %d x %d posts: 'detail auto' draws those that are seen", ground->source.columns, ground->source.rows);
        l->failed = true;
    }
    arena_reset_to(l->scratch, mark);
    if (mesh->triangle_count > VAST) memory_trim(); /* hierarchies take their memory elsewhere */
    mesh_rehash(mesh);
    stand->mesh = mesh;
    keep_account(l, stand, needed, stopwatch_wall() - start);
    return mesh;
}

/* ---- what stands where ---- */

static bool same_transform(const Transform *a, const Transform *b) {
    return memcmp(&a->linear, &b->linear, sizeof a->linear) == 0 && memcmp(&a->offset, &b->offset, sizeof a->offset) == 0;
}

static Stand *stand_of(Lowering *l, const Terrain *terrain, const Transform *to_world) {
    for (size_t i = 0; i < l->stands.count; i++) {
        Stand *stand = &l->stands.items[i];
        if (stand->terrain == terrain && same_transform(&stand->to_world, to_world)) return stand;
    }
    Stand *stand = list_push(l->arena, &l->stands);
    *stand = (Stand){.terrain = terrain, .to_world = *to_world, .longest_side = HUGE_VAL};
    return stand;
}

/* ---- surfaces and objects ---- */

static const Object *mesh_object(const Lowering *l, const Surface *s, const MeshData *mesh) {
    const Object object = {.span = s->span, .kind = OBJECT_TRIANGLES, .depth = 1, .texture = s->texture, .as.mesh = mesh};
    return object_keep(l->arena, &object, NULL);
}

static const Surface *lower_surface(Lowering *l, const Surface *s, const Transform *outer) {
    if (s->kind != SURFACE_TERRAIN) return s;
    Transform to_world = transform_then(&s->transform, outer);
    Surface *out = arena_copy(l->arena, s, sizeof *s);
    out->kind = SURFACE_OBJECT;
    out->uv = SURFACE_UV_MESH;
    out->subdivide = int_max(1, s->subdivide);
    out->object = mesh_object(l, s, mesh_of(l, stand_of(l, s->terrain, &to_world)));
    surface_rehash(out);
    return out;
}

/* A surface of triangles as they are is a mesh. */
static const Object *lower_surface_object(Lowering *l, const Object *object, const Transform *to_world) {
    if (object->as.surface->kind != SURFACE_TERRAIN) return object;
    const Surface *s = lower_surface(l, object->as.surface, to_world);
    Object out = object_copy(object);
    Transform place = object_transform(object);
    out.as.surface = s;
    if (s->deform || s->subdivide > 1) return object_keep(l->arena, &out, NULL);
    place = transform_then(&s->transform, &place);
    out.kind = OBJECT_TRIANGLES;
    out.as.mesh = s->object->as.mesh;
    if (!out.texture) out.texture = s->texture;
    return object_keep(l->arena, &out, &place);
}

static SeenGroup *find_group(Lowering *l, const ObjectGroup *group) {
    for (size_t i = ((uintptr_t)group >> 4) % l->groups.capacity;; i = (i + 1) % l->groups.capacity)
        if (!l->groups.items[i].group || l->groups.items[i].group == group) return &l->groups.items[i];
}

static void grow_groups(Lowering *l) {
    SeenGroup *old = l->groups.items;
    size_t capacity = l->groups.capacity;
    l->groups.capacity = capacity ? 2 * capacity : 256;
    l->groups.items = arena_new_array(l->arena, SeenGroup, l->groups.capacity);
    for (size_t i = 0; i < capacity; i++)
        if (old[i].group) *find_group(l, old[i].group) = old[i];
}

static bool has_terrain(Lowering *l, const Object *object) {
    if (object->kind == OBJECT_SURFACE) return object->as.surface->kind == SURFACE_TERRAIN;
    if (!object_has_group(object)) return false;
    const ObjectGroup *group = object->as.group;
    if (2 * l->groups.count >= l->groups.capacity) grow_groups(l);
    const SeenGroup *seen = find_group(l, group);
    if (seen->group) return seen->has_terrain;
    bool has = false;
    for (size_t i = 0; i < group->count && !has; i++) has = has_terrain(l, group->items[i]);
    if (2 * l->groups.count >= l->groups.capacity) grow_groups(l);
    *find_group(l, group) = (SeenGroup){group, has};
    l->groups.count++;
    return has;
}

/* Recursion is as deep as objects are nested. */
static const Object *lower_object(Lowering *l, const Object *object, const Transform *outer) {
    if (!has_terrain(l, object)) return object;
    Transform own = object_transform(object), to_world = transform_then(&own, outer);
    if (object->kind == OBJECT_SURFACE) return lower_surface_object(l, object, &to_world);
    ObjectGroup *group = arena_copy(l->arena, object->as.group, sizeof *group);
    const Object **items = arena_new_array(l->arena, const Object *, group->count);
    for (size_t i = 0; i < group->count; i++) items[i] = lower_object(l, object->as.group->items[i], &to_world);
    group->items = items;
    group->hashed = false;
    Object out = object_copy(object);
    out.as.group = group;
    return object_keep(l->arena, &out, NULL);
}

/* ---- the scene ---- */

static void ask_for_cells(Lowering *l, const Skin *skin) {
    const Surface *s = skin->surface;
    if (s->kind != SURFACE_TERRAIN) return;
    Stand *stand = stand_of(l, s->terrain, &s->transform);
    stand->longest_side = fmin(stand->longest_side, l->options->skin_side(skin));
    stand->rise = fmax(stand->rise, RISE * fabs(skin->mapping.height));
    stand->slope_grows |= skin->mapping.height_pigment && pigment_follows_slope(skin->mapping.height_pigment);
}

static const Skin *lower_skin(Lowering *l, const Skin *skin) {
    const Transform identity = transform_identity();
    if (skin->surface->kind != SURFACE_TERRAIN) return skin;
    Skin *out = arena_copy(l->arena, skin, sizeof *skin);
    out->surface = lower_surface(l, skin->surface, &identity);
    return out;
}

const Scene *terrains_as_seen(const Scene *scene, const View *view, const TerrainViewOptions *options, Arena *scratch, Arena *arena,
                              DiagList *diags, BuiltTerrains *built) {
    const Transform identity = transform_identity();
    if (!scene->has_terrain) return scene;
    Lowering l = {.scene = scene, .view = view, .options = options, .arena = arena, .scratch = scratch, .diags = diags, .built = built};
    measure_pixels(&l);
    for (size_t i = 0; i < scene->skin_count; i++) ask_for_cells(&l, scene->skins[i]);
    const Object **objects = arena_new_array(arena, const Object *, scene->object_count);
    for (size_t i = 0; i < scene->object_count; i++) objects[i] = lower_object(&l, scene->objects[i], &identity);
    const Skin **skins = arena_new_array(arena, const Skin *, scene->skin_count);
    for (size_t i = 0; i < scene->skin_count; i++) skins[i] = lower_skin(&l, scene->skins[i]);
    Scene *out = arena_copy(arena, scene, sizeof *scene);
    out->objects = objects;
    out->skins = skins;
    return l.failed ? NULL : out;
}
