/* The reference arithmetic: one evaluation over doubles. */
#include "tape/tape_program.h"
#include "tape/tape_scalar.h"

#include <stdlib.h>
#include <string.h>

static void walk(const Tape *tape, double *slots);

static void load_constants(const Tape *tape, double *slots) {
    if (tape->constant_count)
        memcpy(slots + tape->input_count, tape->constants, tape->constant_count * sizeof *slots);
}

static void call(const TapeCall *call_, double *slots) {
    const TapeExternal *external = call_->external;
    double in[TAPE_CALL_MAX], out[TAPE_CALL_MAX];
    for (int k = 0; k < external->input_count; k++) in[k] = slots[call_->arg_slots[k]];
    external->eval(external->data, in, out);
    for (int k = 0; k < external->output_count; k++)
        if (call_->result_slots[k] != TAPE_NO_SLOT) slots[call_->result_slots[k]] = out[k];
}

double tape_loop_value(const Tape *body, bool product, double from, double to, double *scratch) {
    double passes = to - from, total = product ? 1 : 0, i = from;
    if (!(passes < TAPE_LOOP_LIMIT)) return (double)NAN;
    load_constants(body, scratch);
    /* Far from zero i + 1 may be i: the count ends the loop. */
    for (double pass = 0; i <= to && pass <= passes; pass++, i += 1) {
        scratch[body->input_count - 1] = i;
        walk(body, scratch);
        double term = scratch[body->output_slots[0]];
        total = product ? total * term : total + term;
    }
    return total;
}

static double loop(const TapeLoop *loop_, bool product, double from, double to, const double *slots,
                   double *scratch) {
    for (uint32_t k = 0; k < loop_->captured_count; k++) scratch[k] = slots[loop_->captured_slots[k]];
    return tape_loop_value(loop_->body, product, from, to, scratch);
}

#define WALK_STEP_1(name) slots[step->dst] = scalar_##name(slots[step->a])
#define WALK_STEP_2(name) slots[step->dst] = scalar_##name(slots[step->a], slots[step->b])
#define WALK_STEP_3(name) slots[step->dst] = scalar_##name(slots[step->a], slots[step->b], slots[step->c])
#define WALK_CALL         call(&tape->calls[step->c], slots)
#define WALK_LOOP(product)                                                                                   \
    slots[step->dst] = loop(&tape->loops[step->c], product, slots[step->a], slots[step->b], slots,           \
                            slots + tape->slot_count)

static void walk(const Tape *tape, double *slots) {
#include "tape/tape_walk.inc"
}

double tape_apply(TapeOp op, double a, double b, double c) {
    double slots[4] = {a, b, c, (double)NAN};
    TapeStep step = {(uint32_t)op, 3, 0, 1, 2};
    Tape tape = {.step_count = 1, .steps = &step};
    walk(&tape, slots);
    return slots[3];
}

void tape_eval(const Tape *tape, const double *in, double *out, double *scratch) {
    if (tape->input_count) memcpy(scratch, in, tape->input_count * sizeof *in);
    load_constants(tape, scratch);
    walk(tape, scratch);
    for (uint32_t k = 0; k < tape->output_count; k++) out[k] = scratch[tape->output_slots[k]];
}

void tape_eval_once(const Tape *tape, const double *in, double *out) {
    double few[256];
    double *scratch =
        tape->scratch_size <= VTS_ARRAY_COUNT(few) ? few : malloc(tape->scratch_size * sizeof *few);
    if (scratch)
        tape_eval(tape, in, out, scratch);
    else
        for (uint32_t k = 0; k < tape->output_count; k++) out[k] = (double)NAN;
    if (scratch != few) free(scratch);
}
