/* What the evaluator asks of folders that it may not include: patterns as functions, the geometry of objects. One table for
 * whoever evaluates scenes: the library and the tests of the language. */
#ifndef VTS_HOOKS_H
#define VTS_HOOKS_H

#include "eval/eval.h"
#include "texel/texel_cache.h"

/* For EvalOptions.geometry. What is prepared for objects lives in `arena`, which must outlive the evaluation; texels from files
 * are kept in `texels` (NULL: there are none). */
EvalGeometry hooks_geometry(Arena *arena, TexelCache *texels);

#endif
