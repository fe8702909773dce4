/* Standard affine forms hold what they must: each operation at random values of the symbols that its operands share, against the scalar operation;
 * errors from the same place cancel; no symbol beyond the most that are kept loses a value. */
#include "tape/standard.h"

#include "bounds_sample.h"
#include "tape/tape_affine.h"
#include "tape/tape_program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

enum { SYMBOLS = 24 };

static StandardForm some_form(uint64_t i, uint32_t k, uint32_t *next) {
    static const double scales[] = {1, 1, 1e-3, 1e-6, 1e3, 1e6, 0.1, 1e-12};
    double size = scales[bits(i, k) % 8];
    StandardForm a = {.centre = some_number(i, k + 1), .next = bits(i, k + 4) % 9 ? next : NULL};
    if (!isfinite(a.centre)) a.centre = 2;
    for (uint32_t symbol = 0; symbol < SYMBOLS && a.count < STANDARD_TERMS; symbol++)
        if (bits(i, k + 50 + symbol) % 4 == 0) a.terms[a.count++] = (StandardTerm){symbol, size * (2 * unit(i, k + 80 + symbol) - 1)};
    if (bits(i, k + 5) % 5 == 0) a.count = 0;
    if (bits(i, k + 6) % 3 == 0) a.error = size * unit(i, k + 7);
    /* long double has 11 bits more than double: less is not to be seen beside the centre. */
    if (size < 0x1p-36 * fabs(a.centre)) a.count = 0, a.error = 0;
    return a;
}

static long double at(const StandardForm *a, const double *symbols) {
    long double sum = (long double)a->centre;
    for (int i = 0; i < a->count; i++) sum += (long double)a->terms[i].by * (long double)symbols[a->terms[i].symbol];
    return sum;
}

/* What the symbols say, the new ones and the error being anything. */
static bool holds(const StandardForm *a, const double *symbols, double value) {
    long double sum = (long double)a->centre, open = (long double)a->error;
    if (value != value) return a->nan;
    if (!(a->error < HUGE_VAL)) return true;
    for (int i = 0; i < a->count; i++) {
        if (a->terms[i].symbol < SYMBOLS)
            sum += (long double)a->terms[i].by * (long double)symbols[a->terms[i].symbol];
        else
            open += fabsl((long double)a->terms[i].by);
    }
    return fabsl((long double)value - sum) <= open * (1 + 0x1p-60L);
}

static bool is_in_order(const StandardForm *a) {
    for (int i = 1; i < a->count; i++)
        if (a->terms[i - 1].symbol >= a->terms[i].symbol) return false;
    return a->count <= STANDARD_TERMS;
}

static void every_operation_holds_its_values(void **state) {
    (void)state;
    int failures = 0;
    double known = 0, count = (double)span_count(10000);
    for (size_t o = 0; o < VTS_ARRAY_COUNT(operations); o++)
        for (uint64_t i = 0; i < span_count(10000); i++) {
            uint64_t n = i * 1000 + o;
            uint32_t next = SYMBOLS;
            const StandardForm in[3] = {some_form(n, 0, &next), some_form(n, 200, &next), some_form(n, 400, &next)};
            StandardForm out = tape_apply_standard(operations[o].op, in[0], in[1], in[2]);
            assert_true(is_in_order(&out) && (!isfinite(out.error) || isfinite(out.centre)));
            known += out.error < HUGE_VAL;
            for (uint32_t t = 0; t < 4; t++) {
                double symbols[SYMBOLS], x[3];
                bool inside = true;
                for (uint32_t s = 0; s < SYMBOLS; s++) symbols[s] = t < 2 ? (bits(n, 600 + 30 * t + s) % 2 ? 1 : -1) : 2 * unit(n, 600 + 30 * t + s) - 1;
                for (uint32_t k = 0; k < 3; k++) {
                    long double exact = at(&in[k], symbols) + (long double)in[k].error * (2 * (long double)unit(n, 800 + 3 * t + k) - 1);
                    x[k] = (double)exact;
                    inside &= in[k].error > 0 ? holds(&in[k], symbols, x[k]) : (long double)x[k] == exact;
                }
                double value = tape_apply(operations[o].op, x[0], x[1], x[2]);
                if (!inside || holds(&out, symbols, value) || ++failures > 10) continue;
                print_error("%s(%.17g, %.17g, %.17g) = %.17g is not held: %.17g +- %.3g, %d terms\n", operations[o].name, x[0], x[1], x[2], value, out.centre,
                            out.error, out.count);
            }
        }
    assert_int_equal(failures, 0);
    assert_true(known > 15 * count); /* of 40 operations, a quarter of them on what is no number or huge */
}

