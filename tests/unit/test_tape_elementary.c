/* Elementary functions: errors against long double, special values against C's, arrays against one at a time. */
#include "base/random.h"
#include "tape/elementary.h"
#include "tape/tape_rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { COUNT = 100000, ARRAY = 64 };

static bool same(double a, double b) {
    return (isnan(a) && isnan(b)) || elementary_bits(a) == elementary_bits(b);
}

/* The error in units of the last place of the double nearest to the truth. */
static double ulps(double got, long double truth) {
    if (isnan(truth) || isinf((double)truth) || truth == 0)
        return same(got, (double)truth) ? 0 : (double)INFINITY;
    int exponent;
    frexpl(truth, &exponent);
    return (double)(fabsl((long double)got - truth) / ldexpl(1, int_max(exponent, -1021) - 53));
}

/* ---- arguments ---- */

static double uniform(RandomStream *random, double most) { return most * (2 * random_next_unit(random) - 1); }

/* Of either sign and all magnitudes from 2^least to 2^most. */
static double any_size(RandomStream *random, double least, double most) {
    return uniform(random, exp2(least + (most - least) * random_next_unit(random)));
}

static double small_argument(RandomStream *random) { return uniform(random, 4); }
static double common_argument(RandomStream *random) { return uniform(random, 1000); }
static double any_argument(RandomStream *random) { return any_size(random, -1080, 1024); }
static double near_quarter_turns(RandomStream *random) {
    double turns = floor(uniform(random, 5500)), error = any_size(random, -60, -10);
    return turns * (VTS_PI / 2) * (1 + error);
}
static double near_one(RandomStream *random) { return 1 + any_size(random, -53, -1); }
static double positive(RandomStream *random) { return fabs(any_argument(random)); }

typedef double Argument(RandomStream *random);

/* ---- accuracy ---- */

typedef struct Case {
    const char *name;
    double (*ours)(double);
    long double (*truth)(long double);
    double bound; /* ulp */
    Argument *arguments[4];
} Case;

static const Case cases[] = {
    {"sin", elementary_sin, sinl, 0.87, {small_argument, common_argument, near_quarter_turns, any_argument}},
    {"cos", elementary_cos, cosl, 0.87, {small_argument, common_argument, near_quarter_turns, any_argument}},
    {"tan", elementary_tan, tanl, 0.97, {small_argument, common_argument, near_quarter_turns, any_argument}},
    {"exp", elementary_exp, expl, 0.93, {small_argument, common_argument, any_argument}},
    {"ln", elementary_ln, logl, 0.93, {near_one, positive}},
    {"atan", elementary_atan, atanl, 0.87, {small_argument, common_argument, any_argument}},
};

static void errors_are_below_one_unit(void **state) {
    (void)state;
    RandomStream random = {12};
    for (size_t c = 0; c < VTS_ARRAY_COUNT(cases); c++)
        for (int k = 0; k < 4 && cases[c].arguments[k]; k++)
            for (int i = 0; i < COUNT; i++) {
                double x = cases[c].arguments[k](&random);
                double error = ulps(cases[c].ours(x), cases[c].truth((long double)x));
                if (!(error < cases[c].bound)) fail_msg("%s(%a): %g ulp", cases[c].name, x, error);
            }
}

static void errors_of_angles_are_below_one_unit(void **state) {
    (void)state;
    RandomStream random = {13};
    Argument *const arguments[] = {small_argument, near_one, any_argument};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(arguments); k++)
        for (int i = 0; i < COUNT; i++) {
            double y = arguments[k](&random), x = arguments[k](&random);
            double error = ulps(elementary_atan2(y, x), atan2l((long double)y, (long double)x));
            if (!(error < 0.9)) fail_msg("atan2(%a, %a): %g ulp", y, x, error);
        }
}

/* The doubles nearest to multiples of a quarter turn, where nothing but the reduction's error is left: sin(pi as a double) is
 * pi's remaining digits. */
