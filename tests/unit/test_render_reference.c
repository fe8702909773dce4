/* The reference picture of skins against the same scene without any: each copy written out as an ordinary mesh, bent by a mapping
 * that the test computes for itself. */
#include "skin_scenes.h"

#include "image/metrics.h"
#include "render/exact_skin.h"
#include "render/reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

enum { SIDE = 32, SAMPLES = 64 };

/* ---- what the test knows of the mapping ---- */

typedef struct Bed {
    int nu, nv;         /* patches */
    double tiles;       /* along u and v */
    Vec3 (*foot)(double u, double v);
    Vec3 (*height)(double u, double v);
    double w_foot, w_tip; /* heights of the texel at foot and top; both 0: 0 and 1 */
} Bed;

static double bed_tip(const Bed *bed) { return bed->w_foot == bed->w_tip ? 1 : bed->w_tip; }

static Vec3 between_corners(const Bed *bed, Vec3 (*f)(double u, double v), int i, int j, double s, double t) {
    double u0 = (double)i / bed->nu, v0 = (double)j / bed->nv, u1 = (i + 1.0) / bed->nu, v1 = (j + 1.0) / bed->nv;
    return vec3_lerp(vec3_lerp(f(u0, v0), f(u1, v0), s), vec3_lerp(f(u0, v1), f(u1, v1), s), t);
}

/* Texture coordinates (tiles along u, height, tiles along v) → scene. */
static Vec3 bed_place(const Bed *bed, Vec3 x) {
    double u = x.x / bed->tiles * bed->nu, v = x.z / bed->tiles * bed->nv;
    int i = int_clamp((int)floor(u), 0, bed->nu - 1), j = int_clamp((int)floor(v), 0, bed->nv - 1);
    return vec3_madd(between_corners(bed, bed->foot, i, j, u - i, v - j), between_corners(bed, bed->height, i, j, u - i, v - j),
                     (x.y - bed->w_foot) / (bed_tip(bed) - bed->w_foot));
}

static Vec3 flat_foot(double u, double v) { return vec3(4 * u - 2, 0, 4 * v - 2); }
static Vec3 flat_height(double u, double v) { return (void)u, (void)v, vec3(0, 0.8, 0); }
static Vec3 hill_foot(double u, double v) { return vec3(4 * u - 2, 0.9 * sin(3 * u) * sin(2.6 * v) + 0.2 * u, 4 * v - 2); }
static Vec3 hill_height(double u, double v) { return vec3(0.25 * sin(4 * v), 0.7 + 0.2 * u, 0.3 * u - 0.1); }

static Vec3 mirrored_foot(double u, double v) { return hill_foot(1 - u, v); }
static Vec3 mirrored_height(double u, double v) { return hill_height(1 - u, v); }

static Vec3 crossing_height(double u, double v) { return vec3(-8 * (u - 0.5), 0.8, -8 * (v - 0.5)); }
static Vec3 twisted_height(double u, double v) { return vec3(-5 * (u - 0.5) + 2 * v, 0.9 + 0.3 * u, 4 * (u - 0.5) - 5 * (v - 0.5)); }

/* ---- content ---- */

enum { CONTENT = 14 };
typedef struct Content {
    Vec3 corner[CONTENT][3]; /* in the unit cube; across its side walls where it is cyclic */
} Content;

static void content_make(Content *c, RandomStream *r, double lo, double hi) {
    for (int i = 0; i < CONTENT; i++) {
        Vec3 middle = vec3(between(r, lo, hi), between(r, 0.25, 0.75), between(r, lo, hi));
        for (int k = 0; k < 3; k++)
            c->corner[i][k] = vec3_madd(middle, spread_direction(r), 0.22);
    }
}

static void scene_content(SkinScene *s, Content *c, unsigned cyclic) {
    skin_scene_fill(s, 8, CONTENT, 0.1, cyclic, 1); /* then other triangles */
    Vec3 *v = arena_new_array(&s->arena, Vec3, 3 * CONTENT);
    memcpy(v, c->corner, sizeof c->corner);
    s->leaf_mesh.vertices = v;
}

/* ---- the explicit scene ---- */

typedef struct Explicit {
    Vec3 *vertices;
    uint32_t (*triangles)[3];
    size_t vertex_count, triangle_count, capacity;
} Explicit;

