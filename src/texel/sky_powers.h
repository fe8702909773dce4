/* What places in voxels see of the sky is that of all matter there; the eye sees some of it, which sees more, the flatter the eye looks. */
#ifndef VTS_TEXEL_SKY_POWERS_H
#define VTS_TEXEL_SKY_POWERS_H

#include "texel/texel_sky.h"
#include "texel/voxel_pairs.h"

/* For each direction of voxel_pairs.h to the eye the power of texel_sky_seen() whose mean over all that is seen is what triangles say, if one of the layers knows
 * that: else they stay as they are. `sky` knows its views and has the powers 1. False if the pool was cancelled. */
bool sky_powers_find(const TexelSky *sky, const VoxelLayer *const *layers, size_t count, const TexelSkyOptions *options, float power[PAIR_NODES]);

#endif
