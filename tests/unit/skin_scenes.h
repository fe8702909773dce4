/* Skins for the tests of the renderer: scenes made without the language, and exact answers about them. */
#ifndef VTS_TESTS_SKIN_SCENES_H
#define VTS_TESTS_SKIN_SCENES_H

#include "base/random.h"
#include "render/compile.h"

#include <stdlib.h>
#include <string.h>

/* ---- numbers ---- */

static inline double between(RandomStream *r, double lo, double hi) { return lo + (hi - lo) * random_next_unit(r); }

static inline Vec3 spread_direction(RandomStream *r) {
    double z = between(r, -1, 1), phi = between(r, 0, 2 * VTS_PI), s = sqrt(1 - z * z);
    return vec3(s * cos(phi), s * sin(phi), z);
}

/* ---- meshes ---- */

typedef struct BallMesh {
    Vec3 vertices[700];
    uint32_t triangles[1280][3];
    size_t vertex_count, triangle_count;
} BallMesh;

static inline uint32_t ball_vertex(BallMesh *b, Vec3 v) {
    v = vec3_normalize(v);
    for (size_t i = 0; i < b->vertex_count; i++)
        if (vec3_length_squared(vec3_sub(b->vertices[i], v)) < 1e-12) return (uint32_t)i;
    b->vertices[b->vertex_count] = v;
    return (uint32_t)b->vertex_count++;
}

