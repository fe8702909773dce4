/* Phase functions against quadrature. */
#include "base/random.h"
#include "volume/phase_spread.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

static void assert_near(double found, double wanted, double tolerance) {
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.12g, not %.12g", found, wanted);
}

static const Phase phases[] = {
    {{{PHASE_ISOTROPIC, 0, 1}}, 1},
    {{{PHASE_RAYLEIGH, 0, 1}}, 1},
    {{{PHASE_ISOTROPIC, 0, 0.5}, {PHASE_POWER, 8, 0.5}}, 2},
    {{{PHASE_ISOTROPIC, 0, 0.5}, {PHASE_POWER, 32, 0.5}}, 2},
    {{{PHASE_HENYEY_GREENSTEIN, 0.85, 1}}, 1},
    {{{PHASE_HENYEY_GREENSTEIN, -0.6, 1}}, 1},
    {{{PHASE_HENYEY_GREENSTEIN, 1e-5, 1}}, 1},
    {{{PHASE_SCHLICK, 0.9, 1}}, 1},
    {{{PHASE_SCHLICK, 0.01, 1}}, 1},
    {{{PHASE_SCHLICK, -0.5, 0.12}, {PHASE_SCHLICK, 0.7, 0.88}}, 2},
};
enum { PHASES = sizeof phases / sizeof phases[0], POINTS = 200000 };

/* Means of 1, P1, P2, P3 over the sphere, by the midpoint rule. */
static void integrate(const Phase *phase, double to, double out[PHASE_MOMENTS]) {
    double h = (to + 1) / POINTS;
    out[0] = out[1] = out[2] = out[3] = 0;
    for (int i = 0; i < POINTS; i++) {
        double mu = -1 + (i + 0.5) * h, p = 2 * VTS_PI * h * phase_value(phase, mu);
        out[0] += p, out[1] += p * mu, out[2] += p * (1.5 * mu * mu - 0.5), out[3] += p * (2.5 * mu * mu - 1.5) * mu;
    }
}

static void is_normalised_and_has_its_moments(void **state) {
    (void)state;
    for (int k = 0; k < PHASES; k++) {
        double found[PHASE_MOMENTS], told[PHASE_MOMENTS];
        integrate(&phases[k], 1, found);
        phase_moments(&phases[k], told);
        for (int i = 0; i < PHASE_MOMENTS; i++) assert_near(found[i], told[i], 1e-6);
    }
}

/* The share of draws below a cosine is the integral up to it. */
static void is_drawn_as_it_is(void **state) {
    (void)state;
    for (int k = 0; k < PHASES; k++)
        for (double to = -0.8; to < 1; to += 0.3) {
            double share[PHASE_MOMENTS];
            int below = 0, all = 0;
            integrate(&phases[k], to, share);
            for (int i = 0; i < 100; i++)
                for (int j = 0; j < 400; j++, all++) below += phase_draw(&phases[k], (i + 0.5) / 100, (j + 0.5) / 400) < to;
            assert_near((double)below / all, share[0], 0.004);
        }
}

static void turns_by_the_angle(void **state) {
    (void)state;
    RandomStream random = {1};
    for (int i = 0; i < 1000; i++) {
        double z = 2 * random_next_unit(&random) - 1, a = 7 * random_next_unit(&random), mu = 2 * random_next_unit(&random) - 1;
        Vec3 d = vec3(sqrt(1 - z * z) * cos(a), sqrt(1 - z * z) * sin(a), z), e = phase_turn(d, mu, random_next_unit(&random));
        assert_near(vec3_length(e), 1, 1e-12);
        assert_near(vec3_dot(d, e), mu, 1e-12);
    }
}

/* Lobes as sharp as doubles allow stay numbers. */
static void is_finite_at_the_limits(void **state) {
    (void)state;
    for (int kind = PHASE_HENYEY_GREENSTEIN; kind <= PHASE_SCHLICK; kind++)
        for (int sign = -1; sign <= 1; sign += 2) {
            Phase sharp = {{{(PhaseKind)kind, sign * (1 - 1e-9), 1}}, 1};
            double moments[PHASE_MOMENTS];
            phase_moments(&sharp, moments);
            assert_true(fabs(moments[1]) <= 1 && moments[1] * sign > 0.9);
            for (int i = 0; i <= 10; i++) {
                double mu = phase_draw(&sharp, 0.5, (double)i / 10);
                assert_true(mu >= -1 && mu <= 1);
                assert_true(isfinite(phase_value(&sharp, mu)) && phase_value(&sharp, mu) >= 0);
            }
        }
}

/* Peak and rest together turn light as far on the mean as the whole does, in degrees 1 and 2. */
static void peaks_are_taken_off(void **state) {
    (void)state;
    int peaked = 0;
    for (int k = 0; k < PHASES; k++) {
        Phase rest;
        double peak = phase_without_peak(&phases[k], &rest), whole[PHASE_MOMENTS], left[PHASE_MOMENTS];
        phase_moments(&phases[k], whole);
        phase_moments(&rest, left);
        assert_true(peak >= 0 && peak < 1);
        for (int l = 1; l < 3; l++) assert_near(peak + (1 - peak) * left[l], whole[l], 1e-9);
        for (double mu = -1; mu <= 1; mu += 0.01) assert_true(phase_value(&rest, mu) >= 0);
        peaked += peak > 0;
    }
    assert_int_equal(peaked, 5); /* hazy, murky, forward ones; not what is even, nor what goes back */
}

/* All light that comes is scattered into some angle: what the peak turns again after that is lost to it, exp(-after) is not. */
static void spread_keeps_light(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (int k = 0; k < PHASES; k++) {
        Phase rest;
        double peak = phase_without_peak(&phases[k], &rest);
        const PhaseSpread *spread = phase_spread_make(&phases[k], &rest, peak, &arena);
        assert_int_equal(spread != NULL, peak > 0);
        for (double mu = -1; mu <= 1; mu += 0.1) assert_near(phase_spread(spread, mu, 0, 0), 1, 1e-5);
        for (double before = 0; before < 10 && spread; before += 2.3)
            for (double after = 0; after < 3; after += 1.4) {
                double sum = 0;
                for (int i = 0; i < POINTS / 10; i++) {
                    double s = (i + 0.5) / (POINTS / 10), mu = 1 - 2 * s * s; /* finer forwards */
                    sum += 2 * VTS_PI * 4 * s / (POINTS / 10) * phase_value(&phases[k], mu) * phase_spread(spread, mu, before, after);
                }
                if (fabs(sum - (1 - peak + peak * exp(-after))) > 0.02) fail_msg("phase %d, before %g after %g: %g, not %g", k, before, after, sum, 1 - peak + peak * exp(-after));
            }
    }
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_normalised_and_has_its_moments), cmocka_unit_test(is_drawn_as_it_is),
                                       cmocka_unit_test(turns_by_the_angle), cmocka_unit_test(is_finite_at_the_limits),
                                       cmocka_unit_test(peaks_are_taken_off), cmocka_unit_test(spread_keeps_light)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