static void explicit_triangle(Explicit *e, const Bed *bed, Vec3 a, Vec3 b, Vec3 c) {
    assert_true(e->triangle_count < e->capacity);
    Vec3 corner[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        e->triangles[e->triangle_count][k] = (uint32_t)e->vertex_count;
        e->vertices[e->vertex_count++] = bed_place(bed, corner[k]);
    }
    e->triangle_count++;
}

/* Cut n times along each edge, so that it can bend. */
static void explicit_bent(Explicit *e, const Bed *bed, const Vec3 corner[3], int n) {
    Vec3 along = vec3_scale(vec3_sub(corner[1], corner[0]), 1.0 / n), across = vec3_scale(vec3_sub(corner[2], corner[0]), 1.0 / n);
    for (int i = 0; i < n; i++)
        for (int j = 0; i + j < n; j++) {
            Vec3 p = vec3_madd(vec3_madd(corner[0], along, i), across, j), q = vec3_add(p, along), r = vec3_add(p, across);
            explicit_triangle(e, bed, p, q, r);
            if (i + j + 1 < n) explicit_triangle(e, bed, q, vec3_add(q, across), r);
        }
}

/* A point of the copy's unit square → tile coordinates: the inverse of what TexelCopy says. */
static Vec3 out_of_copy(const TexelCopy *copy, Vec3 p) {
    double det = copy->xu * copy->zv - copy->xv * copy->zu, x = p.x - copy->x0, z = p.z - copy->z0;
    return vec3((copy->zv * x - copy->xv * z) / det, p.y / copy->inverse_scale, (copy->xu * z - copy->zu * x) / det);
}

/* All copies of tiles [from, to)², as the compiled skin chooses them. */
static const MeshData *write_out(SkinScene *s, size_t texel, const Bed *bed, const Content *content, int from, int to, int cuts) {
    const PlacedTexel *placed = &s->compiled.skins[0].texels[texel];
    size_t most = (size_t)((to - from) * (to - from)) * CONTENT * (size_t)(cuts * cuts);
    Explicit e = {arena_new_array(&s->arena, Vec3, 3 * most), arena_push(&s->arena, most * sizeof *e.triangles), 0, 0, most};
    for (int i = from; i < to; i++)
        for (int j = from; j < to; j++) {
            TexelCopy copy;
            if (!texel_copy_of(placed, i, j, &copy)) continue;
            for (int k = 0; k < CONTENT; k++) {
                Vec3 corner[3];
                for (int m = 0; m < 3; m++) corner[m] = out_of_copy(&copy, content->corner[k][m]);
                explicit_bent(&e, bed, corner, cuts);
            }
        }
    MeshData *mesh = arena_new(&s->arena, MeshData);
    *mesh = (MeshData){.vertices = e.vertices, .vertex_count = e.vertex_count, .triangles = (const uint32_t(*)[3])e.triangles,
                       .triangle_count = e.triangle_count};
    return mesh;
}

/* ---- pictures ---- */

static void stage(SkinScene *s, Light *light, Vec3 eye, double angle) {
    skin_scene_begin(s);
    s->pigment.color = (Color){0.6, 0.8, 0.3, 0, 0};
    s->finish.ambient = (Color){0.1, 0.1, 0.1, 0, 0};
    s->finish.diffuse = 0.7;
    s->finish.transmission = 0.4;
    s->finish.specular = 0.3;
    Vec3 d = vec3_normalize(vec3_negate(eye)), right = vec3_normalize(vec3_cross(vec3(0, 1, 0), d));
    double wide = 2 * tan(angle / 2 * VTS_RADIANS);
    s->scene.camera = (Camera){.kind = CAMERA_PERSPECTIVE, .location = eye, .direction = d, .right = vec3_scale(right, wide),
                               .up = vec3_scale(vec3_cross(d, right), wide)};
    *light = (Light){.kind = LIGHT_PARALLEL, .to_light = vec3_normalize(vec3(0.5, 1, -0.4)), .color = {1, 1, 0.9, 0, 0}};
    s->scene.lights = light;
    s->scene.light_count = 1;
    s->scene.background = (Color){0.3, 0.4, 0.8, 0, 0};
}

