/* Building tapes: folding, sharing, dead code, printing, inlining, size. */
#include "tape/tape.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const Span here = {1, 10, 20};

static Arena arena;

static int set_up(void **state) {
    (void)state;
    arena_init(&arena, NULL, 0);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    arena_destroy(&arena);
    return 0;
}

static void expect_print(const Tape *tape, const char *text) {
    StrBuf out = {0};
    tape_print(tape, &out);
    assert_string_equal(out.data, text);
    strbuf_free(&out);
}

static double eval1(const Tape *tape, double x) {
    double y;
    tape_eval_once(tape, &x, &y);
    return y;
}

static void prints_one_instruction_a_line(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 2);
    TapeRef x = tape_input(b, 0), y = tape_input(b, 1), two = tape_constant(b, 2);
    TapeRef sine = tape_unary(b, TAPE_SIN, x, here), product = tape_binary(b, TAPE_MUL, two, y, here);
    TapeRef sum = tape_binary(b, TAPE_ADD, sine, product, here);
    const Tape *tape = tape_finish(b, (TapeRef[]){sum, x}, 2);
    expect_print(tape,
                 "%0 = input 0\n%1 = input 1\n%2 = constant 2\n%3 = sin %0\n%4 = mul %1 %2\n%5 = add %3 %4\n"
                 "return %5 %0\n");
    assert_int_equal(tape_instruction_span(tape, 3).begin, 10);
    assert_int_equal(tape_input_count(tape), 2);
    assert_int_equal(tape_output_count(tape), 2);
}

static void folds_constants_as_run_time_would(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 1);
    double value;
    TapeRef third = tape_binary(b, TAPE_DIV, tape_constant(b, 1), tape_constant(b, 3), here);
    assert_true(tape_is_constant(b, third, &value));
    assert_true(value == 1.0 / 3.0);
    TapeRef nothing = tape_unary(b, TAPE_SQRT, tape_constant(b, -1), here);
    assert_true(tape_is_constant(b, nothing, &value));
    assert_true(isnan(value));
    assert_int_equal(nothing, tape_binary(b, TAPE_DIV, tape_constant(b, 0), tape_constant(b, 0), here));
    TapeRef pole = tape_binary(b, TAPE_DIV, tape_constant(b, -1), tape_constant(b, 0), here);
    assert_true(tape_is_constant(b, pole, &value));
    assert_true(isinf(value) && value < 0);
    assert_false(tape_is_constant(b, tape_input(b, 0), &value));
}

static void keeps_the_two_zeros_apart(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef plus = tape_constant(b, 0.0), minus = tape_constant(b, -0.0), x = tape_input(b, 0);
    assert_int_not_equal(plus, minus);
    TapeRef outputs[2] = {tape_binary(b, TAPE_DIV, x, plus, here), tape_binary(b, TAPE_DIV, x, minus, here)};
    double out[2], one = 1;
    tape_eval_once(tape_finish(b, outputs, 2), &one, out);
    assert_true(out[0] > 0 && out[1] < 0);
}

static void simplifies_only_without_changing_bits(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0), zero = tape_constant(b, 0), one = tape_constant(b, 1);
    assert_int_equal(tape_binary(b, TAPE_MUL, x, one, here), x);
    assert_int_equal(tape_binary(b, TAPE_MUL, one, x, here), x);
    assert_int_equal(tape_binary(b, TAPE_DIV, x, one, here), x);
    assert_int_equal(tape_binary(b, TAPE_SUB, x, zero, here), x);
    assert_int_equal(tape_unary(b, TAPE_NEG, tape_unary(b, TAPE_NEG, x, here), here), x);
    /* -0 + 0 is +0, and NaN times 0 is NaN: these must stay */
    TapeRef sum = tape_binary(b, TAPE_ADD, x, zero, here), product = tape_binary(b, TAPE_MUL, x, zero, here);
    const Tape *tape = tape_finish(b, (TapeRef[]){sum, product}, 2);
    double out[2], minus = -0.0;
    tape_eval_once(tape, &minus, out);
    assert_false(signbit(out[0]));
    assert_true(signbit(out[1]));
}

static void shares_equal_instructions(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 2);
    TapeRef x = tape_input(b, 0), y = tape_input(b, 1);
    assert_int_equal(tape_binary(b, TAPE_ADD, x, y, here), tape_binary(b, TAPE_ADD, y, x, here));
    assert_int_equal(tape_binary(b, TAPE_MIN, x, y, here), tape_binary(b, TAPE_MIN, x, y, here));
    assert_int_not_equal(tape_binary(b, TAPE_MIN, x, y, here), tape_binary(b, TAPE_MIN, y, x, here));
    assert_int_not_equal(tape_binary(b, TAPE_SUB, x, y, here), tape_binary(b, TAPE_SUB, y, x, here));
    assert_int_equal(tape_constant(b, 0.1), tape_constant(b, 0.1));
}

