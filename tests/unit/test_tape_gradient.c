/* Gradients by dual numbers: every operation and noise against differences in long double or wide steps of what they are. */
#include "tape/tape_gradient.h"

#include "bounds_sample.h"
#include "tape/noise.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static const Tape *tape_of(Arena *arena, TapeOp op, int arity) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef a = tape_input(b, 0), c = tape_input(b, 1), d = tape_input(b, 2);
    TapeRef out = arity == 1 ? tape_unary(b, op, a, (Span){0}) : arity == 2 ? tape_binary(b, op, a, c, (Span){0}) : tape_ternary(b, op, a, c, d, (Span){0});
    return tape_finish(b, &out, 1);
}

static double at(const Tape *tape, Vec3 p) {
    double out;
    tape_eval_once(tape, (double[]){p.x, p.y, p.z}, &out);
    return out;
}

static Vec3 axis(int k) { return vec3(k == 0, k == 1, k == 2); }

/* Richardson's extrapolation of central differences: of fourth order; *off says how well two steps agree. */
static double slope_by_steps(const Tape *tape, Vec3 p, int k, double h, double *off) {
    double d[3];
    for (int i = 0; i < 3; i++) {
        double step = ldexp(h, -i);
        d[i] = (at(tape, vec3_madd(p, axis(k), step)) - at(tape, vec3_madd(p, axis(k), -step))) / (2 * step);
    }
    double coarse = (4 * d[1] - d[0]) / 3, fine = (4 * d[2] - d[1]) / 3;
    *off = fabs(fine - coarse) + (fabs(d[0] - d[2]) < 1e-2 * (1 + fabs(fine)) ? 0 : HUGE_VAL);
    return fine;
}

/* Whatever lies between the places of a difference jumps here, or may. */
static bool jumps(TapeOp op) {
    static const TapeOp list[] = {TAPE_IDIV, TAPE_MOD, TAPE_FLOOR, TAPE_CEIL, TAPE_INT, TAPE_BITWISE_AND, TAPE_BITWISE_OR, TAPE_BITWISE_XOR};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(list); k++)
        if (list[k] == op) return true;
    return false;
}

static void every_operation(void **state) {
    (void)state;
    Arena arena;
    Dual scratch[16];
    int compared = 0;
    arena_init(&arena, NULL, 0);
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++) {
        const Tape *tape = tape_of(&arena, operations[o].op, operations[o].arity);
        for (uint64_t i = 0; i < 400; i++) {
            Vec3 p = {4 * unit(i, 1) - 2, 4 * unit(i, 2) - 2, 4 * unit(i, 3) - 2};
            Dual got = tape_eval_gradient(tape, p, scratch);
            double value = at(tape, p);
            assert_true(got.value == value || (isnan(got.value) && isnan(value)));
            if (jumps(operations[o].op)) {
                double whole = operations[o].op == TAPE_MOD ? 1 : 0; /* a - b·n */
                assert_true(!isfinite(value) || (got.by[0] == whole && (whole != 0 || got.by[1] == 0)));
                continue;
            }
            for (int k = 0; k < 3 && isfinite(value); k++) {
                double off, slope = slope_by_steps(tape, p, k, 1e-3, &off);
                if (operations[o].op == TAPE_FOLD && k == 1 && fabs(p.x) > 8 * fabs(p.y)) continue; /* folds are nearer than the steps */
                if (!(off < 1e-7 * (1 + fabs(slope)))) continue; /* a kink, a jump or a border is near */
                compared++;
                if (fabs(got.by[k] - slope) <= 1e-6 * (1 + fabs(slope)) + 10 * off) continue;
                print_error("%s at %.17g %.17g %.17g by %d: %.12g, not %.12g\n", operations[o].name, p.x, p.y, p.z, k, slope, got.by[k]);
                fail();
            }
        }
    }
    assert_true(compared > 30000);
    arena_destroy(&arena);
}

/* In long double: equation 17 of Gamito & Maddock's sort, without the noise, of Earth's size. */
static void exact_to_rounding(void **state) {
    (void)state;
    Arena arena;
    Dual scratch[64];
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef sum = tape_constant(b, 0);
    for (int k = 0; k < 3; k++) sum = tape_binary(b, TAPE_ADD, sum, tape_unary(b, TAPE_SQR, tape_input(b, k), (Span){0}), (Span){0});
    TapeRef f = tape_unary(b, TAPE_SQRT, sum, (Span){0});
    f = tape_binary(b, TAPE_ADD, f, tape_unary(b, TAPE_SIN, tape_input(b, 0), (Span){0}), (Span){0});
    const Tape *tape = tape_finish(b, &f, 1);
    for (uint64_t i = 0; i < 1000; i++) {
        Vec3 p = {6e6 * unit(i, 0), 6e6 * unit(i, 1), 6e6 * unit(i, 2)};
        Dual got = tape_eval_gradient(tape, p, scratch);
        long double x = (long double)p.x, y = (long double)p.y, z = (long double)p.z, r = sqrtl(x * x + y * y + z * z);
        assert_true(fabsl((long double)got.by[0] - (x / r + cosl(x))) < 4e-16L);
        assert_true(fabsl((long double)got.by[1] - y / r) < 4e-16L);
        assert_true(fabsl((long double)got.by[2] - z / r) < 4e-16L);
    }
    arena_destroy(&arena);
}

/* Steps of 1e-4 in noises whose third derivatives are at most some hundreds. */
static void noises_of_nodes(void **state) {
    (void)state;
    int kinks = 0, compared = 0;
    for (uint64_t i = 0; i < 2000; i++) {
        const double h = 1e-5;
        Vec3 p = {40 * unit(i, 0) - 20, 40 * unit(i, 1) - 20, 40 * unit(i, 2) - 20}, worley[WORLEY_NODES];
        int last = (int)(i % WORLEY_NODES), count = 1 + (int)(i % 5);
        noise_worley_gradients(p, last, worley);
        Vec3 sparse = noise_sparse_gradient(p, count);
        for (int k = 0; k < 3; k++) {
            Vec3 low = vec3_madd(p, axis(k), -h), high = vec3_madd(p, axis(k), h);
            double slope = (noise_sparse_convolution(high, count) - noise_sparse_convolution(low, count)) / (2 * h);
            assert_true(fabs(slope - (&sparse.x)[k]) < 1e-5);
            for (int n = 0; n <= last; n++)
                compared++, kinks += !(fabs((noise_worley(high, n) - noise_worley(low, n)) / (2 * h) - (&worley[n].x)[k]) < 1e-4);
        }
        for (int n = 0; n <= last; n++) assert_true(fabs(vec3_length(worley[n]) - 1) < 1e-12);
    }
    assert_true(kinks < compared / 500); /* two nodes as far, here and there */
    assert_true(isnan(noise_sparse_gradient(vec3((double)NAN, 0, 0), 2).x));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_operation), cmocka_unit_test(exact_to_rounding), cmocka_unit_test(noises_of_nodes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