static void compile(SkinScene *s) {
    const CompileOptions options = {.width = SIDE, .height = SIDE, .exact = true};
    assert_int_equal(compile_scene(&s->scene, &options, &s->arena, &s->diags, &s->compiled), COMPILE_OK);
}

static void picture(SkinScene *s, int samples, Image *out) {
    const RenderOptions options = {.region = {0, 0, SIDE, SIDE}, .samples = samples};
    RenderStats stats;
    assert_true(reference_picture(&s->compiled, &options, NULL, out, &stats, NULL));
}

static double variation(const Image *image) {
    double sum = 0, squares = 0, n = (double)SIDE * SIDE;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double v = (double)image->pixels[3 * i];
        sum += v, squares += v * v;
    }
    return sqrt(fmax(0, squares / n - sum / n * (sum / n)));
}

typedef struct Trial {
    const char *name;
    Bed bed;
    unsigned cyclic;
    double lo, hi;       /* where content is */
    int from, to, cuts;  /* tiles and triangles of the explicit scene */
    InstanceJitter jitter;
    Vec3 eye;
    double angle;        /* of the view: narrow where copies beyond the border are missing from the skin */
    double most;         /* RMSE */
    bool superimposed;   /* two texels in one layer */
} Trial;

/* Another texel in the same layer, of other content. */
static void superimpose(SkinScene *s, RandomStream *r, Content *content, const Trial *trial) {
    MeshData *mesh = arena_new(&s->arena, MeshData);
    Object *leaves = arena_new(&s->arena, Object);
    const Object **list = arena_new_array(&s->arena, const Object *, 1);
    TexelLayer *layer = arena_new(&s->arena, TexelLayer);
    TexelDef *texel = arena_new(&s->arena, TexelDef);
    SkinTexel *both = arena_new_array(&s->arena, SkinTexel, 2);
    content_make(content, r, trial->lo, trial->hi);
    *mesh = s->leaf_mesh;
    mesh->vertices = arena_copy(&s->arena, content->corner, sizeof content->corner);
    *leaves = (Object){.kind = OBJECT_TRIANGLES, .as.mesh = mesh};
    *list = leaves;
    *layer = (TexelLayer){.contents = list, .content_count = 1};
    *texel = s->texel;
    texel->name = "more leaves";
    texel->layers = layer;
    both[0] = s->placed;
    both[1] = (SkinTexel){.texel = texel, .density = 1};
    s->skin.texels = both;
    s->skin.texel_count = 2;
}

/* The skin's picture and that of its copies written out; a ground below for the shadows. */
static void compare_pictures_of(const Trial *trial, int samples) {
    SkinScene s;
    Light light;
    Content content;
    RandomStream r = {7};
    Image skin, plain;
    ImageDifference difference;
    stage(&s, &light, trial->eye, trial->angle);
    content_make(&content, &r, trial->lo, trial->hi);
    scene_content(&s, &content, trial->cyclic);
    skin_scene_grid(&s, trial->bed.nu, trial->bed.nv, trial->bed.foot, trial->bed.height);
    s.skin.mapping.repeat_u = s.skin.mapping.repeat_v = trial->bed.tiles;
    s.skin.mapping.w_foot = trial->bed.w_foot, s.skin.mapping.w_tip = bed_tip(&trial->bed);
    s.skin.jitter.instance = trial->jitter;
    Object ground = {.kind = OBJECT_PLANE, .as.plane = {{0, 1, 0}, -0.4}}, copies = {.kind = OBJECT_TRIANGLES}, more = copies;
    const Object *objects[3] = {&ground, &copies, &more};
    Content second;
    if (trial->superimposed) superimpose(&s, &r, &second, trial);
    s.scene.objects = objects;
    s.scene.object_count = 1;
    s.scene.skins = s.skins;
    s.scene.skin_count = 1;
    compile(&s);
    picture(&s, samples, &skin);
    if (trial->superimposed) more.as.mesh = write_out(&s, 1, &trial->bed, &second, trial->from, trial->to, trial->cuts);
    copies.as.mesh = write_out(&s, 0, &trial->bed, &content, trial->from, trial->to, trial->cuts);
    compiled_scene_destroy(&s.compiled);
    s.scene.skin_count = 0;
    s.scene.object_count = trial->superimposed ? 3 : 2;
    compile(&s);
    picture(&s, samples, &plain);
    assert_true(image_compare(&plain, &skin, &difference, NULL));
    printf("%-28s rmse %.5f, largest %.3f, deviation within the picture %.3f\n", trial->name, difference.rmse, difference.largest, variation(&plain));
    assert_true(variation(&plain) > 0.05); /* there is something to see */
    assert_true(difference.rmse < trial->most);
    image_free(&skin);
    image_free(&plain);
    skin_scene_end(&s);
}

