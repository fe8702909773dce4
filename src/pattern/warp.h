/* Turbulence, and noises faded as the footprint outgrows them. */
#ifndef VTS_PATTERN_WARP_H
#define VTS_PATTERN_WARP_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* A value and the width of the range, uniformly filled, that it takes over the footprint. */
typedef struct Spread {
    double value, width;
} Spread;

typedef struct Octaves {
    int count;
    float lambda, omega; /* POV-Ray keeps them as floats */
} Octaves;

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
/* The spot moved by the pigment's turbulence. */
Spot turbulence_warp(const Spot *spot, const Pigment *pigment);

#endif
