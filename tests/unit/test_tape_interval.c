/* Intervals hold what they must: every operation over random spans, the nasty ones among them, against the scalar operation at
 * places in them, and against long double where C has the function. */
#include "tape/noise.h"
#include "tape/tape_program.h"
#include "bounds_sample.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static void every_operation_holds_its_values(void **state) {
    (void)state;
    int failures = 0;
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++) {
        for (uint64_t i = 0, count = span_count(20000); i < count; i++) {
            uint64_t n = i * 1000 + o;
            Interval in[3] = {some_interval(n, 0), some_interval(n, 10), some_interval(n, 20)};
            Interval out = tape_apply_interval(operations[o].op, in[0], in[1], in[2]);
            for (uint32_t s = 0; s < 4; s++) {
                double x[3];
                for (uint32_t k = 0; k < 3; k++) x[k] = some_place(in[k], n, 30 + 6 * (3 * s + k));
                double value = tape_apply(operations[o].op, x[0], x[1], x[2]);
                if (interval_holds(out, value) || ++failures > 20) continue;
                print_error("%s(%.17g, %.17g, %.17g) = %.17g is not in [%.17g, %.17g]%s\n", operations[o].name, x[0], x[1], x[2], value, out.low, out.high,
                            out.nan ? " or nan" : "");
            }
        }
    }
    assert_int_equal(failures, 0);
}

/* Where an operand is no number at some places, the value there is held too. */
static void places_without_a_number_are_held(void **state) {
    (void)state;
    int failures = 0;
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++) {
        for (uint64_t i = 0, count = span_count(4000); i < count; i++) {
            uint64_t n = i * 1000 + o;
            Interval in[3];
            double x[3];
            for (uint32_t k = 0; k < 3; k++) {
                in[k] = some_interval(n, 10 * k);
                if (bits(n, 90 + k) % 3 == 0) in[k].nan = true;
                if (bits(n, 90 + k) % 9 == 1) in[k] = interval_never();
                x[k] = in[k].nan && (bits(n, 95 + k) % 2 || interval_is_never(in[k])) ? (double)NAN : some_place(in[k], n, 40 + 6 * k);
            }
            Interval out = tape_apply_interval(operations[o].op, in[0], in[1], in[2]);
            double value = tape_apply(operations[o].op, x[0], x[1], x[2]);
            if (interval_holds(out, value) || ++failures > 20) continue;
            print_error("%s(%.17g, %.17g, %.17g) = %.17g is not in [%.17g, %.17g]%s\n", operations[o].name, x[0], x[1], x[2], value, out.low, out.high,
                        out.nan ? " or nan" : "");
        }
    }
    assert_int_equal(failures, 0);
}

/* The exact value, to long double's 64 bits, is held too. */
static void exact_values_are_held(void **state) {
    (void)state;
    typedef long double Exact(long double);
    static const struct {
        TapeOp op;
        Exact *exact;
    } functions[] = {{TAPE_SQRT, sqrtl}, {TAPE_EXP, expl}, {TAPE_LN, logl}, {TAPE_LOG, log10l}, {TAPE_SIN, sinl}, {TAPE_COS, cosl},
                     {TAPE_TAN, tanl}, {TAPE_ASIN, asinl}, {TAPE_ACOS, acosl}, {TAPE_ATAN, atanl}, {TAPE_SINH, sinhl}, {TAPE_COSH, coshl},
                     {TAPE_TANH, tanhl}, {TAPE_ASINH, asinhl}, {TAPE_ACOSH, acoshl}, {TAPE_ATANH, atanhl}};
    for (size_t f = 0; f < VTS_ARRAY_COUNT(functions); f++)
        for (uint64_t i = 0, count = span_count(20000); i < count; i++) {
            Interval a = some_interval(i, 0), out = tape_apply_interval(functions[f].op, a, a, a);
            double x = some_place(a, i, 50);
            long double exact = functions[f].exact((long double)x);
            assert_true(isnan(exact) ? out.nan : (long double)out.low <= exact && exact <= (long double)out.high);
        }
    for (uint64_t i = 0, count = span_count(200000); i < count; i++) {
        Interval a = some_interval(i, 0), b = some_interval(i, 10);
        long double x = (long double)some_place(a, i, 50), y = (long double)some_place(b, i, 60);
        const long double exact[4] = {x + y, x - y, x * y, x / y};
        const TapeOp ops[4] = {TAPE_ADD, TAPE_SUB, TAPE_MUL, TAPE_DIV};
        for (int k = 0; k < 4; k++) {
            Interval out = tape_apply_interval(ops[k], a, b, b);
            assert_true(isnan(exact[k]) ? out.nan : (long double)out.low <= exact[k] && exact[k] <= (long double)out.high);
        }
    }
}

