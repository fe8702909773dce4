/* The internal functions against POV-Ray's own values, and against arguments that nobody means. */
#include "base/random.h"
#include "tape/affine.h"
#include "tape/internal.h"
#include "tape/tape_affine.h"
#include "tape/tape_interval.h"
#include "tape/tape_lanes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int spans = 60; /* of each function with each set of parameters */

typedef struct Expectation {
    const char *name;
    double arguments[INTERNAL_INPUTS];
    double value;
} Expectation;

static const Expectation expectations[] = {
#include "pov_internals.inc"
};

static const InternalFunction *find_name(const char *name) {
    size_t count;
    const InternalFunction *all = internal_all(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].name, name) == 0) return &all[i];
    return NULL;
}

/* With the first `inputs` of its inputs free and constants for the rest; NULL: it needs an external then. */
static const Tape *operations(Arena *arena, const InternalFunction *f, int inputs, const double *arguments) {
    TapeBuilder *b = tape_builder_create(arena, inputs);
    TapeRef in[INTERNAL_INPUTS], out;
    for (int k = 0; k < f->inputs; k++) in[k] = k < inputs ? tape_input(b, k) : tape_constant(b, arguments[k]);
    return internal_append(b, f, in, (Span){1, 0, 1}, &out) ? tape_finish(b, &out, 1) : NULL;
}

static double value_of(Arena *arena, const InternalFunction *f, const double *arguments) {
    double value;
    if (!f->formula) return f->eval(arguments);
    const Tape *tape = operations(arena, f, f->inputs, arguments);
    assert_non_null(tape);
    tape_eval_once(tape, arguments, &value);
    return value;
}

static bool near(double value, double expected, double off) {
    return fabs(value - expected) <= off * fmax(1, fabs(expected)) || (isnan(value) && isnan(expected));
}

static void give_povrays_values(void **state) {
    (void)state;
    int wrong = 0;
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(expectations); i++) {
        const Expectation *e = &expectations[i];
        const InternalFunction *f = find_name(e->name);
        assert_non_null(f);
        double value = value_of(&arena, f, e->arguments);
        if (near(value, e->value, 1e-9)) continue;
        print_error("line %zu: %s gives %.15g, POV-Ray %.15g\n", i + 2, e->name, value, e->value);
        wrong++;
    }
    arena_destroy(&arena);
    assert_int_equal(wrong, 0);
}

static void each_is_tested(void **state) {
    (void)state;
    size_t count;
    const InternalFunction *all = internal_all(&count);
    assert_int_equal(count, 78);
    for (size_t i = 0; i < count; i++) {
        bool found = false;
        for (size_t k = 0; k < VTS_ARRAY_COUNT(expectations); k++)
            found |= strcmp(expectations[k].name, all[i].name) == 0;
        assert_true(found);
        assert_ptr_equal(internal_find(all[i].number), &all[i]);
        assert_true(all[i].inputs >= 3 && all[i].inputs <= INTERNAL_INPUTS);
    }
    assert_null(internal_find(77)); /* is function { pattern } */
    assert_null(internal_find(-1));
}

/* Nothing to compare: they come back, and soon. */
static void survive_absurd_arguments(void **state) {
    (void)state;
    static const double spicy[] = {
        0, -0.0, 1, -1, 1e-300, 1e300, -1e300, 4.5, VTS_INFINITY, -VTS_INFINITY, (double)NAN};
    size_t count;
    const InternalFunction *all = internal_all(&count);
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(spicy); k++) {
            double p[INTERNAL_INPUTS];
            for (size_t a = 0; a < INTERNAL_INPUTS; a++)
                p[a] = spicy[(k + a * (k % 3)) % VTS_ARRAY_COUNT(spicy)];
            double value = value_of(&arena, &all[i], p);
            assert_true(value == value || isnan(value));
            operations(&arena, &all[i], 3, p);
        }
    arena_destroy(&arena);
}

/* ---- with their parameters constant ---- */

static void check_operations(const Tape *tape, const InternalFunction *f, const double *arguments) {
    static const double spicy[] = {0, -0.0, 1, -1, 1e-300, 1e300, VTS_INFINITY, (double)NAN};
    RandomStream random = {5};
    double p[INTERNAL_INPUTS], value;
    memcpy(p, arguments, sizeof p);
    for (int i = 0; i < 2000; i++) {
        for (int k = 0; k < 3; k++)
            p[k] = random_next(&random) % 8 ? 4 * random_next_unit(&random) - 2 : spicy[random_next(&random) % VTS_ARRAY_COUNT(spicy)];
        tape_eval_once(tape, p, &value);
        if (!near(value, f->eval(p), 1e-12)) print_error("%s(%a, %a, %a) = %.17g, as operations %.17g\n", f->name, p[0], p[1], p[2], f->eval(p), value);
        assert_true(near(value, f->eval(p), 1e-12));
    }
}