static void drops_what_no_output_needs(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 2);
    TapeRef x = tape_input(b, 0), unused = tape_input(b, 1);
    for (int i = 0; i < 10; i++) unused = tape_unary(b, TAPE_EXP, unused, here);
    TapeRef y = tape_unary(b, TAPE_COS, x, here);
    const Tape *tape = tape_finish(b, &y, 1);
    expect_print(tape, "%0 = input 0\n%1 = cos %0\nreturn %1\n");
    double in[2] = {0.5, 7}, out;
    tape_eval_once(tape, in, &out);
    assert_true(out == cos(0.5));
}

static const Tape *make_square_plus(double constant) {
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0);
    TapeRef y =
        tape_binary(b, TAPE_ADD, tape_binary(b, TAPE_MUL, x, x, here), tape_constant(b, constant), here);
    return tape_finish(b, &y, 1);
}

static void equal_tapes_have_equal_hashes(void **state) {
    (void)state;
    assert_true(hash_equal(tape_hash(make_square_plus(1)), tape_hash(make_square_plus(1))));
    assert_false(hash_equal(tape_hash(make_square_plus(1)), tape_hash(make_square_plus(2))));
}

static void inlines_and_folds(void **state) {
    (void)state;
    const Tape *callee = make_square_plus(1);
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0), once, twice, folded, three = tape_constant(b, 3);
    double value;
    tape_inline(b, callee, &x, &once);
    tape_inline(b, callee, &once, &twice);
    tape_inline(b, callee, &three, &folded);
    assert_true(tape_is_constant(b, folded, &value));
    assert_true(value == 10);
    assert_true(eval1(tape_finish(b, &twice, 1), 2) == 26);
}

static void swap_and_scale(const void *data, const double *in, double *out) {
    out[0] = in[1] * *(const double *)data;
    out[1] = in[0];
}

static const double five = 5;
static const TapeExternal swapper = {"swapper", 2, 2, swap_and_scale, &five, {1, 2}, 0, 0, NULL, NULL, NULL, NULL};

static void calls_externals(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 2);
    TapeRef in[2] = {tape_input(b, 0), tape_input(b, 1)}, out[2], again[2], constants[2], folded[2];
    tape_call(b, &swapper, in, out, here);
    tape_call(b, &swapper, in, again, here);
    assert_int_equal(out[0], again[0]);
    constants[0] = tape_constant(b, 1), constants[1] = tape_constant(b, 2);
    tape_call(b, &swapper, constants, folded, here);
    double value;
    assert_true(tape_is_constant(b, folded[0], &value) && value == 10);
    const Tape *callee = tape_finish(b, (TapeRef[]){out[1], out[0], folded[1]}, 3);
    /* through an inlined copy, with one result unused */
    TapeBuilder *outer = tape_builder_create(&arena, 1);
    TapeRef args[2] = {tape_input(outer, 0), tape_constant(outer, 4)}, results[3];
    tape_inline(outer, callee, args, results);
    const Tape *tape = tape_finish(outer, &results[1], 1);
    expect_print(tape,
                 "%0 = input 0\n%1 = constant 4\n%2 = call swapper %0 %1\n%3 = result %2 0\nreturn %3\n");
    assert_true(eval1(tape, 3) == 20);
}

/* Σ or Π of (captured + i)·i */
static const Tape *make_loop(bool product) {
    TapeBuilder *body = tape_builder_create(&arena, 2), *b = tape_builder_create(&arena, 3);
    TapeRef i = tape_input(body, 1);
    TapeRef term =
        tape_binary(body, TAPE_MUL, tape_binary(body, TAPE_ADD, tape_input(body, 0), i, here), i, here);
    TapeRef captured = tape_input(b, 2);
    TapeRef loop = tape_loop(b, product, tape_input(b, 0), tape_input(b, 1), tape_finish(body, &term, 1),
                             &captured, 1, here);
    return tape_finish(b, &loop, 1);
}

