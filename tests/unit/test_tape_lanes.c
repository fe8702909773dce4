/* Bounds of many pieces of a line at once hold what they must: every operation and every noise against the scalar arithmetic at random
 * places of random pieces; sums cut short against the whole; worley() and sparse_convolution() over boxes. */
#include "tape/tape_lanes.h"

#include "bounds_sample.h"
#include "tape/noise.h"
#include "tape/noise_floats.h"
#include "tape/noise_interval.h"
#include "tape/node_cache.h"
#include "tape/tape_noise.h"
#include "tape/noise_nodes_forms.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

/* Forms without error, so that a place on the piece tells the operands; of any size. */
static AffineForm some_line(uint64_t i, uint32_t k, bool near) {
    static const double scales[] = {1, 0.3, 0.1, 1e-2, 1e-3, 1e-6, 1e-9, 0};
    AffineForm a = {near ? 40 * (unit(i, k) - 0.5) : some_number(i, k), scales[bits(i, k + 3) % 8] * (2 * unit(i, k + 4) - 1), 0, false};
    if (!isfinite(a.centre)) a.centre = 2;
    return a;
}

/* The operand at s is rounded: what that is off is in the form's error. */
static AffineForm with_rounding(AffineForm a) {
    a.error = (fabs(a.centre) + fabs(a.slope)) * 0x1p-51;
    return a;
}

static const Tape *tape_of(Arena *arena, TapeOp op, int arity) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef a = tape_input(b, 0), c = tape_input(b, 1), d = tape_input(b, 2);
    TapeRef out = arity == 1 ? tape_unary(b, op, a, (Span){0}) : arity == 2 ? tape_binary(b, op, a, c, (Span){0}) : tape_ternary(b, op, a, c, d, (Span){0});
    return tape_finish(b, &out, 1);
}

static int misses(const Tape *tape, const char *name, uint64_t seed, int batches, bool near, int *known) {
    AffineLanes in[3], out, scratch[16];
    int failures = 0;
    assert_true(tape_scratch_size(tape) <= VTS_ARRAY_COUNT(scratch));
    for (uint64_t i = 0; i < (uint64_t)batches; i++) {
        uint64_t n = (i * 64 + seed) * 64;
        for (uint32_t l = 0; l < AFFINE_LANES; l++)
            for (uint32_t k = 0; k < 3; k++) affine_set_lane(&in[k], (int)l, with_rounding(some_line(n + l, 10 * k, near)));
        tape_eval_lanes(tape, in, &out, scratch);
        for (uint32_t l = 0; l < AFFINE_LANES; l++) {
            if (!(out.error[l] < HUGE_VAL)) continue;
            ++*known;
            for (uint32_t t = 0; t < 4; t++) {
                double s = t == 0 ? -1 : t == 1 ? 1 : 2 * unit(n + l, 40 + t) - 1, x[3], value;
                for (int k = 0; k < 3; k++) x[k] = in[k].centre[l] + in[k].slope[l] * s;
                tape_eval_once(tape, x, &value);
                long double off = fabsl((long double)value - ((long double)out.centre[l] + (long double)out.slope[l] * (long double)s));
                if (off <= (long double)out.error[l]) continue;
                if (++failures < 10)
                    print_error("%s(%.17g, %.17g, %.17g) = %.17g is not %.17g + %.17g * %.17g +- %.3g\n", name, x[0], x[1], x[2], value, out.centre[l],
                                out.slope[l], s, out.error[l]);
            }
        }
    }
    return failures;
}

