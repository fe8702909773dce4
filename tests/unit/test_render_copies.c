/* Copies under the hierarchy: geometry is shared, looks, places and interiors are not. */
#include "object_parts.h"
#include "render/hierarchy.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

typedef struct World {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Pigment pigment;
    Finish finish;
    Texture texture;
    const Object *list[8];
    Scene scene;
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

/* Two balls, one with a texture of its own; of the copies each has another. */
static void copies_keep_places_and_looks(void **state) {
    (void)state;
    World w;
    world_begin(&w);
    Texture own = w.texture, first = w.texture, second = w.texture;
    const Transform up = transform_translate(vec3(0, 3, 0)), left = transform_translate(vec3(-5, 0, 0)),
                    right = transform_translate(vec3(5, 0, 0)), wide = transform_scale(vec3(2, 1, 1)), place = transform_then(&wide, &right);
    Object plain = {.kind = OBJECT_SPHERE, .as.sphere = {{0, 0, 0}, 1, 0}};
    Object dressed = {.kind = OBJECT_SPHERE, .place = PLACE(up), .texture = &own, .as.sphere = {{0, 0, 0}, 1, 0}};
    const Object *inner[] = {&plain, &dressed};
    Object a = {.kind = OBJECT_UNION, .place = PLACE(left), .texture = &first, .as.group = GROUP(inner, 2)}, b = a;
    b.place = PLACE(place);
    b.texture = &second;
    w.list[0] = &a, w.list[1] = &b;
    w.scene.object_count = 2;
    Hierarchy *h = hierarchy_build(&w.scene, 1e4, &w.arena, &w.diags);
    const struct {
        double x, y, t;
        const Texture *texture;
        Vec3 local;
    } rays[] = {{-5, 0, 9, &first, {0, 0, -1}},
                {5, 0, 9, &second, {0, 0, -1}},
                {-5, 3, 9, &own, {0, 0, -1}},
                {6, 3, 10 - sqrt(0.75), &own, {0.5, 0, -sqrt(0.75)}}};
    SurfaceHit hits[VTS_ARRAY_COUNT(rays)];
    for (size_t i = 0; i < VTS_ARRAY_COUNT(rays); i++) {
        const Ray ray = {{rays[i].x, rays[i].y, -10}, {0, 0, 1}};
        assert_true(hierarchy_intersect(h, &ray, 1e-9, VTS_INFINITY, &hits[i]));
        assert_true(fabs(hits[i].t - rays[i].t) < 1e-9);
        assert_ptr_equal(hits[i].look->texture, rays[i].texture);
        Vec3 local = transform_point_back(&hits[i].space, vec3_madd(ray.origin, ray.direction, hits[i].t));
        assert_true(vec3_length(vec3_sub(local, rays[i].local)) < 1e-9);
        for (size_t k = 0; k < i; k++) assert_int_not_equal(hits[i].object, hits[k].object);
    }
    hierarchy_destroy(h);
    arena_destroy(&w.arena);
}

/* A set's surfaces: what is cut off is not met, and the cut faces outwards. */
static void differences_are_hollowed(void **state) {
    (void)state;
    World w;
    world_begin(&w);
    Texture cut = w.texture;
    Object box = {.kind = OBJECT_BOX, .as.box = {{-1, -1, -1}, {1, 1, 1}}};
    Object ball = {.kind = OBJECT_SPHERE, .texture = &cut, .as.sphere = {{0, 0, -1}, 0.5, 0}};
    const Object *parts[] = {&box, &ball};
    Object set = {.kind = OBJECT_DIFFERENCE, .as.group = GROUP(parts, 2)};
    w.list[0] = &set;
    w.scene.object_count = 1;
    Hierarchy *h = hierarchy_build(&w.scene, 1e4, &w.arena, &w.diags);
    const Ray middle = {{0, 0, -5}, {0, 0, 1}}, side = {{0.7, 0, -5}, {0, 0, 1}};
    SurfaceHit hit;
    assert_true(hierarchy_intersect(h, &middle, 1e-9, VTS_INFINITY, &hit));
    assert_true(fabs(hit.t - 4.5) < 1e-9 && hit.look->texture == &cut && !hit.leaving && hit.normal.z < -0.999);
    assert_true(hierarchy_intersect(h, &side, 1e-9, VTS_INFINITY, &hit));
    assert_true(fabs(hit.t - 4) < 1e-9 && hit.look->texture == &w.texture);
    assert_true(hierarchy_meet(h, RAY_SEES, &side, 4.5, VTS_INFINITY, &hit));
    assert_true(fabs(hit.t - 6) < 1e-9 && hit.leaving);
    hierarchy_destroy(h);
    arena_destroy(&w.arena);
}

/* Places within what has an interior, seen through copies. */
static void insides_are_found(void **state) {
    (void)state;
    World w;
    world_begin(&w);
    const Interior glass = interior_default();
    const ObjectRest rest = {.interior = &glass};
    const Transform left = transform_translate(vec3(-5, 0, 0)), right = transform_translate(vec3(5, 0, 0));
    Object full = {.kind = OBJECT_SPHERE, .rest = &rest, .as.sphere = {{0, 0, 0}, 1, 0}};
    Object empty = {.kind = OBJECT_SPHERE, .as.sphere = {{0, 3, 0}, 1, 0}};
    const Object *inner[] = {&full, &empty};
    Object a = {.kind = OBJECT_UNION, .place = PLACE(left), .as.group = GROUP(inner, 2)}, b = a;
    b.place = PLACE(right);
    w.list[0] = &a, w.list[1] = &b;
    w.scene.object_count = 2;
    Hierarchy *h = hierarchy_build(&w.scene, 1e4, &w.arena, &w.diags);
    Filling at_left[4], at_right[4];
    assert_int_equal(hierarchy_inside(h, vec3(0, 0, 0), at_left, 4), 0);
    assert_int_equal(hierarchy_inside(h, vec3(5, 3, 0), at_left, 4), 0);
    assert_int_equal(hierarchy_inside(h, vec3(-5, 0, 0.5), at_left, 4), 1);
    assert_int_equal(hierarchy_inside(h, vec3(5.5, 0, 0), at_right, 4), 1);
    assert_ptr_equal(at_left[0].interior, &glass);
    assert_true(at_left[0].filled != at_right[0].filled);
    const Ray out = {{5, 0, 0}, {0, 0, 1}};
    SurfaceHit hit;
    assert_true(hierarchy_intersect(h, &out, 1e-9, VTS_INFINITY, &hit));
    assert_true(hit.leaving && hit.interior == &glass && hit.filled == at_right[0].filled);
    hierarchy_destroy(h);
    arena_destroy(&w.arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_keep_places_and_looks),
        cmocka_unit_test(differences_are_hollowed),
        cmocka_unit_test(insides_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
