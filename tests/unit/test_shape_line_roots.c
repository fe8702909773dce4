/* First changes of sign along lines against a dense search, which misses what bounds do not. */
#include "shape/line_roots.h"

#include "base/random.h"
#include "tape/interval.h"
#include "tape/tape.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static double unit(uint64_t i, uint32_t k) { return random_unit(random_hash(0x726F6F74, i, k, 0)); }

static TapeRef scaled(TapeBuilder *b, TapeRef x, double k) { return tape_binary(b, TAPE_MUL, x, tape_constant(b, k), (Span){0}); }
static TapeRef sum(TapeBuilder *b, TapeRef x, TapeRef y) { return tape_binary(b, TAPE_ADD, x, y, (Span){0}); }

/* Gamito & Maddock's equation 17 over a sphere of any radius: |p| − R + Σ 0.6·R·2^(−0.8k)·perlin(2^(k+2)·p/R). */
static const Tape *rough_ball(Arena *arena, double radius, TapeOp noise) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef p[3], square = tape_constant(b, 0);
    for (int k = 0; k < 3; k++) {
        p[k] = tape_input(b, k);
        square = sum(b, square, tape_unary(b, TAPE_SQR, p[k], (Span){0}));
    }
    TapeRef f = sum(b, tape_unary(b, TAPE_SQRT, square, (Span){0}), tape_constant(b, -radius));
    for (int o = 0; o < 4; o++) {
        double frequency = ldexp(4, o) / radius;
        TapeRef n = tape_ternary(b, noise, scaled(b, p[0], frequency), scaled(b, p[1], frequency), scaled(b, p[2], frequency), (Span){0});
        f = sum(b, f, scaled(b, n, 0.6 * radius * pow(2, -0.8 * o)));
    }
    return tape_finish(b, &f, 1);
}

/* Bounds of one piece at a time, or of many. */
enum { ONE, MANY };

static Line line_of(Arena *arena, const Tape *tape, double level, Vec3 origin, Vec3 direction, LineMethod method, int lanes, double reach) {
    Line line = {.tape = tape, .level = level, .origin = origin, .direction = direction, .method = method};
    const Interval box[3] = {interval(-reach, reach), interval(-reach, reach), interval(-reach, reach)};
    TapeSum *sum = arena_new(arena, TapeSum);
    if (lanes == ONE) return line;
    *sum = tape_sum_of(tape, box, arena);
    line.sum = sum;
    return line;
}

static double at(const Line *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double in[3] = {p.x, p.y, p.z}, out;
    tape_eval_once(line->tape, in, &out);
    return out - line->level;
}

/* The first sample behind `from` on the other side, or `to`. */
static double dense(const Line *line, double from, double to, int samples) {
    bool below = at(line, from) <= 0;
    for (int i = 1; i <= samples; i++) {
        double t = from + (to - from) * i / samples;
        if ((at(line, t) <= 0) != below) return t;
    }
    return to;
}

static void compare(double radius, TapeOp noise, LineMethod method, int lanes, double level, int rays, int samples) {
    Arena arena;
    arena_init(&arena, NULL, 0);
    const Tape *tape = rough_ball(&arena, radius, noise);
    const Line any = line_of(&arena, tape, level * radius, vec3(0, 0, 0), vec3(1, 0, 0), method, lanes, 20 * radius);
    int met = 0;
    for (uint64_t i = 0; i < (uint64_t)rays; i++) {
        Vec3 from = vec3_scale(vec3_normalize(vec3(unit(i, 0) - 0.5, unit(i, 1) - 0.5, unit(i, 2) - 0.5)), 5 * radius);
        Vec3 to = vec3_scale(vec3(unit(i, 3) - 0.5, unit(i, 4) - 0.5, unit(i, 5) - 0.5), 3 * radius);
        Line line = any;
        line.origin = from, line.direction = vec3_normalize(vec3_sub(to, from));
        double t = 0, end = 9 * radius, first = dense(&line, 0, end, samples);
        bool falling, found = line_first_root(&line, 0, end, &t, &falling, NULL);
        assert_true(found || first == end);
        if (!found) continue;
        met++;
        assert_true(falling);
        assert_true(t <= first);
        /* The sign does change there, and the dense search has passed none. */
        double close = 1e-9 * radius;
        assert_true(at(&line, t - close) > 0 || at(&line, t + close) <= 0 || fabs(at(&line, t)) < 1e-7 * radius);
        assert_true(fabs(at(&line, t)) < 1e-7 * radius);
    }
    assert_true(met > rays / 4);
    arena_destroy(&arena);
}