/* Powers and periods usually are numbers, which has bounds of its own. */
static void hold_with_constants(void **state) {
    (void)state;
    static const double powers[] = {0.5, 1.5, 2.5, 0.2, -0.7, -3.3, 7.7, 40.5, 1e-9}, periods[] = {0.1, 1, -3, 2 * VTS_PI, 1e-3, 1e6};
    int known = 0, failures = 0;
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(powers) + VTS_ARRAY_COUNT(periods); k++) {
        bool is_power = k < VTS_ARRAY_COUNT(powers);
        double constant = is_power ? powers[k] : periods[k - VTS_ARRAY_COUNT(powers)];
        TapeOp op = is_power ? TAPE_POW : TAPE_FOLD;
        TapeBuilder *b = tape_builder_create(&arena, 3);
        TapeRef out = tape_binary(b, op, tape_input(b, 0), tape_constant(b, constant), (Span){0});
        const Tape *tape = tape_finish(b, &out, 1);
        failures += misses(tape, tape_op_text(op), 100 + k, (int)span_count(4000) / 8, true, &known);
        failures += misses(tape, tape_op_text(op), 200 + k, (int)span_count(4000) / 8, false, &known);
    }
    assert_int_equal(failures, 0);
    assert_true(known > 20000);
    arena_destroy(&arena);
}

static void every_operation_holds_its_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    int failures = 0, known = 0;
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++) {
        const Tape *tape = tape_of(&arena, operations[o].op, operations[o].arity);
        for (int near = 0; near < 2; near++)
            failures += misses(tape, operations[o].name, o, (int)(span_count(8000) / AFFINE_LANES / 2), near, &known);
    }
    assert_int_equal(failures, 0);
    assert_true((uint64_t)known > 25 * span_count(8000));
    arena_destroy(&arena);
}

static void noises_hold_their_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    int known = 0, batches = (int)(span_count(240000) / AFFINE_LANES);
    assert_int_equal(misses(tape_of(&arena, TAPE_PERLIN, 3), "perlin", 61, batches, true, &known), 0);
    assert_int_equal(misses(tape_of(&arena, TAPE_POV_NOISE, 3), "f_noise3d", 62, batches, true, &known), 0);
    assert_int_equal(known, 2 * batches * AFFINE_LANES);
    arena_destroy(&arena);
}

/* Constants as operands have ways of their own. */
static void constants_hold_their_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    int failures = 0, known = 0;
    static const TapeOp ops[] = {TAPE_ADD, TAPE_SUB, TAPE_MUL, TAPE_DIV, TAPE_POW, TAPE_MIN};
    for (uint64_t k = 0; k < 600; k++) {
        TapeBuilder *b = tape_builder_create(&arena, 3);
        TapeRef c = tape_constant(b, some_number(k, 77)), x = tape_input(b, 0);
        TapeRef out = k % 2 ? tape_binary(b, ops[k / 2 % 6], c, x, (Span){0}) : tape_binary(b, ops[k / 2 % 6], x, c, (Span){0});
        failures += misses(tape_finish(b, &out, 1), "with a constant", k, 20, k % 3, &known);
    }
    assert_int_equal(failures, 0);
    assert_true(known > 20000);
    arena_destroy(&arena);
}

