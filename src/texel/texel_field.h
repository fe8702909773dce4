/* Matter as a density: voxels are filled from it directly, at the resolution asked, and the reference gets flakes of it.
 *
 * Where the density (after its thresholds) is v, matter has the extinction K·v: v random flakes of which a share a = g/(1 + g),
 * g = |grad v| / (K v²), the change of v along a free path relative to v, face along the gradient, and the others anywhere. So inside a cloud it is
 * isotropic, and at the rim of a solid its surface. */
#ifndef VTS_TEXEL_TEXEL_FIELD_H
#define VTS_TEXEL_TEXEL_FIELD_H

#include "scene/scene.h"
#include "texel/texel.h"

/* The field of a layer that has one, in `arena`. */
const TexelField *texel_field_make(const TexelDef *def, const TexelLayer *layer, Arena *arena);

/* About `count` triangles that stand for the field: together as large, and as turned, as its matter is wherever it can be seen; their places
 * follow from the field alone. */
void texel_field_flakes(const TexelField *field, Vec3f extent, size_t count, Arena *arena, TexelMesh *out);

#endif
