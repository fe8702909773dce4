/* Phase functions against quadrature. */
#include "base/random.h"
#include "volume/phase.h"

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

/* Means of 1, P1, P2 over the sphere, by the midpoint rule. */
static void integrate(const Phase *phase, double to, double out[3]) {
    double h = (to + 1) / POINTS;
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < POINTS; i++) {
        double mu = -1 + (i + 0.5) * h, p = 2 * VTS_PI * h * phase_value(phase, mu);
        out[0] += p, out[1] += p * mu, out[2] += p * (1.5 * mu * mu - 0.5);
    }
}

static void is_normalised_and_has_its_moments(void **state) {
    (void)state;
    for (int k = 0; k < PHASES; k++) {
        double found[3], told[3];
        integrate(&phases[k], 1, found);
        phase_moments(&phases[k], told);
        for (int i = 0; i < 3; i++) assert_near(found[i], told[i], 1e-6);
    }
}

/* The share of draws below a cosine is the integral up to it. */
static void is_drawn_as_it_is(void **state) {
    (void)state;
    for (int k = 0; k < PHASES; k++)
        for (double to = -0.8; to < 1; to += 0.3) {
            double share[3];
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
            double moments[3];
            phase_moments(&sharp, moments);
            assert_true(fabs(moments[1]) <= 1 && moments[1] * sign > 0.9);
            for (int i = 0; i <= 10; i++) {
                double mu = phase_draw(&sharp, 0.5, (double)i / 10);
                assert_true(mu >= -1 && mu <= 1);
                assert_true(isfinite(phase_value(&sharp, mu)) && phase_value(&sharp, mu) >= 0);
            }
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_normalised_and_has_its_moments), cmocka_unit_test(is_drawn_as_it_is),
                                       cmocka_unit_test(turns_by_the_angle), cmocka_unit_test(is_finite_at_the_limits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