static void compare_pictures(const Trial *trial) { compare_pictures_of(trial, SAMPLES); }

static const Vec3 NEAR_EYE = {0.6, 3.5, -4.5};
static const Bed FLAT = {1, 1, 5, flat_foot, flat_height, 0, 0}, HILL = {4, 3, 6, hill_foot, hill_height, 0, 0};

static void flat_tiles_are_the_objects_they_repeat(void **state) {
    (void)state;
    compare_pictures(&(Trial){"flat", FLAT, 0, 0.25, 0.75, 0, 5, 1, {0}, NEAR_EYE, 50, 0.0025, false});
    compare_pictures(&(Trial){"flat, edge-on", FLAT, 0, 0.25, 0.75, 0, 5, 1, {0}, {0.1, 0.4, -6}, 40, 0.0025, false});
}

static void bent_tiles_are_the_objects_bent(void **state) {
    (void)state;
    compare_pictures(&(Trial){"hill", HILL, 0, 0.25, 0.75, 0, 6, 12, {0}, NEAR_EYE, 50, 0.0025, false});
}

/* Where height vectors cross, sheets lie over one another, and all of them are seen. */
static void folded_layers_show_all_their_sheets(void **state) {
    (void)state;
    compare_pictures_of(&(Trial){"collapsed half way up", {2, 2, 5, flat_foot, crossing_height, 0, 0}, 0, 0.25, 0.75, 0, 5, 12, {0}, NEAR_EYE, 30, 0.012, false}, 9);
    compare_pictures_of(&(Trial){"folded and twisted", {3, 2, 6, hill_foot, twisted_height, 0, 0}, 0, 0.25, 0.75, 0, 6, 24, {0}, NEAR_EYE, 30, 0.012, false}, 9);
}

static void content_goes_on_across_borders_of_tiles(void **state) {
    (void)state;
    const unsigned both = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z;
    compare_pictures(&(Trial){"cyclic", {1, 1, 7, flat_foot, flat_height, 0, 0}, both, -0.3, 1.3, -1, 8, 1, {0}, {0, 4, -0.6}, 24, 0.0025, false});
    compare_pictures(&(Trial){"cyclic hill", {4, 3, 7, hill_foot, hill_height, 0, 0}, both, -0.3, 1.3, -1, 8, 12, {0}, {0, 4, -0.6}, 24, 0.0025, false});
}

static void jittered_copies_lie_where_the_placing_says(void **state) {
    (void)state;
    InstanceJitter jitter = {.present = true, .displace = 0.8, .rotate = 360, .scale = 0.5, .mirror = true, .density = 0.8};
    compare_pictures(&(Trial){"jittered", {1, 1, 9, flat_foot, flat_height, 0, 0}, 0, 0.3, 0.7, -2, 11, 1, jitter, {0, 4, -0.6}, 24, 0.0025, false});
    compare_pictures(&(Trial){"jittered hill", {4, 3, 9, hill_foot, hill_height, 0, 0}, 0, 0.3, 0.7, -2, 11, 10, jitter, {0, 4, -0.6}, 24, 0.0025, false});
}

/* At the border too, where a copy stands on the surface with the middle of its tile; a skin without a border would be cut there. */
static void copies_are_whole_at_the_border(void **state) {
    (void)state;
    InstanceJitter jitter = {.present = true, .displace = 0.8, .rotate = 360, .scale = 0.5, .mirror = true, .density = 0.9}, large = jitter;
    large.displace = 0, large.scale = 1.8;
    compare_pictures(&(Trial){"whole at the border", FLAT, 0, 0.25, 0.75, 0, 5, 1, jitter, NEAR_EYE, 60, 0.003, false});
    compare_pictures(&(Trial){"of six patches", {3, 2, 5, flat_foot, flat_height, 0, 0}, 0, 0.25, 0.75, 0, 5, 1, jitter, NEAR_EYE, 60, 0.003, false});
    compare_pictures(&(Trial){"enlarged", FLAT, 0, 0.25, 0.75, 0, 5, 1, large, NEAR_EYE, 60, 0.003, false});
}