static AffineForm line_of(uint64_t i, uint32_t k, double half) { return (AffineForm){8 * unit(i, k) - 4, half * (2 * unit(i, k + 1) - 1), 0x1p-48, false}; }

/* exp(x)·y − exp(x)·y + x is x: reduced forms know it no better than the products. */
static void errors_cancel(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef x = tape_input(b, 0), y = tape_input(b, 1), e = tape_unary(b, TAPE_EXP, x, (Span){0});
    TapeRef one = tape_binary(b, TAPE_MUL, e, y, (Span){0}), f = tape_binary(b, TAPE_SUB, tape_binary(b, TAPE_ADD, one, x, (Span){0}), one, (Span){0});
    const Tape *tape = tape_finish(b, &f, 1);
    StandardForm scratch[16], out;
    AffineForm reduced[16], loose;
    for (uint64_t i = 0; i < 1000; i++) {
        uint32_t next = 1;
        const AffineForm in[3] = {line_of(i, 0, 0.5), line_of(i, 2, 0.5), line_of(i, 4, 0.5)};
        const StandardForm forms[3] = {standard_of_line(in[0], &next), standard_of_line(in[1], &next), standard_of_line(in[2], &next)};
        tape_eval_standard(tape, forms, &out, scratch);
        tape_eval_affine(tape, in, &loose, reduced);
        AffineForm narrow = standard_reduced(&out);
        assert_true(narrow.error < 1e-10 && fabs(narrow.centre - in[0].centre) < 1e-10 && loose.error > 100 * narrow.error);
    }
    arena_destroy(&arena);
}

/* A chain of products makes more symbols than are kept; noises and kinks are among its links. */
static void tapes_along_lines(void **state) {
    (void)state;
    Arena arena;
    arena_init(&arena, NULL, 0);
    TapeBuilder *b = tape_builder_create(&arena, 3);
    TapeRef p[3] = {tape_input(b, 0), tape_input(b, 1), tape_input(b, 2)}, f = p[0];
    for (int k = 0; k < 30; k++) {
        TapeRef link = k % 3 == 0 ? tape_ternary(b, k % 2 ? TAPE_PERLIN : TAPE_POV_NOISE, f, p[1], p[2], (Span){0}) : tape_unary(b, k % 3 == 1 ? TAPE_SIN : TAPE_ABS, f, (Span){0});
        f = tape_binary(b, k % 4 ? TAPE_ADD : TAPE_MUL, link, p[k % 3], (Span){0});
    }
    const Tape *tape = tape_finish(b, &f, 1);
    StandardForm *scratch = arena_new_array(&arena, StandardForm, tape_scratch_size(tape)), out;
    int known = 0;
    for (uint64_t i = 0; i < 3000; i++) {
        uint32_t next = 1;
        AffineForm in[3] = {line_of(i, 0, ldexp(1, -(int)(i % 20))), line_of(i, 2, ldexp(1, -(int)(i % 20))), line_of(i, 4, ldexp(1, -(int)(i % 20)))};
        StandardForm forms[3];
        for (int k = 0; k < 3; k++) forms[k] = standard_of_line(in[k], &next);
        tape_eval_standard(tape, forms, &out, scratch);
        AffineForm narrow = standard_reduced(&out);
        known += narrow.error < 1e-2;
        for (int s = -4; s <= 4; s++) {
            double x[3], value;
            for (int k = 0; k < 3; k++) x[k] = in[k].centre + in[k].slope * (s / 4.0);
            tape_eval_once(tape, x, &value);
            assert_true(fabs(value - (narrow.centre + narrow.slope * (s / 4.0))) <= narrow.error);
        }
    }
    assert_true(known > 1000);
    arena_destroy(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_operation_holds_its_values), cmocka_unit_test(errors_cancel), cmocka_unit_test(tapes_along_lines)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
