/* Internal functions that repeat something as often as a parameter says: for internal.c and those files alone. */
#ifndef VTS_TAPE_INTERNAL_PARTS_H
#define VTS_TAPE_INTERNAL_PARTS_H

#include "tape/tape.h"

typedef double InternalEval(const double *p);
typedef bool InternalUnroll(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out);

/* internal_noise.c: the last parameter is the noise generator; and internal_tubes.c */
InternalEval internal_hetero_mf, internal_ridge, internal_ridged_mf, internal_noise_generator, internal_polytubes;
InternalUnroll unroll_hetero_mf, unroll_ridge, unroll_ridged_mf, unroll_noise_generator, unroll_polytubes;

#endif
