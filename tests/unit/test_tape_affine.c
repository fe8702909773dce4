/* Reduced affine forms hold what they must, at every place s of their line: each operation against long double and against the
 * scalar operation. What is tested is containment, not pictures: those hide errors (Gamito & Maddock's equation 13 as printed
 * loses 3 products in 10). */
#include "tape/tape_affine.h"

#include "bounds_sample.h"
#include "tape/noise.h"
#include "tape/tape_program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static AffineForm some_form(uint64_t i, uint32_t k) {
    static const double scales[] = {1, 1, 1e-3, 1e-6, 1e3, 1e6, 0.1, 1e-12};
    double size = scales[bits(i, k) % 8];
    AffineForm a = {some_number(i, k + 1), size * (2 * unit(i, k + 4) - 1), size * unit(i, k + 5) * (double)(bits(i, k + 6) % 3), false};
    if (!isfinite(a.centre)) a.centre = 2;
    /* long double has 11 bits more than double: less is not to be seen beside the centre. */
    if (bits(i, k + 7) % 5 == 0 || fabs(a.slope) < 0x1p-40 * fabs(a.centre)) a.slope = 0;
    if (bits(i, k + 7) % 25 == 0 || a.error < 0x1p-40 * fabs(a.centre)) a.error = 0;
    return a;
}

/* A value of the form at s. */
static long double form_value(AffineForm a, long double s, long double e) { return (long double)a.centre + (long double)a.slope * s + (long double)a.error * e; }

static bool form_holds(AffineForm a, long double s, long double value, long double slack) {
    if (isnan(value)) return a.nan;
    if (!(a.error < HUGE_VAL)) return true;
    long double off = fabsl(value - ((long double)a.centre + (long double)a.slope * s));
    return off <= (long double)a.error * (1 + 0x1p-60L) + slack;
}

static long double exact(TapeOp op, const long double x[3]) {
    switch (op) {
    case TAPE_ADD: return x[0] + x[1];
    case TAPE_SUB: return x[0] - x[1];
    case TAPE_MUL: return x[0] * x[1];
    case TAPE_DIV: return x[0] / x[1];
    case TAPE_NEG: return -x[0];
    case TAPE_SQR: return x[0] * x[0];
    case TAPE_ABS: return fabsl(x[0]);
    case TAPE_MIN: return x[0] < x[1] ? x[0] : x[1];
    case TAPE_MAX: return x[0] > x[1] ? x[0] : x[1];
    case TAPE_SELECT: return x[0] < 0 ? x[1] : x[2];
    case TAPE_SQRT: return sqrtl(x[0]);
    case TAPE_EXP: return expl(x[0]);
    case TAPE_LN: return logl(x[0]);
    case TAPE_LOG: return log10l(x[0]);
    case TAPE_POW: return powl(x[0], x[1]);
    case TAPE_SIN: return sinl(x[0]);
    case TAPE_COS: return cosl(x[0]);
    case TAPE_TAN: return tanl(x[0]);
    case TAPE_ASIN: return asinl(x[0]);
    case TAPE_ACOS: return acosl(x[0]);
    case TAPE_ATAN: return atanl(x[0]);
    case TAPE_ATAN2: return atan2l(x[0], x[1]);
    case TAPE_SINH: return sinhl(x[0]);
    case TAPE_COSH: return coshl(x[0]);
    case TAPE_TANH: return tanhl(x[0]);
    case TAPE_ASINH: return asinhl(x[0]);
    case TAPE_ACOSH: return acoshl(x[0]);
    case TAPE_ATANH: return atanhl(x[0]);
    default: return (long double)tape_apply(op, (double)x[0], (double)x[1], (double)x[2]);
    }
}

static bool exact_is_known(TapeOp op) { return op <= TAPE_MAX || op == TAPE_SELECT || (op >= TAPE_SQRT && op <= TAPE_ATANH); }

