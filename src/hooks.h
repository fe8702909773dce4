/* What the evaluator asks of folders that it may not include: patterns as functions, the geometry of objects. One table for
 * whoever evaluates scenes: the library and the tests of the language. */
#ifndef VTS_HOOKS_H
#define VTS_HOOKS_H

#include "eval/eval.h"

/* For EvalOptions.geometry; the table is constant. */
const EvalGeometry *hooks_geometry(void);

#endif
