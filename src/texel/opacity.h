/* How much of a ray passes through matter that is known only by area density, S and gamma. */
#ifndef VTS_TEXEL_OPACITY_H
#define VTS_TEXEL_OPACITY_H

#include "texel/texel.h"

typedef enum OpacityModel {
    OPACITY_MEAN,        /* Neyret 1998 as published, with its errata: for the record */
    OPACITY_EXPONENTIAL, /* random matter: exp(−τ) */
    OPACITY_CORRELATED,  /* gamma tells sheets from random matter; the default */
    OPACITY_CROSSING,    /* gamma mixes the two laws per crossing of a voxel: for the record */
} OpacityModel;

/* Transmittance of the segment `step` (a vector of texel space: the step's own difference of texture coordinates, so that
 * no determinant of the mapping is needed) in matter `v`, filtered to voxels of side h. The result composes:
 * T(a + b) = T(a)·T(b) for parallel steps. In (0, 1].
 *
 * Correlated: a sheet that is interpolated trilinearly is smeared over two voxels of depth, and neither exp(−τ) nor
 * 1 − τ applied to the smeared density is opaque again (0.37 and 0.14 … 0.3 get through). What tells the middle of an
 * intact sheet is its density alone: 2ρh, area per voxel's face, is 0.8 to 1 there whatever way the sheet is turned or
 * seen. So τ is enhanced by 1 + 5 (2γρh)³, which leaves matter much thinner than a voxel as it is and makes intact
 * sheets opaque from everywhere. γ is above 1 where a sheet goes over from one layer of voxels to the next: together they are
 * intact. Matter that hides itself in clumps, as blades do in a coarse voxel, has a gamma < 0 and
 * a factor 1 + γ < 1. h: side of the voxels, 2^lod times that of the finest level where levels are mixed.
 *
 * Crossing: T = γ max(0, 1 − τ) + (1 − γ) exp(−τ), not below 1/512, for the mean crossing l = h/(|dx| + |dy| + |dz|) of a
 * voxel; a segment s transmits T^(s/l). */
float opacity_transmittance(OpacityModel model, const VoxelSample *v, float h, Vec3f step);
/* The same as optical depth, −ln T: what matter that stands in one place adds up to. >= 0. */
float opacity_depth(OpacityModel model, const VoxelSample *v, float h, Vec3f step);

/* The area of matter that the step passes, seen along it and for each unit of area across it, were nothing hidden by other: τ of
 * OPACITY_EXPONENTIAL. >= 0. */
float opacity_area(const VoxelSample *v, Vec3f step);

/* OPACITY_MEAN at a level coarser than the finest, whose voxels have side `finest`: a voxel's opacity there is the mean
 * of those below it, crossed once (Neyret 1998 sec. IV-C), so that matter becomes the thinner the farther away it is.
 * opacity_transmittance() takes finest = h. */
float opacity_transmittance_mean(const VoxelSample *v, float finest, float h, Vec3f step);
float opacity_depth_mean(const VoxelSample *v, float finest, float h, Vec3f step);

/* The factor by which OPACITY_CORRELATED enhances τ, for density in units of 1/h; and the gamma for a factor. */
static inline float opacity_enhancement(float gamma, float density) {
    float x = 2 * gamma * density;
    return gamma < 0 ? 1 + gamma : 1 + 5 * x * x * x;
}
static inline float opacity_gamma_for(float enhancement, float density) {
    if (enhancement <= 1) return enhancement - 1;
    return cbrtf((enhancement - 1) / 5) / (2 * density);
}

#endif
