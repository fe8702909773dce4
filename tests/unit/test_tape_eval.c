/* Evaluation: each operation against C's own functions (or elementary.h, which test_tape_elementary.c tests); random tapes against an independent evaluator; batch = scalar. */
#include "base/random.h"
#include "tape/elementary.h"
#include "tape/noise.h"
#include "tape/tape.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const Span here = {1, 0, 1};

static bool same(double a, double b) { return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0; }

/* Values that break careless code. */
static const double spicy[] = {0.0,    -0.0,          1,     -1,       0.5,    -0.5,       2,     3,
                               -7.5,   1e-300,        1e300, 5e-324,   VTS_PI, VTS_PI / 2, 1e-11, 0x1p53,
                               0x1p63, -0x1p63 * 1.5, 255,   1 + 1e-11};

static double spicy_value(size_t k) {
    if (k < VTS_ARRAY_COUNT(spicy)) return spicy[k];
    return k == VTS_ARRAY_COUNT(spicy) ? (double)NAN : k & 1 ? (double)INFINITY : -(double)INFINITY;
}
enum { SPICY_COUNT = VTS_ARRAY_COUNT(spicy) + 3 };

/* What each operation means, written down once more. */
static double bits(double a, double b, int which) {
    if (!(a > -0x1p63 && a < 0x1p63 && b > -0x1p63 && b < 0x1p63)) return (double)NAN;
    int64_t i = (int64_t)a, j = (int64_t)b;
    return (double)(which == 0 ? i & j : which == 1 ? i | j : i ^ j);
}

static double reference(TapeOp op, double a, double b, double c) {
    switch (op) {
    case TAPE_ADD: return a + b;
    case TAPE_SUB: return a - b;
    case TAPE_MUL: return a * b;
    case TAPE_DIV: return a / b;
    case TAPE_NEG: return -a;
    case TAPE_SQR: return a * a;
    case TAPE_ABS: return a < 0 || signbit(a) ? -a : a;
    case TAPE_MIN: return a < b ? a : b;
    case TAPE_MAX: return a > b ? a : b;
    case TAPE_LT: return a < b;
    case TAPE_LE: return a <= b;
    case TAPE_GT: return a > b;
    case TAPE_GE: return a >= b;
    case TAPE_EQ: return a == b;
    case TAPE_NE: return a != b;
    case TAPE_AND: return !(a == 0) && !(b == 0);
    case TAPE_OR: return !(a == 0) || !(b == 0);
    case TAPE_SELECT: return a < 0 ? b : c;
    case TAPE_FLOOR: return floor(a);
    case TAPE_CEIL: return -floor(-a);
    case TAPE_INT: return signbit(a) ? -floor(-a) : floor(a);
    case TAPE_IDIV: return trunc(a / b);
    case TAPE_MOD: return fmod(a, b);
    case TAPE_FOLD: return fabs(fmod(fabs(a), b) - fabs(b) / 2);
    case TAPE_BITWISE_AND: return bits(a, b, 0);
    case TAPE_BITWISE_OR: return bits(a, b, 1);
    case TAPE_BITWISE_XOR: return bits(a, b, 2);
    case TAPE_SQRT: return sqrt(a);
    case TAPE_EXP: return elementary_exp(a);
    case TAPE_LN: return elementary_ln(a);
    case TAPE_LOG: return log10(a);
    case TAPE_POW: return pow(a, b);
    case TAPE_SIN: return elementary_sin(a);
    case TAPE_COS: return elementary_cos(a);
    case TAPE_TAN: return elementary_tan(a);
    case TAPE_ASIN: return asin(a);
    case TAPE_ACOS: return acos(a);
    case TAPE_ATAN: return elementary_atan(a);
    case TAPE_ATAN2: return elementary_atan2(a, b);
    case TAPE_SINH: return sinh(a);
    case TAPE_COSH: return cosh(a);
    case TAPE_TANH: return tanh(a);
    case TAPE_ASINH: return asinh(a);
    case TAPE_ACOSH: return acosh(a);
    case TAPE_ATANH: return atanh(a);
    case TAPE_DEGREES: return a * (180.0 / VTS_PI);
    case TAPE_RADIANS: return a * (VTS_PI / 180.0);
    case TAPE_PERLIN: return noise_perlin(vec3(a, b, c));
    case TAPE_POV_NOISE: return noise_pov(vec3(a, b, c));
    default: fail_msg("no reference for %s", tape_op_text(op));
    }
    return 0;
}

