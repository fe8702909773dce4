/* Which members of a family agree where their matter crosses the border of a tile. */
#ifndef VTS_RENDER_WANG_BORDER_H
#define VTS_RENDER_WANG_BORDER_H

#include "render/compile.h"

/* Compares the sections that walls between tiles make through the members. NULL where any member may lie beside any: either all agree, or, after a
 * warning that names the two members that agree least, there are too few for a layout in which all borders fit. Otherwise rows and columns of
 * one class each make such a layout. `all`: of the members, those past `count` being empty. */
const WangBorders *wang_borders(const TexelDef *const *defs, size_t count, size_t all, const Skin *skin, CompiledScene *compiled, DiagList *diags);

#endif
