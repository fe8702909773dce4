/* The arithmetic of reduced affine forms: one evaluation along a piece of a line. */
#include "tape/tape_affine.h"

#include "tape/tape_program.h"

static bool affine_call(const TapeCall *call_, const AffineForm *slots, AffineForm *out) {
    const TapeExternal *external = call_->external;
    AffineForm in[TAPE_CALL_MAX];
    if (!external->forms) return false;
    for (int k = 0; k < external->input_count; k++) in[k] = slots[call_->arg_slots[k]];
    external->forms(external->data, 1, in, out, NULL);
    return true;
}

#define BOUND             AffineForm
#define BOUND_(name)      affine_##name
#define BOUND_NAMED(name) affine_##name
#include "tape/tape_bounds.inc"

AffineForm tape_apply_affine(TapeOp op, AffineForm a, AffineForm b, AffineForm c) { return apply(op, a, b, c); }

void tape_eval_affine(const Tape *tape, const AffineForm *in, AffineForm *out, AffineForm *scratch) { evaluate(tape, in, out, scratch); }

bool tape_has_forms(const Tape *tape) {
    for (size_t i = 0; i < tape->call_count; i++)
        if (tape->calls[i].external->forms) return true;
    for (size_t i = 0; i < tape->loop_count; i++)
        if (tape_has_forms(tape->loops[i].body)) return true;
    return false;
}