static void first_roots_are_not_missed(void **state) {
    (void)state;
    compare(1, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, ONE, 0, 1000, 4000);
    compare(1, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, MANY, 0, 2000, 4000);
    compare(1, TAPE_PERLIN, LINE_AFFINE, ONE, 0.1, 300, 2000);
    compare(1, TAPE_PERLIN, LINE_INTERVAL, ONE, 0, 200, 2000);
    compare(1, TAPE_PERLIN, LINE_STANDARD, ONE, 0, 200, 2000);
    compare(1, TAPE_POV_NOISE, LINE_AFFINE_OPTIMISED, ONE, 1, 300, 2000);
    compare(1, TAPE_POV_NOISE, LINE_AFFINE_OPTIMISED, MANY, 1, 1000, 3000);
}

/* The planet of Earth's size: what floats cannot tell apart, doubles from the ray's origin can. */
static void scale_does_not_matter(void **state) {
    (void)state;
    compare(1e3, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, ONE, 0, 300, 2000);
    compare(1e3, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, MANY, 0, 300, 2000);
    compare(6.4e6, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, MANY, 0, 300, 2000);
    compare(6.4e6, TAPE_PERLIN, LINE_AFFINE_OPTIMISED, ONE, 0, 300, 2000);
}

static const Tape *product(Arena *arena, const double *roots, int count, const double *powers) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef x = tape_input(b, 0), f = tape_constant(b, 1);
    for (int k = 0; k < count; k++)
        for (int n = 0; n < (int)powers[k]; n++) f = tape_binary(b, TAPE_MUL, f, tape_binary(b, TAPE_SUB, x, tape_constant(b, roots[k]), (Span){0}), (Span){0});
    return tape_finish(b, &f, 1);
}

static void all_of_a_polynomial_in_turn(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (uint64_t i = 0; i < 300; i++) {
        double roots[5], powers[5] = {1, 1, 3, 1, 1};
        for (uint32_t k = 0; k < 5; k++) roots[k] = k + 0.9 * unit(i, k);
        Line line = line_of(&arena, product(&arena, roots, 5, powers), 0, vec3(0, 0, 0), vec3(1, 0, 0), LINE_AFFINE_OPTIMISED, i % 2 ? MANY : ONE, 20);
        double from = -1, t;
        bool falling, below = true; /* odd in all: below first */
        for (int k = 0; k < 5; k++) {
            assert_true(line_first_root(&line, from, 7, &t, &falling, NULL));
            assert_true(fabs(t - roots[k]) < (k == 2 ? 1e-4 : 1e-12));
            assert_true(falling == !below);
            below = !below;
            from = t + (k == 2 ? 1e-3 : 1e-9);
        }
        assert_false(line_first_root(&line, from, 7, &t, &falling, NULL));
    }
    arena_destroy(&arena);
}

