/* What may cast a shadow with an edge into a piece of a line of sight: nothing that does is missed, against rays, and what does not is told apart. */
#include "object_parts.h"
#include "base/random.h"
#include "render/blockers.h"
#include "render/hierarchy.h"
#include "scene/medium.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_OBJECTS = 300 };

/* Objects of one opaque and one clear texture. */
typedef struct World {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Pigment pigment, clear_pigment;
    Finish finish;
    Texture texture, clear;
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
    w->pigment = w->clear_pigment = pigment_default();
    w->clear_pigment.color.transmit = 1;
    w->finish = finish_default();
    w->texture = (Texture){.pigment = &w->pigment, .finish = &w->finish, .transform = transform_identity()};
    w->clear = (Texture){.pigment = &w->clear_pigment, .finish = &w->finish, .transform = transform_identity()};
    w->scene = (Scene){.objects = w->list, .default_texture = &w->texture, .settings = global_settings_default(), .has_media = true};
}

static Object *world_add(World *w, ObjectKind kind) {
    size_t i = w->scene.object_count++;
    w->objects[i] = (Object){.kind = (uint8_t)kind};
    w->list[i] = &w->objects[i];
    return &w->objects[i];
}

static Object *add_ball(World *w, Vec3 center, double radius) {
    Object *ball = world_add(w, OBJECT_SPHERE);
    ball->as.sphere.center = center, ball->as.sphere.radius = radius;
    return ball;
}

static const Blockers *world_blockers(World *w) {
    w->hierarchy = hierarchy_build(&w->scene, VTS_INFINITY, &w->arena, &w->diags);
    assert_non_null(w->hierarchy);
    assert_non_null(hierarchy_blockers(w->hierarchy));
    return hierarchy_blockers(w->hierarchy);
}

static void world_end(World *w) {
    hierarchy_destroy(w->hierarchy);
    arena_destroy(&w->arena);
}

/* The light of a lamp at `lamp` on the way from (-1, 0, 0) to (1, 0, 0). */
static LightHull hull_to(Vec3 lamp) { return (LightHull){.points = {vec3(-1, 0, 0), vec3(1, 0, 0), lamp}, .count = 3}; }

static bool touch(World *w, const LightHull *hull) {
    bool touched = blockers_touch(world_blockers(w), hull);
    world_end(w);
    return touched;
}

static Vec3 random_vec(RandomStream *r, double size) {
    double x = 2 * random_next_unit(r) - 1, y = 2 * random_next_unit(r) - 1, z = 2 * random_next_unit(r) - 1;
    return vec3(size * x, size * y, size * z);
}

static bool ray_is_blocked(const World *w, Vec3 from, Vec3 to) {
    double far = vec3_length(vec3_sub(to, from));
    return hierarchy_occluded(w->hierarchy, &(Ray){from, vec3_scale(vec3_sub(to, from), 1 / far)}, 0, far);
}

/* Where it says that nothing blocks, no ray between the piece and the lamp is blocked; and it says so often. */
static void no_shadow_is_missed(void **state) {
    (void)state;
    RandomStream r = {7};
    int open = 0, hulls = 0, shadows = 0;
    for (int scene = 0; scene < 20; scene++) {
        World w;
        world_begin(&w);
        for (int i = 0; i < 5; i++) {
            Object *o = i % 2 ? world_add(&w, OBJECT_BOX) : add_ball(&w, random_vec(&r, 3), 0.1 + 0.5 * random_next_unit(&r));
            if (o->kind == OBJECT_BOX) {
                const Transform turn = transform_rotate(random_vec(&r, 180)), move = transform_translate(random_vec(&r, 3)), both = transform_then(&turn, &move);
                o->place = arena_copy(&w.arena, PLACE(both), sizeof(Affine));
                o->as.box.corner1 = vec3(-.3, -.2, -.6), o->as.box.corner2 = vec3(.3, .4, .1);
            }
        }
        if (scene % 4 == 0) {
            Object *plane = world_add(&w, OBJECT_PLANE);
            plane->as.plane.normal = vec3_normalize(random_vec(&r, 1)), plane->as.plane.distance = -1;
        }
        const Blockers *blockers = world_blockers(&w);
        for (int i = 0; i < 50; i++, hulls++) {
            LightHull hull = {.count = 3};
            for (int k = 0; k < 3; k++) hull.points[k] = random_vec(&r, 3);
            bool touched = blockers_touch(blockers, &hull), blocked = false;
            for (int k = 0; k < 64; k++) {
                Vec3 from = vec3_lerp(hull.points[0], hull.points[1], random_next_unit(&r));
                blocked |= ray_is_blocked(&w, from, hull.points[2]);
            }
            open += !touched, shadows += blocked;
            if (blocked && !touched) fail_msg("scene %d, hull %d: a shadow is missed", scene, i);
        }
        world_end(&w);
    }
    printf("of %d pieces %d were open, %d in shadow\n", hulls, open, shadows);
    assert_true(shadows > hulls / 10 && open > (hulls - shadows) / 2);
}