static TapeRef add_op(TapeBuilder *b, TapeOp op, const TapeRef *args) {
    switch (tape_op_arity(op)) {
    case 1: return tape_unary(b, op, args[0], here);
    case 2: return tape_binary(b, op, args[0], args[1], here);
    default: return tape_ternary(b, op, args[0], args[1], args[2], here);
    }
}

static const Tape *tape_of_op(Arena *arena, TapeOp op) {
    TapeBuilder *b = tape_builder_create(arena, 3);
    TapeRef args[3] = {tape_input(b, 0), tape_input(b, 1), tape_input(b, 2)};
    TapeRef out = add_op(b, op, args);
    return tape_finish(b, &out, 1);
}

static double folded(Arena *arena, TapeOp op, const double *in) {
    TapeBuilder *b = tape_builder_create(arena, 0);
    TapeRef args[3];
    for (int k = 0; k < 3; k++) args[k] = tape_constant(b, in[k]);
    double value = 0;
    assert_true(tape_is_constant(b, add_op(b, op, args), &value));
    return value;
}

static void check_op(TapeOp op, const Tape *tape, const double *in) {
    Arena arena;
    double out, expected = reference(op, in[0], in[1], in[2]), scratch[16];
    arena_init(&arena, NULL, 0);
    tape_eval(tape, in, &out, scratch);
    if (!same(out, expected) || !same(folded(&arena, op, in), expected))
        fail_msg("%s(%g, %g, %g) = %.17g, expected %.17g", tape_op_text(op), in[0], in[1], in[2], out,
                 expected);
    arena_destroy(&arena);
}

static void each_operation_is_what_it_says(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    RandomStream random = {1};
    for (int op = 0; op < TAPE_OP_COUNT; op++) {
        if (tape_op_arity((TapeOp)op) == 0) continue;
        const Tape *tape = tape_of_op(&arena, (TapeOp)op);
        assert_true(tape_scratch_size(tape) <= 16);
        for (size_t i = 0; i < SPICY_COUNT * SPICY_COUNT; i++)
            check_op((TapeOp)op, tape,
                     (double[3]){spicy_value(i % SPICY_COUNT), spicy_value(i / SPICY_COUNT), 0.25});
        for (int k = 0; k < 100; k++) {
            double in[3];
            for (int j = 0; j < 3; j++) in[j] = 20 * random_next_unit(&random) - 10;
            check_op((TapeOp)op, tape, in);
        }
    }
    arena_destroy(&arena);
}

/* ---- random tapes ---- */

enum { INPUTS = 4, LENGTH = 200, OUTPUTS = 3, POINTS = 150 };

typedef struct Program {
    struct {
        TapeOp op;
        int args[3];
        double constant;
    } lines[LENGTH];
    int outputs[OUTPUTS];
} Program;

static TapeOp random_op(RandomStream *random) {
    for (;;) {
        TapeOp op = (TapeOp)(random_next(random) % TAPE_OP_COUNT);
        if (op == TAPE_INPUT || op == TAPE_CONSTANT || tape_op_arity(op) > 0) return op;
    }
}

static void random_program(Program *program, RandomStream *random) {
    for (int i = 0; i < LENGTH; i++) {
        program->lines[i].op = i < INPUTS ? TAPE_INPUT : random_op(random);
        for (int k = 0; k < 3; k++)
            program->lines[i].args[k] =
                i ? (int)(random_next(random) % (uint64_t)int_min(i, i < 30 ? i : 30)) : 0;
        if (i >= 30) /* mostly recent values, sometimes old ones */
            for (int k = 0; k < 2; k++) program->lines[i].args[k] = i - 1 - program->lines[i].args[k];
        program->lines[i].constant = random_next(random) & 1 ? spicy_value(random_next(random) % SPICY_COUNT)
                                                             : 8 * random_next_unit(random) - 4;
    }
    for (int k = 0; k < OUTPUTS; k++) program->outputs[k] = LENGTH - 1 - (int)(random_next(random) % 40);
}

