/* Texels as triangles for audits, kept from frame to frame. */
#ifndef VTS_RENDER_EXACT_MEMO_H
#define VTS_RENDER_EXACT_MEMO_H

#include "render/compile.h"

typedef struct ExactMemo ExactMemo;

/* Empty; NULL when memory is short. What it keeps counts for the budget. */
ExactMemo *exact_memo_create(MemoryBudget *memory);
/* NULL: nothing. */
void exact_memo_destroy(ExactMemo *memo);
/* Forgets all; after memory ran out, too. */
void exact_memo_clear(ExactMemo *memo);

/* exact_build_texel(), or what it made of the same texel as finely (NULL: nothing is kept). Keeps no more than a few times how->most triangles; what it gave lives until another
 * does not fit, which is asked for at the beginning of a frame alone: exact_memo_begin(). */
bool exact_memo_build(ExactMemo *memo, BuiltTexel *texel, const ExactMaking *how, CompiledScene *compiled, DiagList *diags);
void exact_memo_begin(ExactMemo *memo);

#endif
