/* Internal functions that are written as operations of tapes, so that every arithmetic has them; the rest are externals. */
#ifndef VTS_TAPE_INTERNAL_TAPE_H
#define VTS_TAPE_INTERNAL_TAPE_H

#include "tape/internal.h"
#include "tape/tape.h"

/* Appends the function of in[0 .. function->inputs); its values are function->eval's bit for bit. False, and nothing is
 * appended, if it is one that operations do not express. */
bool internal_tape(TapeBuilder *builder, const InternalFunction *function, const TapeRef *in, TapeRef *out,
                   Span span);

#endif
