/* What a wind does to the height vectors of a skin. */
#ifndef VTS_RENDER_SKIN_WIND_H
#define VTS_RENDER_SKIN_WIND_H

#include "render/compile.h"

/* Bends them (one for each vertex of `mesh`), at the scene's time; by springs if the skin has them. False after a diagnostic, or when interrupted. */
bool skin_bend(const Skin *skin, const SurfaceMesh *mesh, CompiledScene *compiled, DiagList *diags, Vec3 *heights);

#endif