/* What long double's own roundings, of operands and result, may do. */
static long double rounding(TapeOp op, const long double x[3]) {
    long double at = exact(op, x), sum = 0x1p-61L * fabsl(at);
    for (int k = 0; k < 3; k++) {
        long double moved[3] = {x[0], x[1], x[2]};
        moved[k] += 0x1p-61L * fabsl(x[k]);
        sum += fabsl(exact(op, moved) - at);
    }
    return isnan(sum) ? 0 : sum;
}

static void every_operation_holds_its_values(void **state) {
    (void)state;
    int failures = 0;
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++) {
        TapeOp op = operations[o].op;
        for (uint64_t i = 0, count = span_count(20000); i < count; i++) {
            uint64_t n = i * 1000 + o;
            AffineForm in[3] = {some_form(n, 0), some_form(n, 10), some_form(n, 20)};
            AffineForm out = tape_apply_affine(op, in[0], in[1], in[2]);
            for (uint32_t t = 0; t < 4; t++) {
                double s = t == 0 ? -1 : t == 1 ? 1 : 2 * unit(n, 30 + t) - 1;
                long double x[3];
                double d[3];
                bool inside = true;
                for (uint32_t k = 0; k < 3; k++) {
                    long double e = t == 0 ? -1 : t == 1 ? 1 : 2 * (long double)unit(n, 40 + 4 * t + k) - 1;
                    x[k] = form_value(in[k], (long double)s, e);
                    d[k] = (double)x[k];
                    inside &= form_holds(in[k], (long double)s, (long double)d[k], 0);
                }
                bool right = !exact_is_known(op) || form_holds(out, (long double)s, exact(op, x), rounding(op, x));
                double value = tape_apply(op, d[0], d[1], d[2]);
                if (inside) right &= form_holds(out, (long double)s, (long double)value, 0);
                if (right || ++failures > 20) continue;
                print_error("%s(%.20Lg, %.20Lg, %.20Lg) = %.20Lg or %.17g is not %.17g + %.17g * %.6g +- %.3g%s\n", operations[o].name, x[0], x[1], x[2],
                            exact_is_known(op) ? exact(op, x) : 0, value, out.centre, out.slope, s, out.error, out.nan ? " or nan" : "");
            }
        }
    }
    assert_int_equal(failures, 0);
}

/* Gradients against central differences, at places of any size and on the lattice itself. */
static void noises_have_their_gradients(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        double size = i % 3 ? 20 : 3000, p[3], gradient[3], h = 0x1p-18;
        for (uint32_t k = 0; k < 3; k++) p[k] = i % 7 == k ? floor(size * unit(i, k)) : size * (unit(i, k) - 0.5);
        double value = noise_perlin_gradient(vec3(p[0], p[1], p[2]), gradient);
        assert_true(fabs(value - noise_perlin(vec3(p[0], p[1], p[2]))) < 1e-14);
        for (int k = 0; k < 3; k++) {
            double far[3] = {p[0], p[1], p[2]}, near[3] = {p[0], p[1], p[2]};
            far[k] += h, near[k] -= h;
            double slope = (noise_perlin(vec3(far[0], far[1], far[2])) - noise_perlin(vec3(near[0], near[1], near[2]))) / (2 * h);
            assert_true(fabs(slope - gradient[k]) < 1e-7);
        }
        value = noise_pov_gradient3(vec3(p[0], p[1], p[2]), gradient);
        assert_true(fabs(double_clamp(value, 0, 1) - noise_pov(vec3(p[0], p[1], p[2]))) < 1e-14);
        if (i % 7 < 3) continue; /* its curvature jumps at the cells' walls */
        for (int k = 0; k < 3; k++) {
            double far[3] = {p[0], p[1], p[2]}, near[3] = {p[0], p[1], p[2]}, unused[3];
            far[k] += h, near[k] -= h;
            double slope = (noise_pov_gradient3(vec3(far[0], far[1], far[2]), unused) - noise_pov_gradient3(vec3(near[0], near[1], near[2]), unused)) / (2 * h);
            assert_true(fabs(slope - gradient[k]) < 2e-5);
        }
    }
}