static void zeros_of_the_sine_are_exact(void **state) {
    (void)state;
    assert_true(elementary_sin(VTS_PI) == 0x1.1a62633145c07p-53);
    assert_true(elementary_cos(VTS_PI / 2) == 0x1.1a62633145c07p-54);
    assert_true(elementary_sin(2 * VTS_PI) == -0x1.1a62633145c07p-52);
    for (double n = 1; n < 300000; n += 97) {
        double x = n * VTS_PI;
        assert_true(ulps(elementary_sin(x), sinl((long double)x)) <= 0.51);
    }
}

/* ---- special values ---- */

static const double spicy[] = {0.0,
                               -0.0,
                               1,
                               -1,
                               0.5,
                               -2,
                               5e-324,
                               -5e-324,
                               DBL_MIN,
                               1e-310,
                               DBL_MAX,
                               0x1p52,
                               0x1p13,
                               -0x1p13,
                               0x1.2p1000,
                               0x1p-400,
                               0x1p401,
                               1e22,
                               746,
                               -746,
                               709.782712893384,
                               -745.13,
                               -745.133222,
                               1e300,
                               -1e300,
                               (double)INFINITY,
                               -(double)INFINITY,
                               (double)NAN};

static bool agrees(double a, double c) {
    return same(a, c) || (!isnan(a) && signbit(a) == signbit(c) && ulps(a, (long double)c) <= 1);
}

static void special_values_are_those_of_c(void **state) {
    (void)state;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(spicy); i++) {
        double x = spicy[i];
        assert_true(agrees(elementary_sin(x), sin(x)));
        assert_true(agrees(elementary_cos(x), cos(x)));
        assert_true(agrees(elementary_tan(x), tan(x)));
        assert_true(agrees(elementary_exp(x), exp(x)));
        assert_true(agrees(elementary_ln(x), log(x)));
        assert_true(agrees(elementary_atan(x), atan(x)));
        for (size_t k = 0; k < VTS_ARRAY_COUNT(spicy); k++)
            assert_true(agrees(elementary_atan2(x, spicy[k]), atan2(x, spicy[k])));
    }
    assert_true(elementary_exp(0) == 1 && elementary_ln(1) == 0 && elementary_cos(0) == 1);
}

/* ---- arrays ---- */

static double mixed_argument(RandomStream *random) {
    uint64_t kind = random_next(random) % 8;
    if (kind == 0) return spicy[random_next(random) % VTS_ARRAY_COUNT(spicy)];
    return kind == 1 ? any_argument(random) : common_argument(random);
}

typedef struct ArrayCase {
    TapeRow1 *row;
    double (*one)(double);
} ArrayCase;

static void arrays_give_the_same_bits(void **state) {
    (void)state;
    static const ArrayCase rows[] = {{row_SIN, elementary_sin}, {row_COS, elementary_cos},
                                     {row_TAN, elementary_tan}, {row_EXP, elementary_exp},
                                     {row_LN, elementary_ln},   {row_ATAN, elementary_atan}};
    RandomStream random = {14};
    double a[ARRAY], b[ARRAY], out[ARRAY];
    for (int i = 0; i < COUNT / ARRAY; i++) {
        size_t lanes = (size_t)(random_next(&random) % (ARRAY + 1));
        bool tame = i & 1; /* else every array has some unusual argument */
        for (size_t l = 0; l < lanes; l++) {
            a[l] = tame ? 0.01 + fabs(common_argument(&random)) : mixed_argument(&random);
            b[l] = tame ? small_argument(&random) : mixed_argument(&random);
        }
        for (size_t r = 0; r < VTS_ARRAY_COUNT(rows); r++) {
            rows[r].row(out, a, lanes);
            for (size_t l = 0; l < lanes; l++) assert_true(same(out[l], rows[r].one(a[l])));
        }
        row_ATAN2(out, a, b, lanes);
        for (size_t l = 0; l < lanes; l++) assert_true(same(out[l], elementary_atan2(a[l], b[l])));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_below_one_unit),   cmocka_unit_test(errors_of_angles_are_below_one_unit),
        cmocka_unit_test(zeros_of_the_sine_are_exact), cmocka_unit_test(special_values_are_those_of_c),
        cmocka_unit_test(arrays_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