static void mirrored_skins_are_the_objects_mirrored(void **state) {
    (void)state;
    compare_pictures(&(Trial){"mirrored hill", {4, 3, 6, mirrored_foot, mirrored_height, 0, 0}, 0, 0.25, 0.75, 0, 6, 12, {0}, NEAR_EYE, 50, 0.0025, false});
}

static void heights_of_the_texel_may_be_shifted_and_stretched(void **state) {
    (void)state;
    compare_pictures(&(Trial){"w from -0.4 to 1.7", {4, 3, 6, hill_foot, hill_height, -0.4, 1.7}, 0, 0.25, 0.75, 0, 6, 12, {0}, NEAR_EYE, 50, 0.0025, false});
    compare_pictures(&(Trial){"w from 1.2 to -0.3", {4, 3, 6, hill_foot, hill_height, 1.2, -0.3}, 0, 0.25, 0.75, 0, 6, 12, {0}, NEAR_EYE, 50, 0.0025, false});
}

static void superimposed_texels_are_both_there(void **state) {
    (void)state;
    InstanceJitter jitter = {.present = true, .displace = 0.8, .rotate = 360, .scale = 0.5, .mirror = true, .density = 0.8};
    compare_pictures(&(Trial){"two texels", HILL, 0, 0.25, 0.75, 0, 6, 12, {0}, NEAR_EYE, 50, 0.0025, true});
    compare_pictures(&(Trial){"two texels, jittered", {4, 3, 9, hill_foot, hill_height, 0, 0}, 0, 0.3, 0.7, -2, 11, 10, jitter, {0, 4, -0.6}, 24, 0.0025, true});
}

/* ---- texels placed as objects ---- */

enum { PLACED = 60 };

/* Turned, sheared, stretched and, every other one, mirrored. */
static Affine any_place(RandomStream *r, int number) {
    Affine place = {.offset = {between(r, -2, 1.5), between(r, -0.3, 0.5), between(r, -2, 1.5)}};
    for (int k = 0; k < 3; k++)
        place.linear.c[k] = vec3(between(r, -0.3, 0.3) + 0.7 * (k == 0), between(r, -0.3, 0.3) + 0.7 * (k == 1), between(r, -0.3, 0.3) + 0.7 * (k == 2));
    if (number & 1) place.linear.c[0] = vec3_negate(place.linear.c[0]);
    return place;
}

static void texels_placed_as_objects_are_their_contents(void **state) {
    (void)state;
    SkinScene s;
    Light light;
    Content content;
    RandomStream r = {13};
    Affine places[PLACED];
    Object placed[2][PLACED];
    const Object *objects[PLACED];
    Image pictures[2];
    ImageDifference difference;
    stage(&s, &light, NEAR_EYE, 28);
    content_make(&content, &r, 0.25, 0.75);
    scene_content(&s, &content, 0);
    for (int i = 0; i < PLACED; i++) {
        places[i] = any_place(&r, i);
        placed[0][i] = (Object){.kind = OBJECT_TEXEL, .place = &places[i], .as.texel = &s.texel};
        placed[1][i] = (Object){.kind = OBJECT_TRIANGLES, .place = &places[i], .as.mesh = &s.leaf_mesh};
    }
    s.scene.objects = objects;
    s.scene.object_count = PLACED;
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < PLACED; i++) objects[i] = &placed[k][i];
        compile(&s);
        assert_int_equal(s.compiled.skin_count, k == 0 ? PLACED : 0);
        picture(&s, SAMPLES, &pictures[k]);
        if (k == 0) compiled_scene_destroy(&s.compiled);
    }
    assert_true(image_compare(&pictures[1], &pictures[0], &difference, NULL));
    printf("placed as objects: rmse %.5f, largest %.3f, deviation within the picture %.3f\n", difference.rmse, difference.largest, variation(&pictures[1]));
    assert_true(variation(&pictures[1]) > 0.05);
    assert_true(difference.rmse < 0.0025);
    image_free(&pictures[0]);
    image_free(&pictures[1]);
    skin_scene_end(&s);
}

