/* Many evaluations at once: the reference arithmetic over arrays. A slot is a row of LANES doubles, and each operation a
 * plain loop over a row, which compilers turn into vector instructions. */
#include "tape/tape_program.h"
#include "tape/tape_rows.h"
#include "tape/tape_scalar.h"

#include <stdlib.h>

enum { LANES = 64 };

typedef double Row[LANES];

static void walk(const Tape *tape, Row *slots, size_t lanes);

static void fill(double *row, double value, size_t lanes) {
    for (size_t l = 0; l < lanes; l++) row[l] = value;
}

static void copy(double *restrict to, const double *restrict from, size_t lanes) {
    for (size_t l = 0; l < lanes; l++) to[l] = from[l];
}

static void load_constants(const Tape *tape, Row *slots, size_t lanes) {
    for (uint32_t k = 0; k < tape->constant_count; k++)
        fill(slots[tape->input_count + k], tape->constants[k], lanes);
}

static void call(const TapeCall *call_, Row *slots, size_t lanes) {
    const TapeExternal *external = call_->external;
    for (size_t l = 0; l < lanes; l++) {
        double in[TAPE_CALL_MAX], out[TAPE_CALL_MAX];
        for (int k = 0; k < external->input_count; k++) in[k] = slots[call_->arg_slots[k]][l];
        external->eval(external->data, in, out);
        for (int k = 0; k < external->output_count; k++)
            if (call_->result_slots[k] != TAPE_NO_SLOT) slots[call_->result_slots[k]][l] = out[k];
    }
}

/* Whether the loop from `from` to `to` makes pass number `pass` at index i. */
static inline bool loop_runs(double from, double to, double i, double pass) {
    return i <= to && pass <= to - from && to - from < TAPE_LOOP_LIMIT;
}

/* Adds the body's value in the lanes whose loop still runs; false when none does. */
static bool loop_pass(const TapeLoop *loop_, bool product, const double *from, const double *to, double pass,
                      Row *scratch, double *total, size_t lanes) {
    double *i = scratch[loop_->captured_count];
    bool any = false;
    for (size_t l = 0; l < lanes; l++) any |= loop_runs(from[l], to[l], i[l], pass);
    if (!any) return false;
    walk(loop_->body, scratch, lanes);
    const double *term = scratch[loop_->body->output_slots[0]];
    for (size_t l = 0; l < lanes; l++) {
        if (loop_runs(from[l], to[l], i[l], pass))
            total[l] = product ? total[l] * term[l] : total[l] + term[l];
        i[l] += 1;
    }
    return true;
}

static void loop(const TapeLoop *loop_, bool product, const double *from, const double *to, double *total,
                 Row *slots, Row *scratch, size_t lanes) {
    load_constants(loop_->body, scratch, lanes);
    for (uint32_t k = 0; k < loop_->captured_count; k++)
        copy(scratch[k], slots[loop_->captured_slots[k]], lanes);
    copy(scratch[loop_->captured_count], from, lanes);
    for (size_t l = 0; l < lanes; l++)
        total[l] = to[l] - from[l] < TAPE_LOOP_LIMIT ? (product ? 1 : 0) : (double)NAN;
    for (double pass = 0; loop_pass(loop_, product, from, to, pass, scratch, total, lanes);) pass++;
}

#define WALK_ROWS(expression)                                                                                \
    {                                                                                                        \
        double *restrict d = slots[step->dst];                                                               \
        for (size_t l = 0; l < lanes; l++) d[l] = (expression);                                              \
    }
#define WALK_ROW(operand) const double *restrict operand = slots[step->operand]
#define WALK_STEP_1(name)                                                                                    \
    {                                                                                                        \
        WALK_ROW(a);                                                                                         \
        WALK_ROWS(scalar_##name(a[l]))                                                                       \
    }
#define WALK_STEP_2(name)                                                                                    \
    {                                                                                                        \
        WALK_ROW(a);                                                                                         \
        WALK_ROW(b);                                                                                         \
        WALK_ROWS(scalar_##name(a[l], b[l]))                                                                 \
    }
#define WALK_STEP_3(name)                                                                                    \
    {                                                                                                        \
        WALK_ROW(a);                                                                                         \
        WALK_ROW(b);                                                                                         \
        WALK_ROW(c);                                                                                         \
        WALK_ROWS(scalar_##name(a[l], b[l], c[l]))                                                           \
    }
#define WALK_ROWS_APART
#define WALK_ROW_1(name) row_##name(slots[step->dst], slots[step->a], lanes)
#define WALK_ROW_2(name) row_##name(slots[step->dst], slots[step->a], slots[step->b], lanes)
#define WALK_ROW_3(name) row_##name(slots[step->dst], slots[step->a], slots[step->b], slots[step->c], lanes)
#define WALK_CALL        call(&tape->calls[step->c], slots, lanes)
#define WALK_LOOP(product)                                                                                   \
    loop(&tape->loops[step->c], product, slots[step->a], slots[step->b], slots[step->dst], slots,            \
         slots + tape->slot_count, lanes)

static void walk(const Tape *tape, Row *slots, size_t lanes) {
#include "tape/tape_walk.inc"
}

static void eval_rows(const Tape *tape, size_t n, const double *const *in, double *const *out, Row *slots) {
    load_constants(tape, slots, LANES);
    for (size_t begin = 0; begin < n; begin += LANES) {
        size_t lanes = size_min(LANES, n - begin);
        for (uint32_t k = 0; k < tape->input_count; k++) copy(slots[k], in[k] + begin, lanes);
        walk(tape, slots, lanes);
        for (uint32_t k = 0; k < tape->output_count; k++)
            copy(out[k] + begin, slots[tape->output_slots[k]], lanes);
    }
}

void tape_eval_batch(const Tape *tape, size_t n, const double *const *in, double *const *out) {
    Row few[48];
    Row *slots = tape->scratch_size <= VTS_ARRAY_COUNT(few) ? few : malloc(tape->scratch_size * sizeof *few);
    if (slots)
        eval_rows(tape, n, in, out, slots);
    else
        for (uint32_t k = 0; k < tape->output_count; k++) fill(out[k], (double)NAN, n);
    if (slots != few) free(slots);
}
