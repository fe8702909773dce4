/* Noises: deterministic functions of place, the same on every machine. */
#ifndef VTS_TAPE_NOISE_H
#define VTS_TAPE_NOISE_H

#include "base/vec.h"

/* Perlin's improved noise of 2002 with its published permutation; in about [-1, 1], 0 at lattice points, period 256. */
double noise_perlin(Vec3 p);
/* Three independent Perlin noises, another for each `seed`: for jitter. */
Vec3 noise_perlin3(Vec3 p, uint32_t seed);
/* One of a family of Perlin noises: `seed` moves and turns the lattice. */
double noise_perlin_seeded(Vec3 p, uint32_t seed);
/* Σ gainᵏ · noise(lacunarityᵏ · p), k = 0 … octaves − 1; not normalised. */
double noise_fbm(Vec3 p, int octaves, double lacunarity, double gain);

#endif