static void loops_as_povray_does(void **state) {
    (void)state;
    static const double cases[][5] = {/* from, to, captured, sum, product */
                                      {1, 3, 0, 14, 36},
                                      {1.5, 3, 0, 8.5, 14.0625},
                                      {3, 1, 5, 0, 1},
                                      {1, 3.5, 0, 14, 36},
                                      {2, 2, 10, 24, 24},
                                      {0, 3e8, 0, (double)NAN, (double)NAN},
                                      {0, (double)INFINITY, 0, (double)NAN, (double)NAN},
                                      {(double)NAN, 1, 0, (double)NAN, (double)NAN}};
    const Tape *sum = make_loop(false), *product = make_loop(true);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(cases); k++) {
        double s, p;
        tape_eval_once(sum, cases[k], &s);
        tape_eval_once(product, cases[k], &p);
        assert_true(s == cases[k][3] || (isnan(s) && isnan(cases[k][3])));
        assert_true(p == cases[k][4] || (isnan(p) && isnan(cases[k][4])));
        /* folded */
        TapeBuilder *b = tape_builder_create(&arena, 0);
        TapeRef in[3], out;
        for (int j = 0; j < 3; j++) in[j] = tape_constant(b, cases[k][j]);
        tape_inline(b, sum, in, &out);
        double value;
        if (tape_is_constant(b, out, &value)) assert_true(value == s || (isnan(value) && isnan(s)));
    }
}

static void ends_loops_where_adding_one_changes_nothing(void **state) {
    (void)state;
    const double in[3] = {0x1p60, 0x1p60, 0};
    double out;
    tape_eval_once(make_loop(false), in, &out);
    assert_true(out == 0x1p120);
}

static void nests_loops(void **state) {
    (void)state;
    /* Σ_{i=1..n} Σ_{j=1..i} i·j */
    TapeBuilder *inner = tape_builder_create(&arena, 2), *outer = tape_builder_create(&arena, 1),
                *b = tape_builder_create(&arena, 1);
    TapeRef term = tape_binary(inner, TAPE_MUL, tape_input(inner, 0), tape_input(inner, 1), here),
            i = tape_input(outer, 0);
    TapeRef row =
        tape_loop(outer, false, tape_constant(outer, 1), i, tape_finish(inner, &term, 1), &i, 1, here);
    TapeRef all = tape_loop(b, false, tape_constant(b, 1), tape_input(b, 0), tape_finish(outer, &row, 1),
                            NULL, 0, here);
    const Tape *tape = tape_finish(b, &all, 1);
    double expected = 0;
    for (int p = 1; p <= 7; p++)
        for (int q = 1; q <= p; q++) expected += p * q;
    assert_true(eval1(tape, 7) == expected);
    double ns[5] = {7, 1, 0, 3, 7}, sums[5];
    tape_eval_batch(tape, 5, (const double *[]){ns}, (double *[]){sums});
    for (int k = 0; k < 5; k++) assert_true(sums[k] == eval1(tape, ns[k]));
}

static void huge_tapes_need_little_scratch(void **state) {
    (void)state;
    enum { COUNT = 300000 };
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0), y = x;
    for (int k = 0; k < COUNT; k++) y = tape_binary(b, TAPE_ADD, tape_unary(b, TAPE_NEG, y, here), x, here);
    const Tape *tape = tape_finish(b, &y, 1);
    assert_true(tape_instruction_count(tape) == 2 * COUNT + 1);
    assert_true(tape_scratch_size(tape) <= 4);
    assert_true(eval1(tape, 3) == 3); /* x - (x - (x - …)) */
    TapeBuilder *copy = tape_builder_create(&arena, 1);
    TapeRef in = tape_input(copy, 0), out;
    tape_inline(copy, tape, &in, &out);
    assert_true(hash_equal(tape_hash(tape), tape_hash(tape_finish(copy, &out, 1))));
}

static void outputs_may_be_inputs_constants_and_twice_the_same(void **state) {
    (void)state;
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0), y = tape_unary(b, TAPE_FLOOR, x, here), c = tape_constant(b, 8);
    double in = 2.5, out[5];
    tape_eval_once(tape_finish(b, (TapeRef[]){x, c, y, y, x}, 5), &in, out);
    static const double expected[5] = {2.5, 8, 2, 2, 2.5};
    assert_memory_equal(out, expected, sizeof out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(prints_one_instruction_a_line, set_up, tear_down),
        cmocka_unit_test_setup_teardown(folds_constants_as_run_time_would, set_up, tear_down),
        cmocka_unit_test_setup_teardown(keeps_the_two_zeros_apart, set_up, tear_down),
        cmocka_unit_test_setup_teardown(simplifies_only_without_changing_bits, set_up, tear_down),
        cmocka_unit_test_setup_teardown(shares_equal_instructions, set_up, tear_down),
        cmocka_unit_test_setup_teardown(drops_what_no_output_needs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(equal_tapes_have_equal_hashes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(inlines_and_folds, set_up, tear_down),
        cmocka_unit_test_setup_teardown(calls_externals, set_up, tear_down),
        cmocka_unit_test_setup_teardown(loops_as_povray_does, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ends_loops_where_adding_one_changes_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nests_loops, set_up, tear_down),
        cmocka_unit_test_setup_teardown(huge_tapes_need_little_scratch, set_up, tear_down),
        cmocka_unit_test_setup_teardown(outputs_may_be_inputs_constants_and_twice_the_same, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
