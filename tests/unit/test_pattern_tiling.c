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

/* Of the plane, what each kind of tile covers, by the areas of regular polygons. */
static void test_shares(void **state) {
    (void)state;
    const double triangle = sqrt(3) / 4, hexagon = 6 * triangle, octagon = 2 + sqrt(8),
                 dodecagon = 6 + sqrt(27);
    const struct {
        int tiling, kinds;
        double areas[6];
    } plain[] = {{5, 3, {1, 1, 1}},
                 {6, 2, {1, 1}},
                 {7, 2, {1, octagon}},
                 {8, 3, {triangle, triangle, 1}},
                 {9, 3, {triangle, triangle, hexagon}},
                 {11, 3, {1, 4, 4}},
                 {12, 3, {1, 4, 4}},
                 {13, 3, {2, 3, 3}},
                 {14, 5, {1.5, 1.5, 1.5, 1.5, 2}},
                 {15, 2, {1, 4}},
                 {16, 3, {3, 2 * triangle, hexagon}},
                 {17, 6, {1, 1, 1, triangle, triangle, hexagon}},
                 {18, 2, {1, 1}},
                 {19, 3, {4 * triangle, 4 * triangle, hexagon}},
                 {20, 3, {4 * triangle, 4 * triangle, hexagon}},
                 {21, 6, {triangle, triangle, triangle, triangle, 1, 1}},
                 {22, 3, {triangle, triangle, dodecagon}},
                 {23, 3, {2 * hexagon, 3, dodecagon}},
                 {24, 5, {2 * hexagon, 1, 1, 1, dodecagon}}};
    enum { PLACES = 60000 };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(plain); i++) {
        double sum = 0, found[6] = {0};
        for (int k = 0; k < plain[i].kinds; k++) sum += plain[i].areas[k];
        for (int n = 0; n < PLACES; n++) { /* a sequence that fills the square evenly */
            double value = at(plain[i].tiling, 300 * fmod(0.7548776662466927 * n, 1),
                              300 * fmod(0.5698402909980532 * n, 1));
            found[(int)fmin(value * plain[i].kinds, plain[i].kinds - 1)] += 1.0 / PLACES;
        }
        for (int k = 0; k < plain[i].kinds; k++) assert_near(found[k], plain[i].areas[k] / sum, 0.006);
    }
}

/* From a rim inwards a kind's number falls to its least, and both sides of a rim have their greatest. */
static void test_rims_of_dodecagons(void **state) {
    (void)state;
    const double middle = 1.5 + sqrt(3) / 2, apothem = 1 + sqrt(3) / 2,
                 high = 1 + sqrt(3); /* tiling 23: its dodecagon */
    assert_near(at(23, middle, high), 2.0 / 3, 1e-9);
    for (double depth = 0.01; depth < 0.5; depth += 0.01)
        assert_near(at(23, middle + apothem - depth, high), (3 - 2 * depth) / 3, 1e-9);
    assert_near(at(23, middle + apothem + 0.1, high), (2 - 0.2) / 3, 1e-9); /* the square beside it */
    assert_near(at(23, middle + apothem + 0.5, high), 1.0 / 3, 1e-9);
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_middles_and_rims), cmocka_unit_test(test_shares),
                                       cmocka_unit_test(test_rims_of_dodecagons),
                                       cmocka_unit_test(test_bad_places), cmocka_unit_test(test_parts_meet)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