/* A sum whose fine terms are left out where they cannot matter still holds the whole. */
static void sums_hold_their_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef p[3], sum = tape_constant(b, -1);
    for (int k = 0; k < 3; k++) p[k] = tape_input(b, k);
    for (int k = 0; k < 3; k++) sum = tape_binary(b, TAPE_ADD, sum, tape_unary(b, TAPE_SQR, p[k], (Span){0}), (Span){0});
    for (int o = 0; o < 5; o++) {
        TapeRef at[3];
        for (int k = 0; k < 3; k++) at[k] = tape_binary(b, TAPE_MUL, p[k], tape_constant(b, ldexp(1, o)), (Span){0});
        TapeRef n = tape_ternary(b, o % 2 ? TAPE_POV_NOISE : TAPE_PERLIN, at[0], at[1], at[2], (Span){0});
        TapeRef term = tape_binary(b, TAPE_MUL, n, tape_constant(b, pow(0.5, o)), (Span){0});
        sum = tape_binary(b, o % 2 ? TAPE_SUB : TAPE_ADD, sum, term, (Span){0});
    }
    const Tape *tape = tape_finish(b, &sum, 1);
    const Interval box[3] = {interval(-21, 21), interval(-21, 21), interval(-21, 21)};
    TapeSum parts = tape_sum_of(tape, box, &arena);
    assert_int_equal(parts.count, 8);
    AffineLanes scratch[32], out;
    assert_true(parts.scratch_size <= VTS_ARRAY_COUNT(scratch));
    size_t early = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        double level = 4 * unit(i, 90);
        for (uint32_t l = 0; l < AFFINE_LANES; l++)
            for (uint32_t k = 0; k < 3; k++) {
                AffineForm line = some_line(i * 8 + l, 10 * k, true);
                line.centre /= i % 2 ? 8 : 1;
                affine_set_lane(&scratch[k], (int)l, with_rounding(line));
            }
        AffineLanes in[3] = {scratch[0], scratch[1], scratch[2]};
        early += tape_sum_lanes(&parts, level, NULL, &out, scratch) < parts.count;
        for (uint32_t l = 0; l < AFFINE_LANES; l++) {
            double s = 2 * unit(i, l) - 1, x[3], value;
            for (int k = 0; k < 3; k++) x[k] = in[k].centre[l] + in[k].slope[l] * s;
            tape_eval_once(tape, x, &value);
            assert_true(out.error[l] < HUGE_VAL);
            assert_true(fabs(value - level - (out.centre[l] + out.slope[l] * s)) <= out.error[l]);
        }
    }
    assert_true(early > 1000 && early < 19000);
    arena_destroy(&arena);
}

/* Of the terms that were evaluated some, at random, with what was added up. */
static TapeSettled settled_of(const TapeEach *each, uint32_t wanted) {
    TapeSettled out = {.terms = each->terms & wanted};
    for (int k = 0; k < TAPE_SETTLED_MOST; k++) {
        if (!(out.terms >> k & 1)) continue;
        for (int l = 0; l < AFFINE_LANES; l++) {
            double c = each->of[k].centre[l], s = each->of[k].slope[l], e = each->of[k].error[l];
            out.centre[l] += c, out.slope[l] += s, out.error[l] += e, out.size[l] += fabs(c) + fabs(s) + e;
        }
    }
    return out;
}

/* Terms that are settled are not evaluated again, and the sum holds its values as before. */
static void settled_terms_hold_their_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef p[3], sum = tape_constant(b, 0.25);
    for (int k = 0; k < 3; k++) p[k] = tape_input(b, k), sum = tape_binary(b, TAPE_ADD, sum, tape_unary(b, TAPE_SQR, p[k], (Span){0}), (Span){0});
    sum = tape_binary(b, TAPE_SUB, sum, tape_ternary(b, TAPE_PERLIN, p[0], p[1], p[2], (Span){0}), (Span){0});
    const Tape *tape = tape_finish(b, &sum, 1);
    const Interval box[3] = {interval(-21, 21), interval(-21, 21), interval(-21, 21)};
    TapeSum parts = tape_sum_of(tape, box, &arena);
    AffineLanes scratch[32], out;
    TapeEach each, again;
    int fewer = 0;
    assert_true(parts.scratch_size <= VTS_ARRAY_COUNT(scratch));
    for (uint64_t i = 0; i < 10000; i++) {
        for (uint32_t l = 0; l < AFFINE_LANES; l++)
            for (uint32_t k = 0; k < 3; k++) affine_set_lane(&scratch[k], (int)l, with_rounding(some_line(i * 8 + l, 10 * k, true)));
        AffineLanes in[3] = {scratch[0], scratch[1], scratch[2]};
        double level = 4 * unit(i, 90);
        tape_sum_rest(&parts, level, NULL, NULL, NULL, &out, &each, scratch, NULL);
        const TapeSettled settled = settled_of(&each, (uint32_t)bits(i, 91));
        for (int k = 0; k < 3; k++) scratch[k] = in[k];
        tape_sum_rest(&parts, level, NULL, &settled, NULL, &out, &again, scratch, NULL);
        assert_int_equal(again.terms & settled.terms, 0);
        fewer += again.terms != each.terms;
        for (uint32_t l = 0; l < AFFINE_LANES; l++) {
            double s = 2 * unit(i, l) - 1, x[3], value;
            for (int k = 0; k < 3; k++) x[k] = in[k].centre[l] + in[k].slope[l] * s;
            tape_eval_once(tape, x, &value);
            assert_true(fabs(value - level - (out.centre[l] + out.slope[l] * s)) <= out.error[l]);
        }
    }
    assert_true(fewer > 5000);
    arena_destroy(&arena);
}

