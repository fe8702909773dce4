/* Explicit objects under the hierarchy, against intersecting each of them. */
#include "object_parts.h"
#include "base/random.h"
#include "render/hierarchy.h"
#include "shape/intersect.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_OBJECTS = 80 };

typedef struct World {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Pigment pigment;
    Finish finish;
    Texture texture;
    Object objects[MOST_OBJECTS];
    const Object *list[MOST_OBJECTS];
    Scene scene;
    Hierarchy *hierarchy;
} World;

static void world_begin(World *w) {
    memset(w, 0, sizeof *w);
    arena_init(&w->arena, NULL, 0);
    source_set_init(&w->sources, &w->arena);
    diag_init(&w->diags, &w->arena, &w->sources);
    w->pigment = pigment_default();
    w->finish = finish_default();
    w->texture = (Texture){.pigment = &w->pigment, .finish = &w->finish, .transform = transform_identity()};
    w->scene = (Scene){.objects = w->list, .default_texture = &w->texture, .settings = global_settings_default()};
}

static Object *world_add(World *w, ObjectKind kind) {
    size_t i = w->scene.object_count++;
    w->objects[i] = (Object){.kind = (uint8_t)kind};
    w->list[i] = &w->objects[i];
    return &w->objects[i];
}

static void world_build(World *w) {
    w->hierarchy = hierarchy_build(&w->scene, VTS_INFINITY, &w->arena, &w->diags);
    assert_non_null(w->hierarchy);
}

static void world_end(World *w) {
    hierarchy_destroy(w->hierarchy);
    arena_destroy(&w->arena);
}

static double centered(RandomStream *r) { return 2 * random_next_unit(r) - 1; }
static Vec3 random_vec(RandomStream *r, double size) { return vec3(size * centered(r), size * centered(r), size * centered(r)); }

static Transform random_transform(RandomStream *r, double spread) {
    Transform scale = transform_scale(vec3(.2 + random_next_unit(r), (random_next_unit(r) < .5 ? -1 : 1) * (.2 + random_next_unit(r)), .2 + random_next_unit(r)));
    Transform turn = transform_rotate(random_vec(r, 180)), move = transform_translate(random_vec(r, spread));
    Transform both = transform_then(&scale, &turn);
    return transform_then(&both, &move);
}

static void add_random_solids(World *w, RandomStream *r, int count, double spread) {
    static const ObjectKind kinds[] = {OBJECT_SPHERE, OBJECT_BOX, OBJECT_CYLINDER, OBJECT_CONE, OBJECT_DISC, OBJECT_TORUS};
    for (int i = 0; i < count; i++) {
        Object *o = world_add(w, kinds[i % 6]);
        const Transform place = random_transform(r, spread);
        o->place = arena_copy(&w->arena, PLACE(place), sizeof(Affine));
        switch (o->kind) {
        case OBJECT_SPHERE: o->as.sphere.radius = 1; break;
        case OBJECT_BOX: o->as.box.corner1 = vec3(-1, -.5, -1), o->as.box.corner2 = vec3(1, .7, .4); break;
        case OBJECT_CYLINDER:
        case OBJECT_CONE:
            o->as.cone.base = vec3(0, -1, 0), o->as.cone.cap = vec3(.1, 1, 0), o->as.cone.base_radius = .7;
            o->as.cone.cap_radius = o->kind == OBJECT_CONE ? .2 : .7;
            o->as.cone.open = i % 4 == 0;
            break;
        case OBJECT_DISC: o->as.disc.normal = vec3(0, 1, 0), o->as.disc.radius = 1, o->as.disc.hole_radius = .3; break;
        default: o->as.torus.major_radius = 1, o->as.torus.minor_radius = .3; break;
        }
    }
}

