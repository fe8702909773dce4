/* Tilings against the geometry of their tiles, and shares of textures that meet in one part. */
#include "pattern/pattern.h"
#include "pattern/tiling.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void assert_near(double found, double expected, double tolerance) {
    if (!(fabs(found - expected) <= tolerance)) fail_msg("%.12g is not %.12g", found, expected);
}

static double at(int tiling, double x, double z) { return tiling_number(tiling, vec3(x, 0.3, z)); }

static void test_middles_and_rims(void **state) {
    (void)state;
    const double h = sqrt(3) / 2;
    for (int k = -3; k <= 3; k++) {
        assert_near(at(1, k + 0.5, 0.5 - k), 0, 1e-9);
        assert_near(at(1, k + 1e-9, 0.4), 1, 1e-7);
        assert_near(at(2, 0.5 + 1.5 * k, h * (1 + k)), 0, 1e-9);
        assert_near(at(2, 3 * k + 0.5, 0), 1, 1e-9);
        assert_near(at(3, k + 0.5, h / 3), 0, 1e-9);    /* up: the first kind */
        assert_near(at(3, k + 0.5, -h / 3), 0.5, 1e-9); /* down: the second */
        assert_near(at(3, k + 0.5, 1e-9), 0.5, 1e-7);   /* rims */
        assert_near(at(3, k + 0.5, -1e-9), 1, 1e-7);
    }
    assert_near(at(2, 0.5, 0.2), 1 - 0.2 / h, 1e-9);
}

static void test_bad_places(void **state) {
    (void)state;
    const double bad[] = {(double)NAN, (double)INFINITY, 1e300};
    for (int tiling = 0; tiling < 29; tiling++)
        for (size_t i = 0; i < VTS_ARRAY_COUNT(bad); i++) {
            double value = at(tiling, bad[i], -bad[i]);
            assert_true(value >= 0 && value <= 1);
        }
}

/* A footprint over several tiles asks many places; two textures remain two parts. */
static void test_parts_meet(void **state) {
    (void)state;
    Pigment pattern = pigment_default(), plain = pigment_default();
    Finish finish = finish_default();
    const ColorMapEntry entries[] = {{.position = 0}, {.position = 1}};
    Texture a = {.pigment = &plain, .finish = &finish, .transform = transform_identity()}, b = a;
    const Texture *both[] = {&a, &b};
    pattern.kind = PATTERN_TILING, pattern.number = 1;
    pattern.entries = entries, pattern.entry_count = 2;
    TextureMap map = {.pattern = &pattern, .textures = both, .count = 2, .depth = 1};
    Texture whole = a;
    whole.map = &map;
    SurfacePlace place = {.point = vec3(0.3, 0, 0.2), .normal = vec3(0, 1, 0), .footprint = 0.3};
    TexturePart parts[2];
    assert_int_equal(texture_parts(&whole, &place, parts, 2), 2);
    double second = parts[0].texture == &b ? parts[0].weight : parts[1].weight, mean = 0;
    for (int i = 0; i < 900; i++)
        mean += at(1, 0.15 + 0.01 * (i % 30) + 0.005, 0.05 + 0.01 * (i / 30) + 0.005) / 900;
    assert_near(parts[0].weight + parts[1].weight, 1, 1e-9);
    assert_near(second, mean, 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_middles_and_rims),
                                       cmocka_unit_test(test_bad_places), cmocka_unit_test(test_parts_meet)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