/* What floats are off, a quarter of what is allowed for it. */
static void floats_are_near_doubles(void **state) {
    (void)state;
    uint64_t count = span_count(80000) / TAYLOR_LANES;
    double most = 0;
    for (uint64_t i = 0; i < count; i++) {
        TaylorWay way;
        TaylorTerms exact;
        FloatTerms near;
        double far = i % 5 ? 50 : 1e9;
        for (uint32_t k = 0; k < 3; k++)
            for (uint32_t l = 0; l < TAYLOR_LANES; l++) {
                way.at[k][l] = far * (2 * unit(i, 8 * k + l) - 1), way.way[k][l] = 0.5 * (2 * unit(i, 24 + 8 * k + l) - 1);
                if (i % 3 == 0) way.at[k][l] = way.at[k][0] + 0.01 * unit(i, 48 + 8 * k + l);
                if (bits(i, 72 + l) % 40 == 0) way.at[k][l] = floor(way.at[k][l]);
            }
        i % 2 ? noise_perlin_taylor(&way, &exact) : noise_pov_taylor(&way, &exact);
        i % 2 ? noise_perlin_floats(&way, &near) : noise_pov_floats(&way, &near);
        for (int l = 0; l < TAYLOR_LANES; l++) {
            double off = fabs(exact.value[l] - (double)near.value[l]) + fabs(exact.first[l] - (double)near.first[l]) + fabs(exact.second[l] - (double)near.second[l]);
            most = fmax(most, off);
            assert_true(fabs(exact.outside[l] - (double)near.outside[l]) < 1e-6);
        }
    }
    assert_true(most < NOISE_FLOAT_ERROR / 4);
    assert_true(most > NOISE_FLOAT_ERROR / 1e4); /* they are floats */
}

/* noise(A·p + b), A turned, flat or nothing, b far away or near; written in several ways. */
static TapeRef linear_noise(TapeBuilder *b, const TapeRef p[3], uint64_t i, double frequency) {
    TapeRef at[3];
    for (uint32_t j = 0; j < 3; j++) {
        at[j] = tape_constant(b, bits(i, 40 + j) % 3 ? 20 * unit(i, 43 + j) : bits(i, 40 + j) % 7 ? 0 : 1e7 * unit(i, 46 + j));
        for (uint32_t k = 0; k < 3; k++) {
            double by = i % 2 ? (j == k ? frequency : 0) : frequency * (2 * unit(i, 50 + 3 * j + k) - 1);
            if (by == 0) continue;
            TapeRef part = k == 2 ? tape_binary(b, TAPE_DIV, p[k], tape_constant(b, 1 / by), (Span){0}) : tape_binary(b, TAPE_MUL, p[k], tape_constant(b, by), (Span){0});
            at[j] = k == 1 ? tape_binary(b, TAPE_SUB, at[j], tape_unary(b, TAPE_NEG, part, (Span){0}), (Span){0}) : tape_binary(b, TAPE_ADD, at[j], part, (Span){0});
        }
    }
    return tape_ternary(b, i / 2 % 2 ? TAPE_PERLIN : TAPE_POV_NOISE, at[0], at[1], at[2], (Span){0});
}

