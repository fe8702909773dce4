/* Noises: deterministic functions of place, the same on every machine. */
#ifndef VTS_TAPE_NOISE_H
#define VTS_TAPE_NOISE_H

#include "base/vec.h"

/* Perlin's improved noise of 2002 with its published permutation; in about [-1, 1], 0 at lattice points, period 256.
 * Exact lattice arithmetic for coordinates of any size; NaN where a coordinate is not finite (as all noises here). */
double noise_perlin(Vec3 p);
/* The same with its gradient. */
double noise_perlin_gradient(Vec3 p, double gradient[3]);
/* Bounds for Perlin's noise anywhere (see noise.c), and for its second derivative along any unit direction, whatever its lattice
 * holds; bench/prove_noise.c proves them. */
#define NOISE_PERLIN_MOST 1.03636
#define NOISE_PERLIN_CURVATURE 15.0
/* Three independent Perlin noises, another for each `seed`: for jitter. */
Vec3 noise_perlin3(Vec3 p, uint32_t seed);
/* One of a family of Perlin noises: `seed` moves and turns the lattice. */
double noise_perlin_seeded(Vec3 p, uint32_t seed);
/* Σ gainᵏ · noise(lacunarityᵏ · p), k = 0 … octaves − 1; not normalised. */
double noise_fbm(Vec3 p, int octaves, double lacunarity, double gain);

/* Worley's cellular noise: the distance to the index-th nearest of the nodes, from 0 (at most WORLEY_NODES - 1). Three nodes
 * a unit cell on average. */
enum { WORLEY_NODES = 8 };
double noise_worley(Vec3 p, int index);
/* The same of all nodes up to number `last`: out[0 … last]. */
void noise_worley_nearest(Vec3 p, int last, double *out);
/* Lewis's sparse convolution: `count` impulses a unit cell (1 to SPARSE_IMPULSES) of weights in [-1, 1], each a raised cosine
 * of radius 1; divided by the root of `count`, so that the deviation, about 0.35, does not depend on it. */
enum { SPARSE_IMPULSES = 64 };
double noise_sparse_convolution(Vec3 p, int count);
/* The gradient of either: of noise_worley_nearest() for numbers 0 … last. NaN where the place is no number; 0 at a node. */
void noise_worley_gradients(Vec3 p, int last, Vec3 *out);
Vec3 noise_sparse_gradient(Vec3 p, int count);

/* POV-Ray's own noises, number for number (its noise_generator 2, the default of 3.7, and 1). In [0, 1], period 4096. */
double noise_pov(Vec3 p);
double noise_pov_original(Vec3 p);
/* The first before it is clamped to [0, 1], with its gradient, which is continuous; it changes by at most this along a unit of way. */
double noise_pov_gradient3(Vec3 p, double gradient[3]);
#define NOISE_POV_CURVATURE (25.0 * 0.48985582)
/* Its noise_generator 3, period 2048; and the gradient noise that it is made of, about [-0.7, 0.7]. */
double noise_pov_gradient(Vec3 p);
double noise_gradient(Vec3 p);
/* The three by POV-Ray's numbers; others are the first, as there. */
typedef enum NoiseGenerator { NOISE_ORIGINAL = 1, NOISE_CORRECTED = 2, NOISE_GRADIENT = 3 } NoiseGenerator;
double noise_generated(int generator, Vec3 p);
/* Its vector noise, which turbulence is made of: about [-1, 1] each. */
Vec3 noise_pov_vector(Vec3 p);
/* Of the unit cell that p is in, POV-Ray's random numbers: one in [0, 1) for `cells`, and the place of a point in the
 * cell for `crackle`. The cell is given by its corner, whole numbers. */
double noise_pov_cell(Vec3 corner);
Vec3 noise_pov_cell_point(Vec3 corner);

#endif
