/* What may shade a picture: all between its pyramid and a lamp, and little else. */
#include "render/view_reach.h"

#include "base/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double FAR = 100;

static View view_of(void) {
    View view = {.width = 64, .height = 48};
    view.camera = (Camera){.kind = CAMERA_PERSPECTIVE, .location = {1, 2, 3}, .direction = {0, 0, 1}, .right = {0.1, 0, 0}, .up = {0, 0.075, 0}};
    view_prepare(&view, NULL);
    return view;
}

static Box3 box_about(Vec3 p, double half) { return (Box3){vec3_sub(p, vec3_splat(half)), vec3_add(p, vec3_splat(half))}; }

static void nothing_between_is_missed(void **state) {
    (void)state;
    const View view = view_of();
    static const Vec3 lamps[] = {{50, 80, 20}, {1, 2, 3}, {1, 2, 50}, {-1e9, 6e8, -3e8}, {1, 2, -40}, {1, 60, 3}};
    for (size_t l = 0; l < VTS_ARRAY_COUNT(lamps); l++) {
        const ViewReach reach = view_reach(&view, FAR, lamps[l]);
        for (uint64_t i = 0; i < 2000; i++) {
            uint64_t bits = random_hash(i, l, 0, 1);
            double s = random_unit(bits) - 0.5, t = random_unit(random_mix(bits)) - 0.5, depth = FAR * random_unit(random_mix(bits + 1));
            Vec3 seen = vec3_madd(view.camera.location, vec3_madd(vec3_madd(view.camera.direction, view.camera.right, s), view.camera.up, t), depth);
            Vec3 between = vec3_lerp(seen, lamps[l], random_unit(random_mix(bits + 2)));
            assert_false(view_reach_misses(&reach, box_about(between, 1e-3)));
        }
    }
}

static void what_is_beside_is_missed(void **state) {
    (void)state;
    const View view = view_of();
    const ViewReach reach = view_reach(&view, FAR, vec3(1e5, 1e5, 3));
    assert_true(view_reach_misses(&reach, box_about(vec3(-10, 2, 50), 1)));  /* on the other side of the picture than the lamp */
    assert_true(view_reach_misses(&reach, box_about(vec3(1, -10, 50), 1)));  /* below it */
    assert_true(view_reach_misses(&reach, box_about(vec3(1, 2, -5), 0.1))); /* behind the camera */
    assert_true(view_reach_misses(&reach, box_about(vec3(30, 2, 50), 1)));   /* under the way of the light */
    assert_false(view_reach_misses(&reach, box_about(vec3(31, 32, 50), 1))); /* in it */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_between_is_missed),
        cmocka_unit_test(what_is_beside_is_missed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
