/* Light on matter of skins: the balance of what a beam loses and what the matter on its way receives. */
#include "texel/light_share.h"

#include "base/vec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const float areas[] = {0.003f, 0.02f, 0.2f, 0.7f, 1, 2.5f, 8};

static float share_of(float depth, float area, float before, float sheet) {
    LightSurroundings around = {depth, area, before, sheet, 0};
    return light_share(&around);
}

static void matter_at_random_sees_what_comes_through(void **state) {
    (void)state;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(areas); i++)
        for (int k = 0; k <= 4; k++) {
            float before = areas[i] * (float)k / 4;
            assert_float_equal(share_of(areas[i], areas[i], before, 0), expf(-before), 0.004);
        }
}

/* Mean of the share over all matter on the way × its area = what the beam loses, unless that is more than its area can take. */
static void no_light_is_lost(void **state) {
    (void)state;
    enum { PARTS = 2000 };
    static const float ratios[] = {0.1f, 0.5f, 0.9f, 1};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(areas); i++)
        for (size_t r = 0; r < VTS_ARRAY_COUNT(ratios); r++) {
            float area = areas[i], depth = area * ratios[r];
            double received = 0;
            bool whole = false; /* some matter is lit in full: more cannot be */
            for (int k = 0; k < PARTS; k++) {
                float share = share_of(depth, area, area * ((float)k + 0.5f) / (float)PARTS, 0);
                assert_true(share >= 0 && share <= 1);
                whole |= share == 1;
                received += (double)share;
            }
            received *= (double)area / PARTS;
            double lost = 1 - exp(-(double)depth);
            if (whole) assert_true(received <= lost * 1.005);
            else assert_true(fabs(received - lost) <= 0.006 * lost);
        }
}

static void a_sheet_is_lit_all_over(void **state) {
    (void)state;
    static const float sheets[] = {0.1f, 0.5f, 0.9f, 0.99f}; /* areas of one sheet, which hides as much as that */
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sheets); i++)
        for (int k = 0; k <= 4; k++)
            assert_float_equal(share_of(sheets[i], sheets[i], sheets[i] * (float)k / 4, 1), 1, 1e-4); /* blurred: it hides less than it should */
    assert_float_equal(share_of(50, 1, 0.5f, 1), 1, 1e-4);
    assert_float_equal(share_of(50, 6, 2, 1), 1, 1e-4); /* the wall of a solid, whose inside is behind it */
}

/* A clump that hides itself is a body: its side to the eye is lit as far as the light falls on it, and less by what is before it. */
static void clumps_show_the_side_that_faces_the_eye(void **state) {
    (void)state;
    for (int k = 0; k <= 4; k++) {
        float facing = (float)k / 4;
        LightSurroundings dense = {0.4f, 40, 0, 0, facing}, behind = {0.4f, 40, 40, 0, facing}, random = {3, 3, 1, 0, facing};
        assert_float_equal(light_share(&dense), facing, 0.012);
        assert_float_equal(light_share(&behind), expf(-0.4f) * facing, 0.012);
        assert_float_equal(light_share(&random), expf(-1.0f), 1e-4); /* what is no clump is lit from all sides */
    }
    assert_true(light_facing(1) == 1 && light_facing(-1) == 0 && light_facing(0) == 0.5f && light_facing(NAN) == 0);
}

static void nothing_bad_comes_of_odd_numbers(void **state) {
    (void)state;
    static const float odd[] = {0, 1e-30f, 1e-6f, 1, 1e6f, INFINITY};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(odd); i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(odd); k++) {
            for (int sheet = 0; sheet <= 2; sheet++) {
                float share = share_of(odd[i], odd[k], odd[k] / 2, (float)sheet / 2);
                assert_true(share >= 0 && share <= 1);
            }
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matter_at_random_sees_what_comes_through),
        cmocka_unit_test(no_light_is_lost),
        cmocka_unit_test(a_sheet_is_lit_all_over),
        cmocka_unit_test(clumps_show_the_side_that_faces_the_eye),
        cmocka_unit_test(nothing_bad_comes_of_odd_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