static void what_casts_no_shadow_is_none(void **state) {
    (void)state;
    const LightHull hull = hull_to(vec3(0, 4, 0));
    for (int kind = 0; kind < 4; kind++) {
        World w;
        world_begin(&w);
        Object *ball = add_ball(&w, vec3(0, kind == 1 ? -2 : 2, 0), 0.5);
        if (kind == 2) ball->no_shadow = true;
        if (kind == 3) ball->texture = &w.clear;
        assert_int_equal(touch(&w, &hull), kind == 0);
    }
}

/* A ball that is clear but for a medium. */
static bool filled_ball_touches(bool same, bool patterned, double fine) {
    World w;
    Medium medium = {.absorption = {.red = 1, .green = 1, .blue = 1}, .density_count = patterned ? 1 : 0};
    const Interior interior = {.ior = 1, .media = {&medium, 1}};
    const ObjectRest rest = {.interior = &interior, .hollow = true};
    const Medium *own = &medium;
    LightHull hull = hull_to(vec3(0, 4, 0));
    world_begin(&w);
    Object *ball = add_ball(&w, vec3(0, 2, 0), 0.5);
    ball->texture = &w.clear, ball->rest = &rest;
    if (same) hull.media = &own, hull.media_count = 1;
    hull.fine = fine;
    return touch(&w, &hull);
}

static void media_block_unless_their_pattern_is_known(void **state) {
    (void)state;
    assert_true(filled_ball_touches(false, true, 0.1));
    assert_false(filled_ball_touches(true, true, 0.1));  /* the piece goes through it */
    assert_false(filled_ball_touches(false, false, 0.1)); /* even, and wider than what may be missed */
    assert_true(filled_ball_touches(false, false, 2));
}

/* A plane that the piece lies on has no shadow in it. */
static void planes_block_what_lies_on_both_sides(void **state) {
    (void)state;
    static const double heights[] = {-1, 0, 1, 5};
    for (int i = 0; i < 4; i++) {
        World w;
        world_begin(&w);
        Object *plane = world_add(&w, OBJECT_PLANE);
        plane->as.plane.normal = vec3(0, 1, 0), plane->as.plane.distance = heights[i];
        const LightHull hull = hull_to(vec3(0, 4, 0));
        assert_int_equal(touch(&w, &hull), heights[i] == 1);
    }
}

static void what_is_not_known_may_block(void **state) {
    (void)state;
    World w;
    world_begin(&w);
    add_ball(&w, vec3(0, -9, 0), 0.5);
    const Blockers *few = world_blockers(&w);
    LightHull line = hull_to(vec3(0, 4, 0)), nowhere = hull_to(vec3(0, NAN, 0)), endless = hull_to(vec3(0, VTS_INFINITY, 0)), open = hull_to(vec3(0, 4, 0));
    line.count = 2;
    assert_false(blockers_touch(few, &open));
    assert_true(blockers_touch(few, &line) && blockers_touch(few, &nowhere) && blockers_touch(few, &endless));
    world_end(&w);
    world_begin(&w);
    for (int i = 0; i < 257; i++) add_ball(&w, vec3(i, -9, 0), 0.3);
    assert_true(touch(&w, &open));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_shadow_is_missed), cmocka_unit_test(what_casts_no_shadow_is_none), cmocka_unit_test(media_block_unless_their_pattern_is_known),
        cmocka_unit_test(planes_block_what_lies_on_both_sides), cmocka_unit_test(what_is_not_known_may_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
