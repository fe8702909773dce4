/* Turbulence, and noises faded as the footprint outgrows them. */
#ifndef VTS_PATTERN_WARP_H
#define VTS_PATTERN_WARP_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* A value and the width of the range that it takes over the footprint: uniformly filled; or, with `bell`, as noises are: a bell with the
 * deviation that the range would have. */
typedef struct Spread {
    double value, width;
    bool bell;
} Spread;

typedef struct Octaves {
    int count;
    float lambda, omega; /* POV-Ray keeps them as floats */
    int generator;       /* of the noise: 1, 2, 3 */
} Octaves;

/* The noise that the pigment asks for. */
int generator_of(const Pigment *pigment);

/* The pigment's own. */
Octaves octaves_of(const Pigment *pigment);
bool has_turbulence(const Pigment *pigment);

/* The share of a noise of lattice constant 1 that a disc of this diameter leaves: the regression of the mean over the disc
 * on the value at its centre. `sharpness`: 0.4 for the noise itself, more for what is folded from it. */
static inline double noise_kept(double size, double sharpness) { return 1 / (1 + sharpness * size * size); }
/* Variance of what a share `kept` of the noise has lost. */
static inline double variance_lost(double deviation, double kept) {
    return deviation * deviation * (1 - kept * kept);
}
static inline double width_of_variance(double variance) { return sqrt(12 * variance); }

/* The scalar turbulence Σ omegaᵏ·noise(lambdaᵏ·p). */
Spread turbulence(const Spot *spot, Octaves octaves);
/* The vector turbulence; *variance gets that of each component over the footprint. */
Vec3 turbulence_vector(const Spot *spot, Octaves octaves, double *variance);
/* The spot moved by a turbulence. */
Spot turbulence_warp(const Spot *spot, Vec3 amount, Octaves octaves);
/* Where a warp other than turbulence takes a place (warp_place.c). */
Vec3 warp_place(const Warp *warp, Vec3 p);
/* A spot of the textured object's space in the space of the pattern: through the transforms and warps of the pigment, at last
 * its own turbulence if that is not part of the pattern's formula. */
Spot spot_in_pattern(const Pigment *pigment, const Spot *outer, bool warps_itself);

#endif
