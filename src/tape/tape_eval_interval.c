/* The arithmetic of intervals: one evaluation over boxes of inputs. */
#include "tape/tape_interval.h"

#include "tape/tape_program.h"

static inline Interval interval_unknown(bool nan) { return interval_all(nan); }
static inline Interval interval_range(Interval a) { return a; }
static inline Interval interval_of_interval(Interval a) { return a; }

static bool interval_call(const TapeCall *call_, const Interval *slots, Interval *out) {
    (void)call_, (void)slots, (void)out;
    return false;
}

#define BOUND             Interval
#define BOUND_(name)      interval_##name
#define BOUND_NAMED(name) interval_##name
#include "tape/tape_bounds.inc"

Interval tape_apply_interval(TapeOp op, Interval a, Interval b, Interval c) { return apply(op, a, b, c); }

void tape_eval_interval(const Tape *tape, const Interval *in, Interval *out, Interval *scratch) { evaluate(tape, in, out, scratch); }

bool tape_is_bounded(const Tape *tape) {
    for (size_t i = 0; i < tape->call_count; i++)
        if (!tape->calls[i].external->bound) return false;
    for (size_t i = 0; i < tape->loop_count; i++)
        if (!tape_is_bounded(tape->loops[i].body)) return false;
    return true;
}