/* Lines at scales from one to the Earth's radius; pieces from longer than a cell to a thousand-millionth of one. Floats and doubles both have their share. */
static void noises_along_lines_hold_their_values(void **state) {
    (void)state;
    static const double radii[] = {1, 1e3, 6.4e6};
    Arena arena;
    arena_init(&arena, NULL, 0);
    uint64_t count = span_count(40000) / 20 + 1;
    double tight = 0;
    for (uint64_t i = 0; i < count; i++) {
        double radius = radii[i % 3];
        ArenaMark mark = arena_mark(&arena);
        TapeBuilder *b = tape_builder_create(&arena, 3);
        TapeRef p[3] = {tape_input(b, 0), tape_input(b, 1), tape_input(b, 2)}, f = linear_noise(b, p, i, (1 + 7 * unit(i, 1)) / radius);
        const Tape *tape = tape_finish(b, &f, 1);
        const Interval box[3] = {interval(-4 * radius, 4 * radius), interval(-4 * radius, 4 * radius), interval(-4 * radius, 4 * radius)};
        TapeSum sum = tape_sum_of(tape, box, &arena);
        TapeNoiseWay ways[1];
        AffineLanes scratch[32], out;
        TapeEach each;
        assert_true(sum.count == 1 && sum.terms[0].noise && sum.scratch_size <= VTS_ARRAY_COUNT(scratch));
        Vec3 origin = vec3_scale(vec3(2 * unit(i, 2) - 1, 2 * unit(i, 3) - 1, 2 * unit(i, 4) - 1), radius),
             along = vec3_normalize(vec3(2 * unit(i, 5) - 1, 2 * unit(i, 6) - 1, 2 * unit(i, 7) - 1));
        tape_sum_begin(&sum, origin, along, ways);
        for (uint32_t n = 0; n < 20; n++) {
            double middle[AFFINE_LANES], half[AFFINE_LANES], size = ldexp(radius, -(int)(bits(i, 100 + n) % 30));
            for (uint32_t l = 0; l < AFFINE_LANES; l++) middle[l] = radius * (2 * unit(i, 200 + 8 * n + l) - 1), half[l] = size * unit(i, 400 + 8 * n + l);
            const TapePieces pieces = {middle, half, ways};
            tape_sum_rest(&sum, 0, NULL, NULL, &pieces, &out, &each, scratch, NULL);
            for (uint32_t l = 0; l < AFFINE_LANES; l++)
                for (int s = -2; s <= 2; s++) {
                    Vec3 at = vec3_madd(origin, along, middle[l] + half[l] * (s / 2.0));
                    double value;
                    tape_eval_once(tape, (double[]){at.x, at.y, at.z}, &value);
                    assert_true(fabs(value - (out.centre[l] + out.slope[l] * (s / 2.0))) <= out.error[l]);
                    tight += out.error[l] < 1e-3;
                }
        }
        arena_reset_to(&arena, mark);
    }
    assert_true(tight > 200 * (double)count); /* of 800 */
    arena_destroy(&arena);
}

static void nodes_hold_their_values(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6000; i++) {
        Interval box[3];
        double size = ldexp(1, -(int)(bits(i, 1) % 12)), far = i % 5 ? 20 : 1e9;
        for (uint32_t k = 0; k < 3; k++) {
            double low = far * (unit(i, 2 + k) - 0.5);
            box[k] = interval(low, low + size * unit(i, 5 + k));
        }
        int index = (int)(i % WORLEY_NODES), count = 1 + (int)(i % 4);
        Interval worley = interval_worley(box, index), sparse = interval_sparse_convolution(box, count);
        for (uint32_t t = 0; t < 4; t++) {
            Vec3 p = {some_place(box[0], i, 10 + 9 * t), some_place(box[1], i, 13 + 9 * t), some_place(box[2], i, 16 + 9 * t)};
            assert_true(interval_holds(worley, noise_worley(p, index)));
            assert_true(interval_holds(sparse, noise_sparse_convolution(p, count)));
        }
    }
}

