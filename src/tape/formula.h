/* Operations of tapes from their formula: for functions that are known when the program is made. */
#ifndef VTS_TAPE_FORMULA_H
#define VTS_TAPE_FORMULA_H

#include "tape/tape.h"

/* Appends what the text says: definitions `name = expression;`, each of which sees those before it, and at last an expression, whose value
 * is *out. Expressions have numbers, names, + - * / with their usual order, whole powers ^2, ^3 and ^4 (products, no pow()), brackets, and operations
 * of arity 1 to 3 by their printed forms, as in max(a, b). The names x, y, z, p3, p4 … are the values in[0], in[1] …, of which there are
 * `count`; pi is known, too. False: the text is none; what it has appended until there is dropped when the tape is finished. */
bool formula_append(TapeBuilder *builder, const char *text, const TapeRef *in, int count, Span span, TapeRef *out);

#endif
