/* How much of a ray passes through matter that is known only by area density, S and gamma. */
#ifndef VTS_TEXEL_OPACITY_H
#define VTS_TEXEL_OPACITY_H

#include "texel/texel.h"

typedef enum OpacityModel {
    OPACITY_MEAN,        /* Neyret 1998 as published, with its errata: for the record */
    OPACITY_EXPONENTIAL, /* random matter: exp(−τ) */
    OPACITY_CORRELATED,  /* gamma mixes one sheet and random matter; the default */
} OpacityModel;

/* Transmittance of the segment `step` (a vector of texel space: the step's own difference of texture coordinates, so that
 * no determinant of the mapping is needed) in matter `v`, filtered to voxels of side h. The result composes:
 * T(a + b) = T(a)·T(b) for parallel steps. In (0, 1]. */
float opacity_transmittance(OpacityModel model, const VoxelSample *v, float h, Vec3f step);

#endif
