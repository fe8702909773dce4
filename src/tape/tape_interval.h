/* Tapes over intervals: bounds of a function over a box. */
#ifndef VTS_TAPE_TAPE_INTERVAL_H
#define VTS_TAPE_TAPE_INTERVAL_H

#include "tape/interval.h"
#include "tape/tape.h"

/* out[k] holds whatever tape_eval() gives for inputs from in[], and the exact value too. The scratch has tape_scratch_size()
 * intervals. `out` may be `in`. */
void tape_eval_interval(const Tape *tape, const Interval *in, Interval *out, Interval *scratch);

/* One operation of arity 1 to 3; operands that it does not have are ignored. */
Interval tape_apply_interval(TapeOp op, Interval a, Interval b, Interval c);

/* Whether every part of the tape has bounds: pictures and other externals may have none, and a tape with one of them is known
 * at points only. Loops count as bounded, though few are when their number of passes is not a constant. */
bool tape_is_bounded(const Tape *tape);

#endif
