/* Tapes over reduced affine forms: a function along a piece of a line, as a linear function with a bound for what that misses. */
#ifndef VTS_TAPE_TAPE_AFFINE_H
#define VTS_TAPE_TAPE_AFFINE_H

#include "tape/affine.h"
#include "tape/tape.h"

/* out[k] holds tape_eval()'s value, and the exact one, at every s in [-1, 1] for inputs that the forms in[] hold there. The
 * scratch has tape_scratch_size() forms. `out` may be `in`. */
void tape_eval_affine(const Tape *tape, const AffineForm *in, AffineForm *out, AffineForm *scratch);

/* Whether it asks an external for forms, which then may keep things in a cache (node_cache.h). */
bool tape_has_forms(const Tape *tape);

/* One operation of arity 1 to 3; operands that it does not have are ignored. */
AffineForm tape_apply_affine(TapeOp op, AffineForm a, AffineForm b, AffineForm c);

#endif