/* Bounds are of use: points stay points but for rounding, and Perlin's noise over a small box is narrow. */
static void bounds_are_narrow(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        double x = 100 * (unit(i, 0) - 0.5), y = 100 * (unit(i, 1) - 0.5), z = 100 * (unit(i, 2) - 0.5), h = ldexp(1, -(int)(i % 20));
        Interval n = interval_PERLIN(interval(x, x + h), interval(y, y + h), interval(z, z + h));
        assert_true(n.high - n.low <= 9 * h + 1e-12);
        n = interval_POV_NOISE(interval(x, x + h), interval(y, y + h), interval(z, z + h));
        assert_true(n.high - n.low <= 9 * h + 1e-12);
        Interval s = interval_SIN(interval(x, x + h));
        assert_true(s.high - s.low <= h + 1e-14);
        Interval p = interval_MUL(interval_point(x), interval_point(y));
        assert_true(p.high - p.low <= 1e-12 * fabs(x * y) + 1e-300);
    }
}

static double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/* The most that eight corners can give at a place: the gradients are the twelve (±1, ±1, 0) and their like. */
static double most_at(double x, double y, double z) {
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        double d[3] = {fabs(x - (c & 1)), fabs(y - (c >> 1 & 1)), fabs(z - (c >> 2))};
        double weight = (c & 1 ? fade(x) : 1 - fade(x)) * (c & 2 ? fade(y) : 1 - fade(y)) * (c & 4 ? fade(z) : 1 - fade(z));
        sum += weight * (d[0] + d[1] + d[2] - fmin(d[0], fmin(d[1], d[2])));
    }
    return sum;
}

static void the_bound_of_perlin_noise_is_one(void **state) {
    (void)state;
    double most = 0;
    enum { N = 128 };
    for (int i = 0; i <= N; i++)
        for (int j = 0; j <= i; j++)
            for (int k = 0; k <= j; k++) most = fmax(most, most_at((double)i / N / 2, (double)j / N / 2, (double)k / N / 2));
    Interval whole = interval_PERLIN(interval(-1e6, 1e6), interval(0, 1), interval(0, 1));
    assert_true(whole.high >= most && whole.high <= most + 1e-3);
    assert_true(whole.low == -whole.high);
}

static void tapes_over_boxes(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef p[3] = {tape_input(b, 0), tape_input(b, 1), tape_input(b, 2)};
    TapeRef rough = tape_fbm(b, p, tape_constant(b, 5), tape_constant(b, 2), tape_constant(b, 0.5), (Span){0});
    TapeRef f = tape_binary(b, TAPE_SUB, p[1], tape_binary(b, TAPE_MUL, tape_constant(b, 0.3), rough, (Span){0}), (Span){0});
    const Tape *tape = tape_finish(b, &f, 1);
    assert_true(tape_is_bounded(tape));
    Interval *scratch = arena_new_array(&arena, Interval, tape_scratch_size(tape));
    for (uint64_t i = 0; i < 5000; i++) {
        Interval in[3], out;
        double at[3], value;
        for (uint32_t k = 0; k < 3; k++) in[k] = interval(10 * unit(i, k), 0), in[k].high = in[k].low + unit(i, k + 3) * ldexp(1, -(int)(i % 12));
        tape_eval_interval(tape, in, &out, scratch);
        for (uint32_t s = 0; s < 20; s++) {
            for (uint32_t k = 0; k < 3; k++) at[k] = in[k].low + unit(i, 10 + 3 * s + k) * (in[k].high - in[k].low);
            tape_eval_once(tape, at, &value);
            assert_true(interval_holds(out, value));
        }
    }
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_operation_holds_its_values), cmocka_unit_test(places_without_a_number_are_held),
        cmocka_unit_test(exact_values_are_held),            cmocka_unit_test(bounds_are_narrow),
        cmocka_unit_test(the_bound_of_perlin_noise_is_one), cmocka_unit_test(tapes_over_boxes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
