/* How much of the sky a place in a texel sees, known when the texel is built: ambient visibility per coarse voxel.
 *
 * A texel's layers shade each other, so all of them are asked together. The transmittance V(d) from a place to the outside of the
 * layer is kept as its second-order fit over directions d of texel space,
 *   V(d) = mean + first·d + dᵗ·second·d,   second symmetric and without trace,
 * so that light from a sky is a sum of a few products whichever way a mapping turns the texel. What is not matter of the texel
 * (the ground below it, other skins) is not in V. Matter within two and a half of the finest voxels of the place is left out:
 * a blade, blurred over its voxels, does not shade itself. */
#ifndef VTS_TEXEL_TEXEL_SKY_H
#define VTS_TEXEL_TEXEL_SKY_H

#include "texel/opacity.h"

typedef struct TexelSky TexelSky;

typedef struct TexelSkyOptions {
    OpacityModel opacity;
    /* The layer goes on with copies of the texel along these axes (TEXEL_CYCLIC_…), whether its contents wrap or not; along the
     * others the texel stands alone. */
    unsigned repeated;
    Pool *pool; /* may be NULL */
    MemoryBudget *memory;
} TexelSkyOptions;

/* What a place sees; of unit directions. */
typedef struct SkyView {
    float mean;
    Vec3f first;
    Sym3f second;
} SkyView;

/* From `count` layers of one size, which it does not keep. NULL when memory ran out or the pool was cancelled. The same for any
 * number of threads. To be destroyed by the caller. */
TexelSky *texel_sky_build(const VoxelLayer *const *layers, size_t count, const TexelSkyOptions *options);
void texel_sky_destroy(TexelSky *sky);
size_t texel_sky_bytes(const TexelSky *sky);

/* At p of texel space (inside the extent, which repeated axes wrap and the others clamp), interpolated. Of places in matter: elsewhere it is what
 * the nearest matter sees. */
SkyView texel_sky_at(const TexelSky *sky, Vec3f p);

/* Transmittance towards the unit direction d, in [0, 1]. */
static inline float sky_view_toward(const SkyView *v, Vec3f d) {
    return float_clamp(v->mean + vec3f_dot(v->first, d) + sym3f_quadratic(&v->second, d), 0, 1);
}
/* Its mean over the hemisphere around d, each direction alike; in [0, 1]: the share of an even sky with the zenith d that is seen. */
static inline float sky_view_hemisphere(const SkyView *v, Vec3f d) {
    return float_clamp(v->mean + 0.5f * vec3f_dot(v->first, d), 0, 1);
}
/* Its mean over the hemisphere around d, weighted by the cosine with d; in [0, 1]: irradiance of a face with the normal d under a
 * sky of unit radiance all around, over π. */
static inline float sky_view_cosine(const SkyView *v, Vec3f d) {
    return float_clamp(v->mean + (2.0f / 3) * vec3f_dot(v->first, d) + 0.25f * sym3f_quadratic(&v->second, d),
                       0, 1);
}

/* ---- what the eye sees ---- */

/* Unit directions over the hemisphere about y, each for the same solid angle. */
enum { SKY_WAYS = 8 };
Vec3f texel_sky_way(int i);
/* What the eye sees has a gap towards it, and gaps have a width: so much of what voxels, who know the mean place alone, would hide in a
 * direction under this cosine to the eye's is open. */
float sky_open_to_eye(float cosine);
/* The share of the hemisphere that is seen from `at`, a place in the extent that the eye sees: ways[] are the directions of texel_sky_way() in texel space,
 * unit or zero, gaps[] what sky_open_to_eye() says of each, to_eye the eye's direction in texel space, of any length. Where triangles tell which share of what is
 * seen is lit (voxel_pairs.h), the mean over all that is seen from there is theirs. */
float texel_sky_seen(const TexelSky *sky, Vec3f at, const Vec3f ways[SKY_WAYS], const float gaps[SKY_WAYS], Vec3f to_eye);

#endif
