/* Tapes over dual numbers: a function and its gradient in one walk. */
#ifndef VTS_TAPE_TAPE_GRADIENT_H
#define VTS_TAPE_TAPE_GRADIENT_H

#include "base/vec.h"
#include "tape/tape.h"

/* A value and its derivatives by the first three inputs. */
typedef struct Dual {
    double value, by[3];
} Dual;

/* The value is tape_eval()'s, the gradient that of the exact function up to rounding: of the branch that is taken where functions have
 * kinks, 0 where they jump. Externals that know no gradient are compared at neighbouring places. NaN or infinite where there is none.
 * The tape has three inputs and one output; the scratch has tape_scratch_size() duals. */
Dual tape_eval_gradient(const Tape *tape, Vec3 p, Dual *scratch);

#endif
