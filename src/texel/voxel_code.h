/* The eight bytes of a stored voxel.
 *
 * S in six bytes, as its symmetric square root B (S = B², B's diagonal in [0, 2], the rest in [−1, 1], eight bits each):
 * the square of a symmetric matrix is never indefinite, |B d| = sqrt(dᵗ S d) is what opacity needs, and an error of B is at
 * most the same error of the projected area (1.2 % of its mean at worst, 0.4 % rms). A rotation with two ratios has a
 * similar error but costs a square root and sixty products to read.
 * Density in eleven bits: a small float (5 bits exponent, 6 mantissa), in units of 1/side; relative error at most 0.8 %.
 * Gamma in five bits, from −0.36 to 1.73 by steps of 0.072. Two codes are kept for solids: the lowest, −0.43, for walls before their
 * inside, the largest, 1.8, for voxels of the inside, which stop light and have no area of their own. */
#ifndef VTS_TEXEL_VOXEL_CODE_H
#define VTS_TEXEL_VOXEL_CODE_H

#include "texel/texel.h"

/* Densities from 2⁻¹⁸ to 2¹⁴: that of the lowest code is 2 to this less 127. */
#define VOXEL_DENSITY_BIAS 109u

typedef struct VoxelCode {
    uint32_t diagonal; /* bytes, lowest first: Bxx Byy Bzz Bxy */
    uint32_t rest;     /* bytes Bxz Byz; 11 bits density; 5 bits gamma */
} VoxelCode;

enum {
    VOXEL_DENSITY_SHIFT = 16,
    VOXEL_GAMMA_SHIFT = 27,
    VOXEL_DENSITY_LARGEST = 2047,
    VOXEL_GAMMA_LARGEST = 30,
    VOXEL_GAMMA_WALL = 0,
    VOXEL_GAMMA_LEAST = 1,
    VOXEL_GAMMA_INSIDE = 31,
    VOXEL_GAMMA_ZERO = 6
};
#define VOXEL_GAMMA_STEP 0.072f

/* `density` in units of 1/side (> 0), s of unit mean projected area and roughness at least VOXEL_ROUGHNESS. */
VoxelCode voxel_code_pack(float density, float gamma, const Sym3f *root);
/* The same of a wall that has the inside of its solid behind it. */
VoxelCode voxel_code_wall(VoxelCode code);
/* A voxel within a solid that turns like `root`. */
VoxelCode voxel_code_inside(const Sym3f *root);
static inline bool voxel_code_is_inside(VoxelCode code) {
    return code.rest >> VOXEL_GAMMA_SHIFT == VOXEL_GAMMA_INSIDE;
}
void voxel_code_unpack(VoxelCode code, VoxelSample *out);
/* From a code of files of version 1. */
VoxelCode voxel_code_from_first(VoxelCode code);

/* The parts, for readers that decode several at once. Entries of B scaled by 255/2: whole numbers. */
static inline float voxel_code_diagonal(uint32_t word, int byte) {
    return (float)(int32_t)(word >> (8 * byte) & 255u);
}
static inline float voxel_code_mixed(uint32_t word, int byte) {
    return (float)((int32_t)(word >> (8 * byte) & 255u) - 128);
}
/* Squares of the scaled entries times this are S. */
#define VOXEL_CODE_SQUARE (1.0f / (127.5f * 127.5f))

static inline float voxel_code_density(uint32_t rest) {
    union {
        uint32_t bits;
        float value;
    } u = {(rest >> VOXEL_DENSITY_SHIFT & 2047u) << 17};
    u.bits += VOXEL_DENSITY_BIAS << 23;
    return u.value;
}
static inline float voxel_code_gamma(uint32_t rest) {
    return (float)((int32_t)(rest >> VOXEL_GAMMA_SHIFT) - VOXEL_GAMMA_ZERO) * VOXEL_GAMMA_STEP;
}

/* 1 for walls and insides of solids, 0 for all else. */
static inline float voxel_code_solid(uint32_t rest) {
    uint32_t code = rest >> VOXEL_GAMMA_SHIFT;
    return (float)(int32_t)(((code + 1) & 31u) < 2);
}

#endif