/* ---- single rays ---- */

/* Without a picture's mean: distance and normal of what single rays meet, from outside and from within the layer. */
static void rays_meet_the_bent_triangles(void **state) {
    (void)state;
    SkinScene s;
    Light light;
    Content content;
    RandomStream r = {9};
    stage(&s, &light, NEAR_EYE, 50);
    content_make(&content, &r, 0.25, 0.75);
    scene_content(&s, &content, 0);
    skin_scene_grid(&s, HILL.nu, HILL.nv, HILL.foot, HILL.height);
    s.skin.mapping.repeat_u = s.skin.mapping.repeat_v = HILL.tiles;
    s.scene.skins = s.skins;
    s.scene.skin_count = 1;
    compile(&s);
    SkinScene plain = {0};
    plain.scene = s.scene;
    plain.scene.skin_count = 0;
    Object copies = {.kind = OBJECT_TRIANGLES, .as.mesh = write_out(&s, 0, &HILL, &content, 0, 6, 24)};
    const Object *objects[1] = {&copies};
    plain.scene.objects = objects;
    plain.scene.object_count = 1;
    const CompileOptions options = {.width = SIDE, .height = SIDE, .exact = true};
    arena_init(&plain.arena, NULL, 0);
    assert_int_equal(compile_scene(&plain.scene, &options, &plain.arena, &s.diags, &plain.compiled), COMPILE_OK);
    const ExactSkins *skin = s.compiled.exact;
    enum { RAYS = 8000 };
    int both = 0, one = 0, turned = 0;
    double worst = 0;
    TraceCounters counters = {0};
    for (int i = 0; i < RAYS; i++) {
        Vec3 target = bed_place(&HILL, vec3(between(&r, 0, 6), between(&r, 0, 1), between(&r, 0, 6))), d = spread_direction(&r);
        Ray ray = {vec3_madd(target, d, i & 1 ? -5 : 0), d};
        SkinHit hit;
        SurfaceHit explicit_hit;
        bool found = exact_skins_intersect(skin, &ray, 0, 20, &counters, &hit);
        bool expected = hierarchy_intersect(plain.compiled.hierarchy, &ray, 0, 20, &explicit_hit);
        assert_int_equal(found, exact_skins_occluded(skin, &ray, 0, 20, &counters));
        if (!found && !expected) continue;
        if (!found || !expected || fabs(hit.t - explicit_hit.t) > 0.01) {
            one++; /* past an edge, by what is left of facets and chords */
            continue;
        }
        both++;
        worst = fmax(worst, fabs(hit.t - explicit_hit.t) * fabs(vec3_dot(explicit_hit.normal, d)));
        turned += fabs(vec3_dot(hit.normal, explicit_hit.normal)) < 0.995;
    }
    printf("%d rays meet the same, %d do not; worst distance from the plane %.1e; %d normals off\n", both, one, worst, turned);
    assert_true(both > RAYS / 4);
    assert_true(one < both / 200);
    assert_true(worst < 3e-4);
    assert_true(turned < both / 500);
    compiled_scene_destroy(&plain.compiled);
    arena_destroy(&plain.arena);
    skin_scene_end(&s);
}

/* ---- what must not break it ---- */

static Vec3 no_height(double u, double v) { return (void)u, (void)v, vec3(0, 0, 0); }
static Vec3 no_area(double u, double v) { return (void)v, vec3(u, 0, 0); }