/* Touching is no change; thin shells are not stepped over; ends count by what lies between them. */
static void hard_places_with(int lanes) {
    Arena arena;
    arena_init(&arena, NULL, 0);
    double t;
    bool falling;
    double once[] = {0.3}, twice[] = {2}, thin[] = {0.5, 0.5 + 1e-9}, single[] = {1, 1};
    Line touching = line_of(&arena, product(&arena, once, 1, twice), 0, vec3(0, 0, 0), vec3(1, 0, 0), LINE_AFFINE_OPTIMISED, lanes, 20);
    assert_false(line_first_root(&touching, 0, 1, &t, &falling, NULL));
    Line shell = line_of(&arena, product(&arena, thin, 2, single), 0, vec3(0, 0, 0), vec3(1, 0, 0), LINE_AFFINE_OPTIMISED, lanes, 20);
    assert_true(line_first_root(&shell, 0, 1, &t, &falling, NULL));
    assert_true(falling && fabs(t - 0.5) < 1e-10);
    assert_true(line_first_root(&shell, 0.5 + 5e-10, 1, &t, &falling, NULL));
    assert_true(!falling && fabs(t - 0.5 - 1e-9) < 1e-10);
    assert_false(line_first_root(&shell, 1, 0, &t, &falling, NULL));
    assert_false(line_first_root(&shell, 0.6, HUGE_VAL, &t, &falling, NULL));

    /* 1/x has a pole, where its sign changes, and no zero; ln of what is below 0 is no number: above. */
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef f = tape_binary(b, TAPE_DIV, tape_constant(b, -1), tape_input(b, 0), (Span){0});
    Line pole = line_of(&arena, tape_finish(b, &f, 1), 0, vec3(-0.5, 0, 0), vec3(1, 0, 0), LINE_AFFINE_OPTIMISED, lanes, 20);
    assert_true(line_first_root(&pole, 0, 1, &t, &falling, NULL) && fabs(t - 0.5) < 1e-12);
    b = tape_builder_create(&arena, 3);
    f = tape_unary(b, TAPE_LN, tape_input(b, 0), (Span){0});
    Line log_line = line_of(&arena, tape_finish(b, &f, 1), 0, vec3(-1, 0, 0), vec3(1, 0, 0), LINE_AFFINE_OPTIMISED, lanes, 20);
    assert_true(line_first_root(&log_line, 0, 5, &t, &falling, NULL) && fabs(t - 1) < 1e-12 && falling);
    assert_true(line_first_root(&log_line, 1.5, 5, &t, &falling, NULL) && fabs(t - 2) < 1e-12 && !falling);
    arena_destroy(&arena);
}

/* √(Σ max(0, |xₖ| − 0.45)²) − 0.05: inside, the root is of nothing but zeros, whose roundings must not make it doubtful. */
static const Tape *rounded_box(Arena *arena) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef zero = tape_constant(b, 0), square = zero;
    for (int k = 0; k < 3; k++) {
        TapeRef beyond = sum(b, tape_unary(b, TAPE_ABS, tape_input(b, k), (Span){0}), tape_constant(b, -0.45));
        TapeRef outside = tape_binary(b, TAPE_MAX, zero, beyond, (Span){0});
        square = sum(b, square, tape_unary(b, TAPE_SQR, outside, (Span){0}));
    }
    TapeRef f = sum(b, tape_unary(b, TAPE_SQRT, square, (Span){0}), tape_constant(b, -0.05));
    return tape_finish(b, &f, 1);
}

/* Two places each, found with few bounds, and every piece settled. */
static void insides_of_roots_of_zeros(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    const Tape *tape = rounded_box(&arena);
    for (uint64_t i = 0; i < 200; i++)
        for (int lanes = ONE; lanes <= MANY; lanes++) {
            Vec3 target = vec3(0.8 * unit(i, 0) - 0.4, 0.8 * unit(i, 1) - 0.4, 0.8 * unit(i, 2) - 0.4), origin = vec3(1, 1.2, -2);
            Line line = line_of(&arena, tape, 0, origin, vec3_sub(target, origin), LINE_AFFINE_OPTIMISED, lanes, 4);
            LineWork work = {0, 0, 0};
            double t = 0;
            bool falling = false;
            assert_true(line_first_root(&line, 0, 2, &t, &falling, &work));
            assert_true(falling);
            assert_true(line_first_root(&line, line_behind(&line, t), 2, &t, &falling, &work));
            assert_false(falling);
            assert_false(line_first_root(&line, line_behind(&line, t), 2, &t, &falling, &work));
            assert_int_equal(work.unsettled, 0);
            assert_true(work.bounds < 1000);
        }
    arena_destroy(&arena);
}

static void hard_places(void **state) {
    (void)state;
    hard_places_with(ONE);
    hard_places_with(MANY);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_roots_are_not_missed),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(all_of_a_polynomial_in_turn),
        cmocka_unit_test(hard_places),
        cmocka_unit_test(insides_of_roots_of_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