/* Pieces of a line as a search makes them: neighbours share the nodes and impulses about them. */
static void nodes_along_lines_hold_their_values(void **state) {
    (void)state;
    double tight = 0, count = 0;
    for (uint64_t i = 0; i < 8000; i++) {
        enum { COUNT = AFFINE_LANES };
        AffineForm place[3 * COUNT], worley[WORLEY_NODES * COUNT], sparse[COUNT];
        double half = ldexp(0.7, -(int)(bits(i, 1) % 20)), far = i % 5 ? 20 : 1e8, off = i % 3 ? 0 : 0.01 * half;
        int last = (int)(i % WORLEY_NODES), impulses = 1 + (int)(i % 12), pieces = 1 + (int)(i % COUNT);
        for (uint32_t k = 0; k < 3; k++) {
            double origin = far * (unit(i, 2 + k) - 0.5), along = 2 * unit(i, 5 + k) - 1;
            for (int n = 0; n < pieces; n++)
                place[(int)k * pieces + n] = (AffineForm){origin + 2 * n * half * along, half * along, off + far * 0x1p-50, false};
        }
        affine_worley(pieces, place, last, worley, NULL);
        affine_sparse_convolution(pieces, place, impulses, sparse, NULL);
        for (int n = 0; n < pieces; n++)
            for (uint32_t t = 0; t < 5; t++) {
                double s = t == 0 ? -1 : t == 1 ? 1 : 2 * unit(i, 20 + t) - 1, x[3], nearest[WORLEY_NODES];
                for (int k = 0; k < 3; k++) {
                    const AffineForm f = place[k * pieces + n];
                    x[k] = f.centre + f.slope * s + off * (2 * unit(i, 30 + t) - 1);
                }
                noise_worley_nearest(vec3(x[0], x[1], x[2]), last, nearest);
                for (int k = 0; k <= last; k++) {
                    const AffineForm f = worley[k * pieces + n];
                    assert_true(fabs(nearest[k] - (f.centre + f.slope * s)) <= f.error * (1 + 1e-12));
                    if (half < 1e-3 && off == 0 && far < 100) tight += f.error < 0.1 * half, count++;
                }
                const AffineForm f = sparse[n];
                assert_true(fabs(noise_sparse_convolution(vec3(x[0], x[1], x[2]), impulses) - (f.centre + f.slope * s)) <= f.error * (1 + 1e-12));
            }
    }
    assert_true(tight > 0.97 * count); /* else two nodes are as far there, or one is close */
}

static void assert_same(const AffineForm *a, const AffineForm *b, int count) {
    for (int k = 0; k < count; k++)
        assert_true(a[k].centre == b[k].centre && a[k].slope == b[k].slope && a[k].error == b[k].error && a[k].nan == b[k].nan);
}

/* Whatever a cache has seen before, places far away and other numbers of impulses among them. */
static void caches_change_nothing(void **state) {
    (void)state;
    NodeCache *cells = malloc(sizeof *cells);
    assert_non_null(cells);
    node_cache_begin(cells);
    for (uint64_t i = 0; i < 20000; i++) {
        AffineForm place[3], with[WORLEY_NODES], without[WORLEY_NODES];
        double far = i % 7 ? 12 : 1e8;
        for (uint32_t k = 0; k < 3; k++) place[k] = (AffineForm){far * (unit(i, k) - 0.5), 0.2 * unit(i, 5 + k) - 0.1, 0, false};
        int last = (int)(i % WORLEY_NODES), impulses = 1 + (int)(i % 11);
        affine_worley(1, place, last, with, cells), affine_worley(1, place, last, without, NULL);
        assert_same(with, without, last + 1);
        affine_sparse_convolution(1, place, impulses, with, cells), affine_sparse_convolution(1, place, impulses, without, NULL);
        assert_same(with, without, 1);
    }
    free(cells);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_operation_holds_its_values), cmocka_unit_test(hold_with_constants), cmocka_unit_test(noises_hold_their_values), cmocka_unit_test(constants_hold_their_values),
        cmocka_unit_test(sums_hold_their_values), cmocka_unit_test(settled_terms_hold_their_values),           cmocka_unit_test(nodes_hold_their_values),
        cmocka_unit_test(nodes_along_lines_hold_their_values), cmocka_unit_test(caches_change_nothing),
        cmocka_unit_test(noises_along_lines_hold_their_values), cmocka_unit_test(floats_are_near_doubles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