static void repetitions_are_operations(void **state) {
    (void)state;
    size_t checked = 0;
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(expectations); i++) {
        const Expectation *e = &expectations[i];
        const InternalFunction *f = find_name(e->name);
        if (f->formula) continue;
        const Tape *tape = operations(&arena, f, 3, e->arguments);
        if (tape) check_operations(tape, f, e->arguments), checked++;
    }
    /* All but those with the third noise generator. */
    assert_true(checked >= 15);
    arena_destroy(&arena);
}

typedef struct Scratch {
    AffineForm forms[256];
    AffineLanes lanes[256];
    Interval intervals[256];
} Scratch;

static bool holds(AffineForm form, double s, double value) {
    return isnan(value) ? form.nan : fabs(value - (form.centre + form.slope * s)) <= form.error * (1 + 0x1p-40) || form.error == HUGE_VAL;
}

/* Random pieces of lines, short and long, some of them along the axes, where several functions have a kink or a cut. */
static void random_piece(RandomStream *random, AffineForm in[3]) {
    double length = exp2(-20 * random_next_unit(random));
    for (int k = 0; k < 3; k++) {
        double centre = 3 * random_next_unit(random) - 1.5, slope = (2 * random_next_unit(random) - 1) * length;
        if (random_next(random) % 8 == 0) centre = 0;
        if (random_next(random) % 8 == 0) slope = 0;
        in[k] = (AffineForm){centre, slope, affine_lane_error(0, fabs(centre) + fabs(slope)), false};
    }
}

static void check_bounds(const Tape *tape, const char *name, RandomStream *random, Scratch *scratch) {
    AffineForm in[3], form;
    AffineLanes wide[3], lanes;
    Interval box[3], range;
    assert_true(tape_scratch_size(tape) <= 256);
    random_piece(random, in);
    for (int k = 0; k < 3; k++) {
        box[k] = affine_range(in[k]);
        for (int l = 0; l < AFFINE_LANES; l++) affine_set_lane(&wide[k], l, in[k]);
    }
    tape_eval_affine(tape, in, &form, scratch->forms);
    tape_eval_lanes(tape, wide, &lanes, scratch->lanes);
    tape_eval_interval(tape, box, &range, scratch->intervals);
    for (int i = 0; i < 8; i++) {
        double s = i < 2 ? 2 * i - 1 : 2 * random_next_unit(random) - 1, value;
        const double at[3] = {in[0].centre + s * in[0].slope, in[1].centre + s * in[1].slope, in[2].centre + s * in[2].slope};
        tape_eval_once(tape, at, &value);
        bool held = holds(form, s, value) && holds(affine_lane(&lanes, i), s, value);
        held &= isnan(value) ? range.nan : range.low <= value && value <= range.high;
        if (!held) print_error("%s(%a, %a, %a) = %.17g\n", name, at[0], at[1], at[2], value);
        assert_true(held);
    }
}

static void bounds_hold_values(void **state) {
    (void)state;
    size_t count, bounded = 0;
    const InternalFunction *all = internal_all(&count);
    RandomStream random = {7};
    Scratch *scratch = calloc(1, sizeof *scratch);
    Arena arena;
    arena_init(&arena, NULL, 0);
    assert_non_null(scratch);
    for (size_t i = 0; i < count; i++) {
        bool own = false;
        for (size_t k = 0; k < VTS_ARRAY_COUNT(expectations); k++) {
            if (strcmp(expectations[k].name, all[i].name) != 0) continue;
            const Tape *tape = operations(&arena, &all[i], 3, expectations[k].arguments);
            if (!tape) continue;
            own = true;
            for (int n = 0; n < spans; n++) check_bounds(tape, all[i].name, &random, scratch);
        }
        bounded += own;
    }
    assert_int_equal(bounded, count);
    arena_destroy(&arena);
    free(scratch);
}

int main(void) {
    const char *more = getenv("VTS_SPANS");
    if (more) spans = atoi(more);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(give_povrays_values), cmocka_unit_test(each_is_tested),
        cmocka_unit_test(survive_absurd_arguments), cmocka_unit_test(repetitions_are_operations), cmocka_unit_test(bounds_hold_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
