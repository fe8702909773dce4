/* Standard affine forms (Comba & Stolfi 1993; Gamito & Maddock 2007, section 3.1): what each operation of tape_ops.def does to
 *
 *     value = centre + Σ byᵢ·εᵢ + error·e,    every εᵢ in [-1, 1] the same in all forms of an evaluation, e in [-1, 1] of this form alone.
 *
 * ε₀ is the place on the piece of the line, as s in affine.h; each operation that is not linear makes another, for what it is off.
 * So errors cancel that come from the same place, as in f - f, where reduced forms add them up. STANDARD_TERMS at most are kept: the least go
 * into `error`. As with the other forms, both the exact value and that of tape_scalar.h are held. */
#ifndef VTS_TAPE_STANDARD_H
#define VTS_TAPE_STANDARD_H

#include "tape/affine.h"
#include "tape/tape.h"

enum { STANDARD_TERMS = 16 };

typedef struct StandardTerm {
    uint32_t symbol;
    double by;
} StandardTerm;

typedef struct StandardForm {
    double centre, error;
    bool nan;
    uint8_t count;  /* of terms, by rising symbols */
    uint32_t *next; /* symbol of the evaluation that nothing has yet; NULL: of a constant, whose results make none */
    StandardTerm terms[STANDARD_TERMS];
} StandardForm;

/* Of an input: the form of the line's piece. *next is 1 before an evaluation, and the same for all inputs. */
StandardForm standard_of_line(AffineForm form, uint32_t *next);
/* All but ε₀ as error. */
AffineForm standard_reduced(const StandardForm *form);

/* As tape_eval_affine(). */
void tape_eval_standard(const Tape *tape, const StandardForm *in, StandardForm *out, StandardForm *scratch);
/* One operation of arity 1 to 3; operands that it does not have are ignored. */
StandardForm tape_apply_standard(TapeOp op, StandardForm a, StandardForm b, StandardForm c);

#endif