static const Tape *build(Arena *arena, const Program *program) {
    TapeBuilder *b = tape_builder_create(arena, INPUTS);
    TapeRef refs[LENGTH], outputs[OUTPUTS];
    for (int i = 0; i < LENGTH; i++) {
        const int *args = program->lines[i].args;
        TapeOp op = program->lines[i].op;
        if (op == TAPE_INPUT)
            refs[i] = tape_input(b, i % INPUTS);
        else if (op == TAPE_CONSTANT)
            refs[i] = tape_constant(b, program->lines[i].constant);
        else
            refs[i] = add_op(b, op, (TapeRef[]){refs[args[0]], refs[args[1]], refs[args[2]]});
    }
    for (int k = 0; k < OUTPUTS; k++) outputs[k] = refs[program->outputs[k]];
    return tape_finish(b, outputs, OUTPUTS);
}

static void run_reference(const Program *program, const double *in, double *out) {
    double values[LENGTH];
    for (int i = 0; i < LENGTH; i++) {
        const int *args = program->lines[i].args;
        TapeOp op = program->lines[i].op;
        values[i] = op == TAPE_INPUT      ? in[i % INPUTS]
                    : op == TAPE_CONSTANT ? program->lines[i].constant
                                          : reference(op, values[args[0]], values[args[1]], values[args[2]]);
    }
    for (int k = 0; k < OUTPUTS; k++) out[k] = values[program->outputs[k]];
}

static void check_program(Arena *arena, const Program *program, RandomStream *random) {
    static double in[INPUTS][POINTS], out[OUTPUTS][POINTS];
    const Tape *tape = build(arena, program);
    for (int p = 0; p < POINTS; p++)
        for (int k = 0; k < INPUTS; k++)
            in[k][p] =
                p % 3 ? 10 * random_next_unit(random) - 5 : spicy_value(random_next(random) % SPICY_COUNT);
    tape_eval_batch(tape, POINTS, (const double *[]){in[0], in[1], in[2], in[3]},
                    (double *[]){out[0], out[1], out[2]});
    for (int p = 0; p < POINTS; p++) {
        double point[INPUTS], scalar[OUTPUTS], expected[OUTPUTS];
        for (int k = 0; k < INPUTS; k++) point[k] = in[k][p];
        tape_eval_once(tape, point, scalar);
        run_reference(program, point, expected);
        for (int k = 0; k < OUTPUTS; k++) {
            assert_true(same(scalar[k], expected[k]));
            assert_true(same(out[k][p], scalar[k]));
        }
    }
}

static void random_tapes_agree_with_the_reference_and_batches(void **state) {
    (void)state;
    RandomStream random = {42};
    for (int k = 0; k < 300; k++) {
        Arena arena;
        Program program;
        arena_init(&arena, NULL, 0);
        random_program(&program, &random);
        check_program(&arena, &program, &random);
        arena_destroy(&arena);
    }
}

/* ---- batches ---- */

static void sum_and_product(const void *data, const double *in, double *out) {
    (void)data;
    out[0] = in[0] + in[1];
    out[1] = in[0] * in[1];
}

static const TapeExternal external = {"sum_and_product", 2, 2, sum_and_product, NULL, {7, 7}, 0, 0, NULL, NULL, NULL, NULL};

/* x, y → Σ_{i=x..y} i·x·y, through an external */
static const Tape *tape_with_everything(Arena *arena) {
    TapeBuilder *body = tape_builder_create(arena, 2), *b = tape_builder_create(arena, 2);
    TapeRef term = tape_binary(body, TAPE_MUL, tape_input(body, 0), tape_input(body, 1), here);
    TapeRef in[2] = {tape_input(b, 0), tape_input(b, 1)}, results[2];
    tape_call(b, &external, in, results, here);
    TapeRef loop = tape_loop(b, false, in[0], in[1], tape_finish(body, &term, 1), &results[1], 1, here);
    TapeRef product = tape_loop(b, true, in[0], results[0], tape_finish(body, &term, 1), &in[1], 1, here);
    return tape_finish(b, (TapeRef[]){loop, results[0], product}, 3);
}