static void absurd_skins_end(void **state) {
    (void)state;
    static const struct {
        Vec3 (*foot)(double, double);
        Vec3 (*height)(double, double);
        double tiles;
    } absurd[] = {{hill_foot, crossing_height, 4}, {flat_foot, no_height, 4}, {no_area, flat_height, 4}, {flat_foot, flat_height, 1e6},
                  {flat_foot, flat_height, 1e300}, {flat_foot, flat_height, 0}, {hill_foot, hill_height, 1e5}};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(absurd); k++) {
        SkinScene s;
        Light light;
        Content content;
        RandomStream r = {11};
        stage(&s, &light, NEAR_EYE, 50);
        content_make(&content, &r, -40, 40); /* most of it far outside */
        content.corner[0][0].x = (double)NAN;
        content.corner[1][1].y = VTS_INFINITY;
        content.corner[2][2].z = 1e30;
        scene_content(&s, &content, k & 1 ? TEXEL_CYCLIC_X | TEXEL_CYCLIC_Y | TEXEL_CYCLIC_Z : 0);
        skin_scene_grid(&s, 2, 2, absurd[k].foot, absurd[k].height);
        s.skin.mapping.repeat_u = s.skin.mapping.repeat_v = absurd[k].tiles;
        s.scene.skins = s.skins;
        s.scene.skin_count = 1;
        const CompileOptions options = {.width = SIDE, .height = SIDE, .exact = true};
        if (compile_scene(&s.scene, &options, &s.arena, &s.diags, &s.compiled) == COMPILE_OK) {
            Image out;
            RenderStats stats;
            const RenderOptions render = {.region = {0, 0, SIDE, SIDE}, .samples = 1};
            assert_true(reference_picture(&s.compiled, &render, NULL, &out, &stats, NULL));
            for (int i = 0; i < 3 * SIDE * SIDE; i++) assert_true(isfinite(out.pixels[i]));
            image_free(&out);
        }
        skin_scene_end(&s);
    }
}

/* ---- sampling ---- */

/* A picture of a slanted edge comes near its areas as strata promise, for numbers that are no squares too. */
static void samples_cover_the_pixel_evenly(void **state) {
    (void)state;
    static const int counts[] = {1, 2, 7, 16, 61, 256};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(counts); k++) {
        SkinScene s;
        Light light;
        stage(&s, &light, vec3(0, 0, -4), 40);
        s.finish.ambient = (Color){1, 1, 1, 0, 0};
        s.finish.diffuse = s.finish.transmission = s.finish.specular = 0;
        s.pigment.color = (Color){1, 1, 1, 0, 0};
        s.scene.background = (Color){0};
        /* Half of the picture, cut by a line through its middle. */
        Vec3 v[3] = {{-100, 100 / 3.0, 0}, {100, -100 / 3.0, 0}, {-100, -400, 0}};
        uint32_t t[1][3] = {{0, 1, 2}};
        MeshData mesh = {.vertices = v, .vertex_count = 3, .triangles = (const uint32_t(*)[3])t, .triangle_count = 1};
        Object half = {.kind = OBJECT_TRIANGLES, .as.mesh = &mesh};
        const Object *objects[1] = {&half};
        s.scene.objects = objects;
        s.scene.object_count = 1;
        compile(&s);
        const RenderOptions options = {.region = {0, 0, SIDE, SIDE}, .samples = counts[k], .seed = 3};
        Image out;
        RenderStats stats;
        assert_true(reference_picture(&s.compiled, &options, NULL, &out, &stats, NULL));
        assert_int_equal(stats.counters.camera_rays, (uint64_t)counts[k] * SIDE * SIDE);
        double sum = 0;
        for (int i = 0; i < SIDE * SIDE; i++) sum += (double)out.pixels[3 * i];
        double mean = sum / (SIDE * SIDE);
        printf("%3d samples: half the picture is %.5f\n", counts[k], mean);
        assert_true(fabs(mean - 0.5) < 0.02 / counts[k] + 0.0005);
        image_free(&out);
        skin_scene_end(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(flat_tiles_are_the_objects_they_repeat),
                                       cmocka_unit_test(bent_tiles_are_the_objects_bent),
                                       cmocka_unit_test(folded_layers_show_all_their_sheets),
                                       cmocka_unit_test(content_goes_on_across_borders_of_tiles),
                                       cmocka_unit_test(jittered_copies_lie_where_the_placing_says),
                                       cmocka_unit_test(copies_are_whole_at_the_border), cmocka_unit_test(mirrored_skins_are_the_objects_mirrored),
                                       cmocka_unit_test(heights_of_the_texel_may_be_shifted_and_stretched),
                                       cmocka_unit_test(superimposed_texels_are_both_there),
                                       cmocka_unit_test(texels_placed_as_objects_are_their_contents),
                                       cmocka_unit_test(rays_meet_the_bent_triangles),
                                       cmocka_unit_test(absurd_skins_end),
                                       cmocka_unit_test(samples_cover_the_pixel_evenly)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
