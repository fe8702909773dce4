/* The colours of matter in voxels, each asked of its pigment once: far away thousands of lines of sight meet the same voxel in its copies. */
#ifndef VTS_RENDER_MATTER_COLOR_H
#define VTS_RENDER_MATTER_COLOR_H

#include "render/cone.h"
#include "render/skin_march.h"

/* Gives a built layer of matter room for the colours of its voxels: four bytes each, but for the finest. Nothing for looks of one colour. */
void matter_colors_prepare(TexelMatter *matter, Arena *arena);

/* The colour of matter under the cone, near t: a texel's own texture lives in its bounds, one laid over it by the skin in the scene. `voxel_width`: of
 * the voxels used, in footprints. Depends on the hit alone, not on what was asked before; called from any thread. */
Vec3f matter_color(const MatterHit *hit, const Cone *cone, double t, float voxel_width);

#endif