/* The nearest hit of all objects, one by one. */
static bool brute_force(const World *w, const Ray *ray, double t_max, bool shadow, double *t, Vec3 *normal, const Object **nearest) {
    *t = t_max;
    *nearest = NULL;
    for (size_t i = 0; i < w->scene.object_count; i++) {
        const Object *o = w->list[i];
        if (shadow ? o->no_shadow : o->no_image) continue;
        const Transform place = object_transform(o);
        Ray local = {transform_point_back(&place, ray->origin), transform_vector_back(&place, ray->direction)};
        ShapeHit hit;
        if (!shape_intersect(o, &local, 1e-9, *t, &hit)) continue;
        *t = hit.t;
        *normal = vec3_normalize(transform_normal(&place, hit.normal));
        *nearest = o;
    }
    return *nearest != NULL;
}

static void solids_are_hit_exactly(void **state) {
    (void)state;
    RandomStream r = {1};
    static const double spreads[] = {4, 30};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(spreads); k++) {
        World w;
        world_begin(&w);
        add_random_solids(&w, &r, 60, spreads[k]);
        Object *ground = world_add(&w, OBJECT_PLANE);
        ground->as.plane.normal = vec3(0, 1, 0), ground->as.plane.distance = -spreads[k] / 2;
        for (size_t i = 0; i < w.scene.object_count; i++) {
            w.objects[i].no_shadow = i % 5 == 0;
            w.objects[i].no_image = i % 7 == 0;
        }
        world_build(&w);
        assert_int_equal(hierarchy_object_count(w.hierarchy), 61);
        int hits = 0, shadows = 0;
        for (int i = 0; i < 20000; i++) {
            Vec3 target = i % 3 ? object_transform(&w.objects[i % 60]).offset : random_vec(&r, spreads[k]);
            Ray ray = {random_vec(&r, 2 * spreads[k]), {0, 0, 0}};
            ray.direction = vec3_normalize(vec3_add(vec3_sub(target, ray.origin), random_vec(&r, .8)));
            double t, t_max = i % 4 ? VTS_INFINITY : 2 * spreads[k] * random_next_unit(&r);
            Vec3 normal;
            const Object *object;
            SurfaceHit hit;
            bool want = brute_force(&w, &ray, t_max, false, &t, &normal, &object);
            bool got = hierarchy_intersect(w.hierarchy, &ray, 1e-9, t_max, &hit);
            assert_int_equal(want, got);
            if (want) {
                hits++;
                assert_true(fabs(hit.t - t) < 1e-6 * (1 + t)); /* two surfaces may be that near to each other */
                if (hit.t == t) {
                    double facing = vec3_dot(normal, ray.direction) > 0 ? -1 : 1;
                    assert_true(vec3_length(vec3_sub(hit.normal, vec3_scale(normal, facing))) < 1e-9);
                }
                assert_true(vec3_dot(hit.normal, ray.direction) <= 0);
                assert_true(fabs(vec3_length(hit.normal) - 1) < 1e-12);
                assert_non_null(hit.look);
            }
            bool dark = brute_force(&w, &ray, t_max, true, &t, &normal, &object);
            assert_int_equal(hierarchy_occluded(w.hierarchy, &ray, 1e-9, t_max), dark);
            shadows += dark;
        }
        printf("%d hits, %d shadows of 20000\n", hits, shadows);
        assert_true(hits > 8000 && shadows > 3000);
        world_end(&w);
    }
}

/* Triangles: a mesh among solids, hidden from the eye or casting no shadow. */
static void meshes_obey_no_shadow_and_no_image(void **state) {
    (void)state;
    static const Vec3 vertices[] = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    static const uint32_t triangles[][3] = {{0, 1, 2}};
    static const MeshData mesh = {.vertices = vertices, .vertex_count = 3, .triangles = triangles, .triangle_count = 1};
    for (int k = 0; k < 4; k++) {
        World w;
        world_begin(&w);
        Object *o = world_add(&w, OBJECT_TRIANGLES), *below = world_add(&w, OBJECT_SPHERE);
        o->as.mesh = &mesh;
        o->no_image = k & 1, o->no_shadow = (k & 2) != 0;
        below->as.sphere.center = vec3(0, -5, 0), below->as.sphere.radius = 1;
        below->no_shadow = true;
        world_build(&w);
        Ray down = {{0, 3, 0}, {0, -1, 0}};
        SurfaceHit hit;
        assert_true(hierarchy_intersect(w.hierarchy, &down, 1e-9, VTS_INFINITY, &hit));
        assert_true(fabs(hit.t - (o->no_image ? 7 : 3)) < 1e-6);
        assert_true(hit.normal.y > .999);
        assert_int_equal(hierarchy_occluded(w.hierarchy, &down, 1e-9, VTS_INFINITY), !o->no_shadow);
        assert_false(hierarchy_occluded(w.hierarchy, &down, 1e-9, 2.9));
        assert_false(hierarchy_intersect(w.hierarchy, &down, 1e-9, 2.9, &hit));
        world_end(&w);
    }
}