/* The icosahedron with each edge halved `times` times, on the unit sphere. Convex, as is any scaled copy. */
static inline void ball_make(BallMesh *b, int times) {
    const double g = (1 + sqrt(5.0)) / 2;
    const double start[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    static const uint8_t face[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8},
                                        {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
    memset(b, 0, sizeof *b);
    for (int i = 0; i < 12; i++) ball_vertex(b, vec3(start[i][0], start[i][1], start[i][2]));
    for (int i = 0; i < 20; i++)
        for (int k = 0; k < 3; k++) b->triangles[i][k] = face[i][k];
    b->triangle_count = 20;
    for (; times > 0; times--) {
        size_t count = b->triangle_count;
        for (size_t i = 0; i < count; i++) {
            uint32_t *t = b->triangles[i], m[3];
            for (int k = 0; k < 3; k++) m[k] = ball_vertex(b, vec3_add(b->vertices[t[k]], b->vertices[t[(k + 1) % 3]]));
            const uint32_t parts[3][3] = {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}};
            for (int k = 0; k < 3; k++) memcpy(b->triangles[b->triangle_count++], parts[k], sizeof parts[k]);
            memcpy(t, m, sizeof m);
        }
    }
}

/* Where the ray is inside the convex body of the ball's faces, scaled by `radius` about `center`; false: nowhere. Faces
 * as half spaces: what is aimed at edges and vertices needs no care. */
static inline bool ball_clip(const BallMesh *b, Vec3 center, double radius, const Ray *ray, double *t0, double *t1) {
    *t0 = -VTS_INFINITY, *t1 = VTS_INFINITY;
    Vec3 o = vec3_sub(ray->origin, center);
    for (size_t i = 0; i < b->triangle_count; i++) {
        const uint32_t *t = b->triangles[i];
        Vec3 p = b->vertices[t[0]];
        Vec3 n = vec3_cross(vec3_sub(b->vertices[t[1]], p), vec3_sub(b->vertices[t[2]], p));
        if (vec3_dot(n, p) < 0) n = vec3_negate(n);
        double rest = radius * vec3_dot(n, p) - vec3_dot(n, o), rate = vec3_dot(n, ray->direction);
        if (rate > 0) *t1 = fmin(*t1, rest / rate);
        else if (rate < 0) *t0 = fmax(*t0, rest / rate);
        else if (rest < 0) return false;
    }
    return *t0 < *t1;
}

/* The parts of the ray in the layer between the ball and the ball scaled by 1 + height: up to two intervals. */
typedef struct LayerParts {
    int count;
    double from[2], to[2];
} LayerParts;

static inline LayerParts ball_layer_parts(const BallMesh *b, Vec3 center, double radius, double height, const Ray *ray, double t_min) {
    LayerParts parts = {0};
    double a, d, f, e;
    if (!ball_clip(b, center, radius * (1 + height), ray, &a, &d)) return parts;
    bool inner = ball_clip(b, center, radius, ray, &f, &e);
    double from[2] = {a, e}, to[2] = {inner ? f : d, d};
    for (int i = 0; i < (inner ? 2 : 1); i++) {
        double lo = fmax(from[i], t_min);
        if (to[i] <= lo) continue;
        parts.from[parts.count] = lo;
        parts.to[parts.count++] = to[i];
    }
    return parts;
}

static inline double layer_length(const LayerParts *parts) {
    double sum = 0;
    for (int i = 0; i < parts->count; i++) sum += parts->to[i] - parts->from[i];
    return sum;
}

/* ---- scenes ---- */

typedef struct SkinScene {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Scene scene;
    Pigment pigment;
    Finish finish;
    Texture texture;
    Surface surface;
    Object object;
    MeshData mesh;
    TexelDef texel;
    TexelLayer layer;
    Object leaves;
    MeshData leaf_mesh;
    const Object *leaf_list[1];
    SkinTexel placed;
    Skin skin;
    const Skin *skins[1];
    CompiledScene compiled;
    SkinMarch march; /* through the compiled skin */
} SkinScene;

static inline void skin_scene_begin(SkinScene *s) {
    memset(s, 0, sizeof *s);
    arena_init(&s->arena, NULL, 0);
    source_set_init(&s->sources, &s->arena);
    diag_init(&s->diags, &s->arena, &s->sources);
    s->pigment = pigment_default();
    s->finish = finish_default();
    s->texture = (Texture){.pigment = &s->pigment, .finish = &s->finish, .transform = transform_identity()};
    s->scene = (Scene){.name = "test", .camera = camera_default(1), .has_camera = true, .default_texture = &s->texture,
                       .settings = global_settings_default()};
    s->scene.settings.detail = "voxels"; /* whatever the camera sees */
    s->scene.camera.location = vec3(0, 0, -5);
    s->skins[0] = &s->skin;
    s->skin = (Skin){.surface = &s->surface, .mapping = {.repeat_u = 1, .repeat_v = 1, .height = 1, .w_tip = 1},
                     .jitter = {.coordinates.scale = 1, .height.scale = 1, .direction.scale = 1}};
}

static inline void skin_scene_end(SkinScene *s) {
    compiled_scene_destroy(&s->compiled);
    arena_destroy(&s->arena);
}

/* A texel filled with `count` small triangles turned at random, so that each voxel of `resolution` holds some. */
static inline void skin_scene_fill(SkinScene *s, int resolution, size_t count, double size, unsigned cyclic, uint64_t seed) {
    RandomStream r = {seed};
    Vec3 *v = arena_new_array(&s->arena, Vec3, 3 * count);
    uint32_t(*t)[3] = arena_push(&s->arena, count * sizeof *t);
    for (size_t i = 0; i < count; i++) {
        Vec3 c = vec3(random_next_unit(&r), random_next_unit(&r), random_next_unit(&r)), a, b;
        vec3_frame(spread_direction(&r), &a, &b);
        for (int k = 0; k < 3; k++) {
            double phi = 2 * VTS_PI * k / 3;
            v[3 * i + (size_t)k] = vec3_madd(vec3_madd(c, a, size * cos(phi)), b, size * sin(phi));
            t[i][k] = (uint32_t)(3 * i) + (uint32_t)k;
        }
    }
    s->leaf_mesh = (MeshData){.vertices = v, .vertex_count = 3 * count, .triangles = (const uint32_t(*)[3])t, .triangle_count = count};
    s->leaves = (Object){.kind = OBJECT_TRIANGLES, .as.mesh = &s->leaf_mesh};
    s->leaf_list[0] = &s->leaves;
    s->layer = (TexelLayer){.contents = s->leaf_list, .content_count = 1};
    s->texel = (TexelDef){.name = "leaves", .bounds = {{0, 0, 0}, {1, 1, 1}}, .resolution = resolution, .cyclic = cyclic,
                          .layers = &s->layer, .layer_count = 1};
    s->placed = (SkinTexel){.texel = &s->texel, .density = 1};
    s->skin.texels = &s->placed;
    s->skin.texel_count = 1;
}

/* The surface: the ball, with height vectors straight out from its centre. */
static inline void skin_scene_ball(SkinScene *s, const BallMesh *b, Vec3 center, double radius, double height) {
    Vec3 *v = arena_new_array(&s->arena, Vec3, b->vertex_count), *h = arena_new_array(&s->arena, Vec3, b->vertex_count);
    for (size_t i = 0; i < b->vertex_count; i++) {
        v[i] = vec3_madd(center, b->vertices[i], radius);
        h[i] = vec3_scale(b->vertices[i], radius * height);
    }
    s->mesh = (MeshData){.vertices = v, .vertex_count = b->vertex_count, .triangles = b->triangles, .triangle_count = b->triangle_count,
                         .height_vectors = h};
    s->object = (Object){.kind = OBJECT_TRIANGLES, .as.mesh = &s->mesh};
    s->surface = (Surface){.kind = SURFACE_OBJECT, .object = &s->object, .uv = SURFACE_UV_SPHERICAL, .uv_axis = {0, 1, 0},
                           .object_height_vectors = h, .subdivide = 1, .transform = transform_identity()};
}

/* A grid of bilinear patches. `height` NULL: unit normals. */
static inline void skin_scene_grid(SkinScene *s, int nu, int nv, Vec3 (*foot)(double u, double v), Vec3 (*height)(double u, double v)) {
    size_t count = (size_t)(nu + 1) * (size_t)(nv + 1);
    Vec3 *p = arena_new_array(&s->arena, Vec3, count), *h = arena_new_array(&s->arena, Vec3, count);
    for (int i = 0; i <= nu; i++)
        for (int j = 0; j <= nv; j++) {
            size_t k = (size_t)(i * (nv + 1) + j);
            p[k] = foot((double)i / nu, (double)j / nv);
            if (height) h[k] = height((double)i / nu, (double)j / nv);
        }
    s->surface = (Surface){.kind = SURFACE_PATCHES, .nu = nu, .nv = nv, .points = p, .height_vectors = height ? h : NULL,
                           .transform = transform_identity()};
}

static inline CompileStatus skin_scene_compile(SkinScene *s) {
    s->scene.skins = s->skins;
    s->scene.skin_count = 1;
    const CompileOptions options = {.width = 100, .height = 100};
    CompileStatus status = compile_scene(&s->scene, &options, &s->arena, &s->diags, &s->compiled);
    if (s->compiled.skin_count) skin_march_init(&s->march, &s->compiled.skins[0], &s->arena);
    return status;
}

/* Corner k of the cell (foot or top) as its mapping has it. */
static inline Vec3 cell_corner(const SkinCell *cell, int k, double w) {
    static const double quad[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, triangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    const double *at = cell->triangle ? triangle[k] : quad[k];
    return skin_cell_position(cell, at[0], at[1], w, NULL);
}

#endif