static void arena_of(Arena *arena) { arena_init(arena, NULL, 0); }

/* y − Σ 2⁻ᵏ·perlin(2ᵏ·p) */
static const Tape *rough_ground(Arena *arena, int octaves) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef p[3] = {tape_input(b, 0), tape_input(b, 1), tape_input(b, 2)};
    TapeRef sum = tape_fbm(b, p, tape_constant(b, octaves), tape_constant(b, 2), tape_constant(b, 0.5), (Span){0});
    TapeRef f = tape_binary(b, TAPE_SUB, p[1], sum, (Span){0});
    return tape_finish(b, &f, 1);
}

static void tapes_along_lines(void **state) {
    (void)state;
    Arena arena;
    arena_of(&arena);
    const Tape *tape = rough_ground(&arena, 4);
    AffineForm *scratch = arena_new_array(&arena, AffineForm, tape_scratch_size(tape));
    for (uint64_t i = 0; i < 20000; i++) {
        double h = ldexp(1, -(int)(i % 24)), at[3], way[3], value;
        AffineForm in[3], out;
        for (uint32_t k = 0; k < 3; k++) {
            at[k] = 20 * (unit(i, k) - 0.5), way[k] = h * (unit(i, k + 3) - 0.5);
            in[k] = (AffineForm){at[k], way[k], 0x1p-52 * (fabs(at[k]) + h), false};
        }
        tape_eval_affine(tape, in, &out, scratch);
        for (int s = -4; s <= 4; s++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = at[k] + way[k] * (s / 4.0);
            tape_eval_once(tape, p, &value);
            assert_true(form_holds(out, s / 4.0L, (long double)value, 0));
        }
    }
    arena_destroy(&arena);
}

/* Errors shrink with the square of the piece, those of intervals with the piece. */
static void errors_are_of_second_order(void **state) {
    (void)state;
    Arena arena;
    arena_of(&arena);
    const Tape *tape = rough_ground(&arena, 4);
    AffineForm *scratch = arena_new_array(&arena, AffineForm, tape_scratch_size(tape));
    for (uint64_t i = 0; i < 2000; i++) {
        double error[2];
        for (int n = 0; n < 2; n++) {
            double h = n ? 0x1p-10 : 0x1p-8;
            AffineForm in[3], out;
            for (uint32_t k = 0; k < 3; k++) in[k] = (AffineForm){20 * (unit(i, k) - 0.5), h * (unit(i, k + 3) - 0.5), 0, false};
            tape_eval_affine(tape, in, &out, scratch);
            error[n] = out.error;
        }
        assert_true(error[1] < error[0] / 15.9);
    }
    arena_destroy(&arena);
}

/* What an operation knows about constants it is told: a remainder by one has its dividend's slope between two jumps. */
static void constants_are_points(void **state) {
    (void)state;
    Interval range = affine_range(affine_point(0.75));
    assert_true(range.low == 0.75 && range.high == 0.75);
    AffineForm between = affine_MOD((AffineForm){10.1, 0.1, 0, false}, affine_point(0.75));
    assert_true(between.slope == 0.1 && between.error < 1e-12 && fabs(between.centre - 0.35) < 1e-12);
    AffineForm over = affine_MOD((AffineForm){10.1, 0.5, 0, false}, affine_point(0.75));
    assert_true(affine_range(over).low <= 0 && affine_range(over).high >= 0.749);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_operation_holds_its_values),
        cmocka_unit_test(noises_have_their_gradients),
        cmocka_unit_test(tapes_along_lines),
        cmocka_unit_test(errors_are_of_second_order),
        cmocka_unit_test(constants_are_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