static void batches_of_any_size_agree(void **state) {
    (void)state;
    enum { MOST = 200 };
    double x[MOST], y[MOST], out[3][MOST];
    Arena arena;
    arena_init(&arena, NULL, 0);
    const Tape *tape = tape_with_everything(&arena);
    RandomStream random = {3};
    for (size_t n = 0; n <= MOST; n += n < 70 ? 1 : 43) {
        for (size_t l = 0; l < n; l++) {
            x[l] = l % 7 == 6 ? spicy_value(l % SPICY_COUNT) : 4 * random_next_unit(&random);
            y[l] = l % 11 == 6 ? spicy_value(l % SPICY_COUNT) : 12 * random_next_unit(&random);
            if (y[l] - x[l] > 1e6 && y[l] - x[l] < TAPE_LOOP_LIMIT) y[l] = x[l];
        }
        tape_eval_batch(tape, n, (const double *[]){x, y}, (double *[]){out[0], out[1], out[2]});
        for (size_t l = 0; l < n; l++) {
            double scalar[3];
            tape_eval_once(tape, (double[]){x[l], y[l]}, scalar);
            for (int k = 0; k < 3; k++) assert_true(same(out[k][l], scalar[k]));
        }
    }
    arena_destroy(&arena);
}

static void wide_tapes_need_and_get_much_scratch(void **state) {
    (void)state;
    enum { WIDTH = 1000 };
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 1);
    TapeRef x = tape_input(b, 0), squares[WIDTH], sum = tape_constant(b, 0);
    for (int k = 0; k < WIDTH; k++)
        squares[k] = tape_unary(b, TAPE_SQR, tape_binary(b, TAPE_ADD, x, tape_constant(b, k), here), here);
    for (int k = WIDTH; k-- > 0;) sum = tape_binary(b, TAPE_ADD, sum, squares[k], here);
    const Tape *tape = tape_finish(b, &sum, 1);
    assert_true(tape_scratch_size(tape) > WIDTH);
    double in[3] = {0, 1, -1}, out[3], expected = 0;
    for (int k = 0; k < WIDTH; k++) expected += (double)k * k;
    tape_eval_batch(tape, 3, (const double *[]){in}, (double *[]){out});
    assert_true(out[0] == expected);
    assert_true(out[1] == expected + (double)WIDTH * WIDTH);
    assert_true(out[2] == expected + 1 - (double)(WIDTH - 1) * (WIDTH - 1));
    arena_destroy(&arena);
}

/* ---- fbm ---- */

static void fbm_is_that_of_the_noise(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3), *loop = tape_builder_create(&arena, 4);
    TapeRef place[3], inner[3];
    for (int k = 0; k < 3; k++) place[k] = tape_input(b, k), inner[k] = tape_input(loop, k);
    TapeRef fixed =
        tape_fbm(b, place, tape_constant(b, 5), tape_constant(b, 2.1), tape_constant(b, 0.45), here);
    TapeRef varying =
        tape_fbm(loop, inner, tape_input(loop, 3), tape_constant(loop, 2.1), tape_constant(loop, 0.45), here);
    const Tape *unrolled = tape_finish(b, &fixed, 1), *looped = tape_finish(loop, &varying, 1);
    RandomStream random = {8};
    for (int k = 0; k < 1000; k++) {
        double p[4] = {9 * random_next_unit(&random), -7 * random_next_unit(&random),
                       random_next_unit(&random), 5},
               u, l;
        tape_eval_once(unrolled, p, &u);
        tape_eval_once(looped, p, &l);
        assert_true(same(u, noise_fbm(vec3(p[0], p[1], p[2]), 5, 2.1, 0.45)));
        assert_true(fabs(u - l) < 1e-12);
    }
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_operation_is_what_it_says),
        cmocka_unit_test(random_tapes_agree_with_the_reference_and_batches),
        cmocka_unit_test(batches_of_any_size_agree),
        cmocka_unit_test(wide_tapes_need_and_get_much_scratch),
        cmocka_unit_test(fbm_is_that_of_the_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
