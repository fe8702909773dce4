/* Sums without their finest terms: which go, that bounds hold what values there are, and that nothing jumps. */
#include "tape/tape_detail.h"

#include "bounds_sample.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static TapeRef times(TapeBuilder *b, TapeRef x, double k) { return tape_binary(b, TAPE_MUL, x, tape_constant(b, k), (Span){0}); }
static TapeRef plus(TapeBuilder *b, TapeRef x, TapeRef y) { return tape_binary(b, TAPE_ADD, x, y, (Span){0}); }

/* y + Σ gainᵏ·height·perlin(2ᵏ·p), k = 0 … octaves − 1 */
static const Tape *hills(Arena *arena, int octaves, double height, double gain) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef f = tape_input(b, 1);
    for (int o = 0; o < octaves; o++) {
        TapeRef at[3];
        for (int k = 0; k < 3; k++) at[k] = times(b, tape_input(b, k), ldexp(1, o));
        f = plus(b, f, times(b, tape_ternary(b, TAPE_PERLIN, at[0], at[1], at[2], (Span){0}), height * pow(gain, o)));
    }
    return tape_finish(b, &f, 1);
}

static const Interval box[3] = {{-20, 20, false}, {-2, 2, false}, {-20, 20, false}};

/* A Perlin noise of unit cells has waves of about 1.4: it fades from half a cell on. */
static void octaves_go_in_turn(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum sum = tape_sum_of(hills(&arena, 6, 0.3, 0.5), box, &arena);
    assert_int_equal(sum.count, 7);
    assert_true(tape_sum_measure(&sum, box, &arena));
    int may_go = 0;
    for (size_t k = 0; k < sum.count; k++) {
        if (!(sum.terms[k].gone < HUGE_VAL)) continue;
        double cell = sum.terms[k].high - sum.terms[k].low; /* 0.6·1.04·2⁻ᵏ: the cell is as wide, but for that factor */
        cell /= 0.6 * 1.03636;
        assert_true(sum.terms[k].full > 0.35 * cell && sum.terms[k].full < 0.65 * cell);
        assert_true(fabs(sum.terms[k].mean) < 0.02 * cell);
        may_go++;
    }
    assert_int_equal(may_go, 6);
    arena_destroy(&arena);
}

/* Heights that are seen however fine what has them: spikes of 30 widths do not go at one; what is not the same everywhere never does. */
static void what_shows_stays(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum spikes = tape_sum_of(hills(&arena, 1, 30, 1), box, &arena);
    tape_sum_measure(&spikes, box, &arena);
    for (size_t k = 0; k < spikes.count; k++) assert_true(spikes.terms[k].full > 25);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef x = tape_input(b, 0), n = tape_ternary(b, TAPE_PERLIN, times(b, x, 9), times(b, tape_input(b, 1), 9), times(b, tape_input(b, 2), 9), (Span){0});
    TapeRef f = plus(b, tape_input(b, 1), times(b, tape_binary(b, TAPE_MUL, n, plus(b, tape_unary(b, TAPE_ABS, x, (Span){0}), x), (Span){0}), 0.001));
    TapeSum uneven = tape_sum_of(tape_finish(b, &f, 1), box, &arena);
    assert_int_equal(uneven.count, 2);
    assert_false(tape_sum_measure(&uneven, box, &arena));
    arena_destroy(&arena);
}

static void bounds_hold_values(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum sum = tape_sum_of(hills(&arena, 8, 0.3, 0.6), box, &arena);
    tape_sum_measure(&sum, box, &arena);
    double values[64];
    Dual duals[64];
    AffineForm forms[64];
    AffineLanes lanes[64], in[3], wide, bounds;
    assert_true(sum.scratch_size <= 64);
    for (uint64_t i = 0; i < 6000; i++) {
        double half = ldexp(2, -(int)(bits(i, 0) % 30)), widest = ldexp(4, -(int)(bits(i, 1) % 12));
        for (int l = 0; l < AFFINE_LANES; l++) {
            for (uint32_t k = 0; k < 3; k++)
                affine_set_lane(&in[k], l, (AffineForm){10 * unit(i, 2 + k) - 5 + 2 * half * l, half * (2 * unit(i, 5 + k) - 1), 0x1p-48, false});
            double width = widest * (1 + unit(i, 9));
            affine_set_lane(&wide, l, (AffineForm){width, width * 0.9 * unit(i, 10), 0x1p-48, false});
        }
        for (int k = 0; k < 3; k++) lanes[k] = in[k];
        double level = 3 * unit(i, 13) - 1;
        tape_sum_lanes(&sum, level, &wide, &bounds, lanes);
        for (int l = 0; l < AFFINE_LANES; l++) {
            double s = 2 * unit(i, 20 + (uint32_t)l) - 1, width = wide.centre[l] + wide.slope[l] * s;
            Vec3 p = {in[0].centre[l] + in[0].slope[l] * s, in[1].centre[l] + in[1].slope[l] * s, in[2].centre[l] + in[2].slope[l] * s};
            double value = tape_sum_value(&sum, p, width, values);
            assert_true(fabs(value - level - (bounds.centre[l] + bounds.slope[l] * s)) <= bounds.error[l]);
            const AffineForm place[3] = {affine_lane(&in[0], l), affine_lane(&in[1], l), affine_lane(&in[2], l)};
            AffineForm form = tape_sum_form(&sum, place, affine_lane(&wide, l), forms);
            assert_true(fabs(value - (form.centre + form.slope * s)) <= form.error);
            Dual d = tape_sum_gradient(&sum, p, width, duals);
            assert_true(fabs(d.value - value) < 1e-13);
            double h = 1e-6, up = tape_sum_value(&sum, vec3(p.x, p.y + h, p.z), width, values), down = tape_sum_value(&sum, vec3(p.x, p.y - h, p.z), width, values);
            assert_true(fabs((up - down) / (2 * h) - d.by[1]) < 1e-4);
        }
    }
    arena_destroy(&arena);
}

/* Another width by a part in 10⁶ is another value by as little: no octave comes or goes at once, so nothing crawls. */
static void values_change_steadily_with_the_width(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum sum = tape_sum_of(hills(&arena, 8, 0.3, 0.6), box, &arena);
    tape_sum_measure(&sum, box, &arena);
    double values[64], moved = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        Vec3 p = {10 * unit(i, 0), unit(i, 1), 10 * unit(i, 2)};
        double width = ldexp(1 + unit(i, 3), -(int)(i % 12)), next = width * (1 + 1e-6);
        double off = fabs(tape_sum_value(&sum, p, next, values) - tape_sum_value(&sum, p, width, values));
        assert_true(off < 2e-6); /* a share changes by 1e-6·width/(gone − full) < 2e-6, of up to 0.31, of two octaves or three */
        moved = fmax(moved, off);
    }
    assert_true(moved > 1e-9);
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(octaves_go_in_turn), cmocka_unit_test(what_shows_stays), cmocka_unit_test(bounds_hold_values),
                                       cmocka_unit_test(values_change_steadily_with_the_width)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