/* A ball out of few triangles with the ball's normals, turned, scaled and mirrored: normals are the ball's all over. */
static void smooth_normals_are_interpolated(void **state) {
    (void)state;
    enum { RINGS = 12, SIDES = 24 };
    static Vec3 vertices[(RINGS + 1) * (SIDES + 1)];
    static uint32_t triangles[2 * RINGS * SIDES][3];
    size_t nt = 0;
    for (uint32_t j = 0; j <= RINGS; j++)
        for (uint32_t i = 0; i <= SIDES; i++) {
            double a = VTS_PI * j / RINGS, b = 2 * VTS_PI * i / SIDES;
            vertices[j * (SIDES + 1) + i] = vec3(sin(a) * cos(b), cos(a), sin(a) * sin(b));
        }
    for (uint32_t j = 0; j < RINGS; j++)
        for (uint32_t i = 0; i < SIDES; i++) {
            uint32_t v = j * (SIDES + 1) + i, corner[2][3] = {{v, v + 1, v + SIDES + 1}, {v + 1, v + SIDES + 2, v + SIDES + 1}};
            memcpy(triangles[nt++], corner[0], sizeof corner[0]);
            memcpy(triangles[nt++], corner[1], sizeof corner[1]);
        }
    MeshData mesh = {.vertices = vertices, .vertex_count = VTS_ARRAY_COUNT(vertices), .normals = vertices,
                     .normal_count = VTS_ARRAY_COUNT(vertices), .triangles = (const uint32_t(*)[3])triangles, .triangle_count = nt};
    RandomStream r = {3};
    for (int k = 0; k < 6; k++) {
        World w;
        world_begin(&w);
        Object *o = world_add(&w, OBJECT_TRIANGLES);
        o->as.mesh = &mesh;
        const Transform place = random_transform(&r, 3);
        o->place = PLACE(place);
        world_build(&w);
        double worst = 0;
        int hits = 0;
        for (int i = 0; i < 2000; i++) {
            Ray ray = {random_vec(&r, 10), {0, 0, 0}};
            ray.direction = vec3_normalize(vec3_sub(transform_point(&place, random_vec(&r, .5)), ray.origin));
            SurfaceHit hit;
            if (!hierarchy_intersect(w.hierarchy, &ray, 1e-9, VTS_INFINITY, &hit)) continue;
            hits++;
            Vec3 local = transform_point_back(&place, vec3_madd(ray.origin, ray.direction, hit.t));
            assert_true(fabs(vec3_length(local) - 1) < .03);
            Vec3 n = vec3_normalize(transform_normal(&place, local));
            if (vec3_dot(n, ray.direction) > 0) n = vec3_negate(n);
            assert_true(vec3_dot(hit.normal, ray.direction) <= 0);
            if (vec3_dot(n, ray.direction) < -.2) worst = fmax(worst, vec3_length(vec3_sub(n, hit.normal)));
        }
        assert_true(hits > 1500);
        assert_true(worst < .1); /* facets are up to .13 off at their rims */
        world_end(&w);
    }
}

