/* Noises made of scattered points. */
#include "tape/noise.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static Vec3 somewhere(RandomStream *random, double size) {
    double x = random_next_unit(random), y = random_next_unit(random), z = random_next_unit(random);
    return vec3(size * (2 * x - 1), size * (2 * y - 1), size * (2 * z - 1));
}

/* Distances grow with their number, and change no faster than the place does. */
static void worley_is_a_distance(void **state) {
    (void)state;
    RandomStream random = {1};
    for (int n = 0; n < 2000; n++) {
        Vec3 p = somewhere(&random, 50), q = vec3_add(p, somewhere(&random, 0.3));
        double apart = vec3_length(vec3_sub(p, q)), before = 0;
        for (int k = 0; k < WORLEY_NODES; k++) {
            double a = noise_worley(p, k), b = noise_worley(q, k);
            assert_true(a >= before);
            assert_true(fabs(a - b) <= apart * (1 + 1e-12));
            before = a;
        }
    }
}

/* Of a Poisson process of three nodes a unit the mean distance to the nearest is Γ(4/3)·(4π)^(-1/3) = 0.384; that no cell is
 * empty makes it a little less. */
static void worley_has_its_density(void **state) {
    (void)state;
    RandomStream random = {2};
    double sum = 0;
    enum { COUNT = 20000 };
    for (int n = 0; n < COUNT; n++) sum += noise_worley(somewhere(&random, 1000), 0);
    assert_true(fabs(sum / COUNT - 0.375) < 0.01);
}

static void convolution_is_centred_whatever_the_count(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    for (int count = 1; count <= 27; count *= 3) {
        RandomStream random = {3};
        double sum = 0, squares = 0;
        for (int n = 0; n < COUNT; n++) {
            double value = noise_sparse_convolution(somewhere(&random, 1000), count);
            sum += value, squares += value * value;
        }
        /* Var = E[w²] · ∫ kernel² dV = 1/3 · 4π · ∫ r²(1 + cos πr)²/4 dr over [0, 1] */
        double integral = 0;
        for (int k = 0; k < 10000; k++) {
            double r = (k + 0.5) / 10000, h = (1 + cos(VTS_PI * r)) / 2;
            integral += r * r * h * h / 10000;
        }
        assert_true(fabs(sum / COUNT) < 0.02);
        assert_true(fabs(squares / COUNT / (4 * VTS_PI / 3 * integral) - 1) < 0.05);
    }
}

static void convolution_is_smooth(void **state) {
    (void)state;
    RandomStream random = {4};
    for (int n = 0; n < 2000; n++) {
        Vec3 p = somewhere(&random, 20), q = vec3_add(p, somewhere(&random, 1e-6));
        assert_true(fabs(noise_sparse_convolution(p, 5) - noise_sparse_convolution(q, 5)) < 1e-4);
    }
}

static void far_and_absurd_places_are_harmless(void **state) {
    (void)state;
    assert_true(isnan(noise_worley(vec3((double)NAN, 0, 0), 0)));
    assert_true(isnan(noise_sparse_convolution(vec3(0, VTS_INFINITY, 0), 3)));
    assert_true(isfinite(noise_worley(vec3(1e300, -1e18, 4.5e15), 7)));
    assert_true(isfinite(noise_sparse_convolution(vec3(1e300, -1e18, 4.5e15), 3)));
    assert_true(noise_worley(vec3(1, 2, 3), -5) == noise_worley(vec3(1, 2, 3), 0));
    assert_true(noise_worley(vec3(1, 2, 3), 500) == noise_worley(vec3(1, 2, 3), WORLEY_NODES - 1));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(worley_is_a_distance),
                                       cmocka_unit_test(worley_has_its_density),
                                       cmocka_unit_test(convolution_is_centred_whatever_the_count),
                                       cmocka_unit_test(convolution_is_smooth),
                                       cmocka_unit_test(far_and_absurd_places_are_harmless)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
