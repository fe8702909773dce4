/* The internal functions against POV-Ray's own values, and against arguments that nobody means. */
#include "base/random.h"
#include "tape/internal_tape.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

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

static void give_povrays_values(void **state) {
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(expectations); i++) {
        const Expectation *e = &expectations[i];
        const InternalFunction *f = find_name(e->name);
        assert_non_null(f);
        double value = f->eval(e->arguments);
        if (fabs(value - e->value) <= 1e-9 * fmax(1, fabs(e->value))) continue;
        print_error("line %zu: %s gives %.15g, POV-Ray %.15g\n", i + 2, e->name, value, e->value);
        wrong++;
    }
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
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(spicy); k++) {
            double p[INTERNAL_INPUTS];
            for (size_t a = 0; a < INTERNAL_INPUTS; a++)
                p[a] = spicy[(k + a * (k % 3)) % VTS_ARRAY_COUNT(spicy)];
            double value = all[i].eval(p);
            assert_true(value == value || isnan(value));
        }
}

/* ---- those that are operations of tapes ---- */

static const Tape *operations(Arena *arena, const InternalFunction *f) {
    TapeBuilder *b = tape_builder_create(arena, f->inputs);
    TapeRef in[INTERNAL_INPUTS], out;
    for (int k = 0; k < f->inputs; k++) in[k] = tape_input(b, k);
    return internal_tape(b, f, in, &out, (Span){1, 0, 1}) ? tape_finish(b, &out, 1) : NULL;
}

static void check_operations(const Tape *tape, const InternalFunction *f) {
    static const double spicy[] = {0, -0.0, 1, -1, 1e-300, 1e300, VTS_INFINITY, (double)NAN};
    RandomStream random = {5};
    for (int i = 0; i < 20000; i++) {
        double p[INTERNAL_INPUTS], value, expected;
        for (int k = 0; k < f->inputs; k++)
            p[k] = random_next(&random) % 8 ? 4 * random_next_unit(&random) - 2
                                            : spicy[random_next(&random) % VTS_ARRAY_COUNT(spicy)];
        tape_eval_once(tape, p, &value);
        expected = f->eval(p);
        assert_true(isnan(expected) ? isnan(value) : memcmp(&value, &expected, sizeof value) == 0);
    }
}

static void operations_give_the_same_bits(void **state) {
    (void)state;
    size_t count, written = 0;
    const InternalFunction *all = internal_all(&count);
    Arena arena;
    arena_init(&arena, NULL, 0);
    for (size_t i = 0; i < count; i++) {
        const Tape *tape = operations(&arena, &all[i]);
        if (tape) check_operations(tape, &all[i]), written++;
    }
    assert_int_equal(written, 5);
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(give_povrays_values), cmocka_unit_test(each_is_tested),
        cmocka_unit_test(survive_absurd_arguments), cmocka_unit_test(operations_give_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