/* Unions pass on transforms and textures; parts are told apart. */
static void unions_are_flattened(void **state) {
    (void)state;
    World w;
    world_begin(&w);
    Texture own = w.texture;
    const Transform right = transform_translate(vec3(2, 0, 0));
    Object ball = {.kind = OBJECT_SPHERE, .place = PLACE(right), .as.sphere = {{0, 0, 0}, 1, 0}};
    Object box = {.kind = OBJECT_BOX, .as.box = {{-1, -1, -1}, {1, 1, 1}}, .texture = &own};
    const Object *inner[] = {&ball, &box};
    Object *o = world_add(&w, OBJECT_UNION);
    Texture outer = w.texture;
    o->texture = &outer;
    o->as.group = GROUP(inner, 2);
    Transform turn = transform_rotate(vec3(0, 90, 0)), move = transform_translate(vec3(0, 0, 10));
    const Transform place = transform_then(&turn, &move);
    o->place = PLACE(place); /* <2, 0, 0> comes to <0, 0, -2> + <0, 0, 10> */
    world_build(&w);
    Ray at_ball = {{0, 0, 0}, {0, 0, 1}}, at_box = {{.9, 0, 20}, {0, 0, -1}};
    SurfaceHit a, b;
    assert_true(hierarchy_intersect(w.hierarchy, &at_ball, 1e-9, VTS_INFINITY, &a));
    assert_true(fabs(a.t - 7) < 1e-9 && a.look->texture == &outer);
    assert_true(hierarchy_intersect(w.hierarchy, &at_box, 1e-9, VTS_INFINITY, &b));
    assert_true(fabs(b.t - 9) < 1e-9 && b.look->texture == &own);
    assert_int_not_equal(a.object, b.object);
    Vec3 local = transform_point_back(&a.space, vec3(0, 0, 7));
    assert_true(vec3_length(vec3_sub(local, vec3(3, 0, 0))) < 1e-9); /* the union's space, which has the texture */
    world_end(&w);
}

/* The camera may be far from everything: floats of the hierarchy must not lose what doubles see. */
static void far_cameras_still_hit(void **state) {
    (void)state;
    RandomStream r = {8};
    World w;
    world_begin(&w);
    Object *o = world_add(&w, OBJECT_SPHERE);
    o->as.sphere.radius = 1;
    world_build(&w);
    static const double distances[] = {1e2, 1e4, 1e6};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(distances); k++) {
        int lost = 0;
        for (int i = 0; i < 2000; i++) {
            double phi = 2 * VTS_PI * random_next_unit(&r), cosine = centered(&r), radius = .95 * sqrt(random_next_unit(&r));
            Vec3 d = vec3(sqrt(1 - cosine * cosine) * cos(phi), cosine, sqrt(1 - cosine * cosine) * sin(phi)), s, t;
            vec3_frame(d, &s, &t);
            Ray ray = {vec3_madd(vec3_madd(vec3_scale(d, -distances[k]), s, radius * cos(phi)), t, radius * sin(phi)), d};
            SurfaceHit hit;
            if (!hierarchy_intersect(w.hierarchy, &ray, 1e-9, VTS_INFINITY, &hit)) lost++;
        }
        printf("from %g: %d of 2000 lost\n", distances[k], lost);
        if (k < 2) assert_int_equal(lost, 0);
    }
    world_end(&w);
}

/* An open cylinder shows nothing but the edge of its wall to an eye on its axis. */
static void sheets_are_not_known_to_be_wide(void **state) {
    (void)state;
    for (int open = 0; open < 2; open++) {
        World w;
        world_begin(&w);
        Object *object = world_add(&w, OBJECT_CYLINDER);
        object->as.cone.cap = vec3(0, 0, 4);
        object->as.cone.base_radius = object->as.cone.cap_radius = 2;
        object->as.cone.open = open;
        world_build(&w);
        const VistaPieces *pieces = hierarchy_pieces(w.hierarchy);
        assert_int_equal(pieces->count, 1);
        assert_int_equal(pieces->items[0].whole, !open);
        world_end(&w);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_are_hit_exactly),
        cmocka_unit_test(meshes_obey_no_shadow_and_no_image),
        cmocka_unit_test(smooth_normals_are_interpolated),
        cmocka_unit_test(unions_are_flattened),
        cmocka_unit_test(far_cameras_still_hit),
        cmocka_unit_test(sheets_are_not_known_to_be_wide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
