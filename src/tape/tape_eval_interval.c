/* The arithmetic of intervals: one evaluation over boxes of inputs. */
#include "tape/tape_interval.h"

#include "tape/tape_program.h"

static void walk(const Tape *tape, Interval *slots);

static void load_constants(const Tape *tape, Interval *slots) {
    for (uint32_t k = 0; k < tape->constant_count; k++) slots[tape->input_count + k] = interval_point(tape->constants[k]);
}

/* An external's values are known where its arguments are; else nothing is known of it unless it says so. */
static void call(const TapeCall *call_, Interval *slots) {
    const TapeExternal *external = call_->external;
    Interval in[TAPE_CALL_MAX], out[TAPE_CALL_MAX];
    double point[TAPE_CALL_MAX], value[TAPE_CALL_MAX];
    bool known = true;
    for (int k = 0; k < external->input_count; k++) {
        in[k] = slots[call_->arg_slots[k]];
        known &= interval_is_point(in[k]);
        point[k] = in[k].low;
    }
    if (known) {
        external->eval(external->data, point, value);
        for (int k = 0; k < external->output_count; k++) out[k] = interval_point(value[k]);
    } else if (external->bound) {
        external->bound(external->data, in, out);
    } else {
        for (int k = 0; k < external->output_count; k++) out[k] = interval_all(true);
    }
    for (int k = 0; k < external->output_count; k++)
        if (call_->result_slots[k] != TAPE_NO_SLOT) slots[call_->result_slots[k]] = out[k];
}

/* Loops of a known number of passes, up to a few thousand, are run; of others nothing is known. */
enum { MOST_PASSES = 4096 };

static Interval loop(const TapeLoop *loop_, bool product, Interval from, Interval to, const Interval *slots, Interval *scratch) {
    const Tape *body = loop_->body;
    if (!interval_is_point(from) || !interval_is_point(to) || !(to.low - from.low < MOST_PASSES)) return interval_all(true);
    for (uint32_t k = 0; k < loop_->captured_count; k++) scratch[k] = slots[loop_->captured_slots[k]];
    load_constants(body, scratch);
    Interval total = interval_point(product ? 1 : 0);
    double i = from.low;
    for (double pass = 0; i <= to.low && pass <= to.low - from.low; pass++, i += 1) {
        scratch[body->input_count - 1] = interval_point(i);
        walk(body, scratch);
        Interval term = scratch[body->output_slots[0]];
        total = product ? interval_MUL(total, term) : interval_ADD(total, term);
    }
    return total;
}

#define WALK_STEP_1(name) slots[step->dst] = interval_##name(slots[step->a])
#define WALK_STEP_2(name) slots[step->dst] = interval_##name(slots[step->a], slots[step->b])
#define WALK_STEP_3(name) slots[step->dst] = interval_##name(slots[step->a], slots[step->b], slots[step->c])
#define WALK_CALL         call(&tape->calls[step->c], slots)
#define WALK_LOOP(product)                                                                                   \
    slots[step->dst] = loop(&tape->loops[step->c], product, slots[step->a], slots[step->b], slots, slots + tape->slot_count)

static void walk(const Tape *tape, Interval *slots) {
#include "tape/tape_walk.inc"
}

Interval tape_apply_interval(TapeOp op, Interval a, Interval b, Interval c) {
    Interval slots[4] = {a, b, c, interval_never()};
    TapeStep step = {(uint32_t)op, 3, 0, 1, 2};
    Tape tape = {.step_count = 1, .steps = &step};
    walk(&tape, slots);
    return slots[3];
}

void tape_eval_interval(const Tape *tape, const Interval *in, Interval *out, Interval *scratch) {
    for (uint32_t k = 0; k < tape->input_count; k++) scratch[k] = in[k];
    load_constants(tape, scratch);
    walk(tape, scratch);
    for (uint32_t k = 0; k < tape->output_count; k++) out[k] = scratch[tape->output_slots[k]];
}

bool tape_is_bounded(const Tape *tape) {
    for (size_t i = 0; i < tape->call_count; i++)
        if (!tape->calls[i].external->bound) return false;
    for (size_t i = 0; i < tape->loop_count; i++)
        if (!tape_is_bounded(tape->loops[i].body)) return false;
    return true;
}
