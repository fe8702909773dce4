/* How far bounds reach on pieces of a length: what random pieces, taken here in another way, reach on average. */
#include "tape/tape_lanes.h"

#include "bounds_sample.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static const Interval box[3] = {{-8, 8, false}, {-8, 8, false}, {-8, 8, false}};

static TapeSum sum_of(Arena *arena, TapeOp op) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef at[3], f;
    for (int k = 0; k < 3; k++) at[k] = tape_input(b, k);
    f = op == TAPE_PERLIN ? tape_ternary(b, TAPE_PERLIN, at[0], at[1], at[2], (Span){0}) : tape_unary(b, op, at[1], (Span){0});
    return tape_sum_of(tape_finish(b, &f, 1), box, arena);
}

/* Of -y the radius is half of the length times |cos|, whose mean over all directions is 1/2. */
static void planes_reach_by_their_slope(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum sum = sum_of(&arena, TAPE_NEG);
    for (double radius = 1e-6; radius < 0.5; radius *= 3) {
        int at = 0, other = TAPE_REACH_LENGTHS - 1;
        double length = tape_reach_length(&sum.reach, radius, &at);
        assert_true(length > 2.4 * radius && length < 6 * radius);
        assert_true(tape_reach_length(&sum.reach, radius, &other) == length && at == other);
    }
    arena_destroy(&arena);
}

/* Lengths grow with what they may reach, without a jump, up to the diagonal. */
static void lengths_grow(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeSum sum = sum_of(&arena, TAPE_PERLIN);
    double before = 0;
    int at = 0;
    for (double radius = 1e-8; radius < 1e3; radius *= 1.01) {
        double length = tape_reach_length(&sum.reach, radius, &at);
        assert_true(length >= before && length <= sum.reach.length[0]);
        if (before > 0 && radius < 0.9) assert_true(length < 1.6 * before);
        before = length;
    }
    assert_true(before == sum.reach.length[0]);
    assert_true(tape_reach_length(&sum.reach, HUGE_VAL, &at) == before);
    assert_true(tape_reach_length(&sum.reach, 0, &at) == 0);
    arena_destroy(&arena);
}

/* Nothing is known of 1/0 - 1/0: pieces are as long as there are. */
static void unknown_is_unlimited(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    const Interval all[3] = {{-1, 1, false}, {-1, 1, false}, {-1, 1, false}};
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef x = tape_input(b, 0), zero = tape_binary(b, TAPE_SUB, x, x, (Span){0});
    TapeRef f = tape_unary(b, TAPE_LN, tape_binary(b, TAPE_SUB, zero, tape_unary(b, TAPE_ABS, x, (Span){0}), (Span){0}), (Span){0});
    TapeSum sum = tape_sum_of(tape_finish(b, &f, 1), all, &arena);
    int at = 7;
    assert_true(tape_reach_length(&sum.reach, 0.001, &at) == sum.reach.length[0]);
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_reach_by_their_slope),
        cmocka_unit_test(lengths_grow),
        cmocka_unit_test(unknown_is_unlimited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
