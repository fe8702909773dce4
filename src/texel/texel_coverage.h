/* How much of what lies behind a layer its voxels hide. */
#ifndef VTS_TEXEL_TEXEL_COVERAGE_H
#define VTS_TEXEL_TEXEL_COVERAGE_H

#include "texel/opacity.h"
#include "texel/texel.h"

/* The mean over parallel rays along an axis (0 … 2) of one minus their transmittance through a level, in [0, 1]. At most 32 × 32
 * rays. */
double voxel_layer_coverage(const VoxelLayer *layer, int level, int axis, OpacityModel model);

#endif
