/* The functions that POV-Ray's functions.inc names by number: function { internal(N) }. Values are POV-Ray's 3.7. */
#ifndef VTS_TAPE_INTERNAL_H
#define VTS_TAPE_INTERNAL_H

#include "tape/tape.h"

enum { INTERNAL_INPUTS = 13 }; /* the most that any takes */

/* Inputs 0 … 2 are x, y, z, the rest the function's own parameters. */
typedef struct InternalFunction {
    int number;
    const char *name;
    int inputs;
    const char *formula; /* (formula.h); NULL: what it computes depends on its parameters, as `eval` and `unroll` say */
    double (*eval)(const double *p); /* pure; whatever p is, a number comes back (perhaps NaN) */
    /* Appends its operations where the parameters they depend on are constants; false: they are not, or no operations tell its value. */
    bool (*unroll)(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out);
} InternalFunction;

/* NULL: there is no such number. */
const InternalFunction *internal_find(int number);
/* All of them, in order of their numbers; for tests and tables. */
const InternalFunction *internal_all(size_t *count);

/* Appends the function of in[0 .. function->inputs) as operations, which every arithmetic has. False: it needs an external. */
bool internal_append(TapeBuilder *builder, const InternalFunction *function, const TapeRef *in, Span span, TapeRef *out);

#endif
