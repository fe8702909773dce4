/* A march through a skin whose sheets lie over one another, where height vectors cross: each piece of the ray in each box is followed
 * by a march of its own, and their segments come in the order of distance. */
#ifndef VTS_RENDER_SKIN_SHEETS_H
#define VTS_RENDER_SKIN_SHEETS_H

#include "render/skin_march.h"

typedef struct SkinSheets SkinSheets;

SkinSheets *skin_sheets_new(const CompiledSkin *skin, Arena *arena);
/* From now on along the cone and as the settings of `march`, between march->t and march->t_max. */
void skin_sheets_begin(SkinSheets *sheets, const SkinMarch *march);
bool skin_sheets_next(SkinSheets *sheets, SkinSegment *segment);
/* As skin_march_guess(). */
SkinPoint skin_sheets_guess(const SkinSheets *sheets, double t);

#endif
