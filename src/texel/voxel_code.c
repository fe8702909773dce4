#include "texel/voxel_code.h"

#include "texel/opacity.h"

#include <assert.h>

/* What is no number counts as the least. */
static uint32_t whole(float x, float lo, float hi) { return (uint32_t)((x > lo ? float_min(x, hi) : lo) + 0.5f); }
static uint32_t diagonal(float b) { return whole(b * 127.5f, 0, 255); }
static uint32_t mixed(float b) { return whole(b * 127.5f + 128, 0, 255); }

static uint32_t density_code(float density) {
    union {
        float value;
        uint32_t bits;
    } u = {float_clamp(density, 0x1p-18f, 0x1.fcp13f)};
    uint32_t code = (u.bits + (1u << 16) - (VOXEL_DENSITY_BIAS << 23)) >> 17;
    return code > VOXEL_DENSITY_LARGEST ? VOXEL_DENSITY_LARGEST : code;
}

static uint32_t gamma_code(float gamma) {
    return whole(gamma / VOXEL_GAMMA_STEP + VOXEL_GAMMA_ZERO, VOXEL_GAMMA_LEAST, VOXEL_GAMMA_LARGEST) << VOXEL_GAMMA_SHIFT;
}

VoxelCode voxel_code_pack(float density, float gamma, const Sym3f *root) {
    return (VoxelCode){
        .diagonal =
            diagonal(root->xx) | diagonal(root->yy) << 8 | diagonal(root->zz) << 16 | mixed(root->xy) << 24,
        .rest = mixed(root->xz) | mixed(root->yz) << 8 | density_code(density) << VOXEL_DENSITY_SHIFT |
                gamma_code(gamma),
    };
}

/* With the largest gamma this density is opaque within a fraction of the voxel. */
#define INSIDE_DENSITY 0.64f

VoxelCode voxel_code_inside(const Sym3f *root) {
    VoxelCode code = voxel_code_pack(INSIDE_DENSITY, 0, root);
    code.rest |= (uint32_t)VOXEL_GAMMA_INSIDE << VOXEL_GAMMA_SHIFT;
    return code;
}

VoxelCode voxel_code_wall(VoxelCode code) {
    code.rest &= ((uint32_t)1 << VOXEL_GAMMA_SHIFT) - 1;
    static_assert(VOXEL_GAMMA_WALL == 0, "the code of walls is no bits");
    return code;
}

void voxel_code_unpack(VoxelCode code, VoxelSample *out) {
    float xx = voxel_code_diagonal(code.diagonal, 0), yy = voxel_code_diagonal(code.diagonal, 1);
    float zz = voxel_code_diagonal(code.diagonal, 2), xy = voxel_code_mixed(code.diagonal, 3);
    float xz = voxel_code_mixed(code.rest, 0), yz = voxel_code_mixed(code.rest, 1);
    const float k = VOXEL_CODE_SQUARE;
    *out = (VoxelSample){
        .density = voxel_code_density(code.rest),
        .gamma = voxel_code_gamma(code.rest),
        .solid = voxel_code_solid(code.rest),
        .s = {k * (xx * xx + xy * xy + xz * xz), k * (xy * xy + yy * yy + yz * yz),
              k * (xz * xz + yz * yz + zz * zz), k * (xx * xy + xy * yy + xz * yz),
              k * (xx * xz + xy * yz + xz * zz), k * (xy * xz + yy * yz + yz * zz)},
    };
}

VoxelCode voxel_code_from_first(VoxelCode code) {
    float gamma = ((float)(int32_t)(code.rest >> VOXEL_GAMMA_SHIFT) - 10) / 21,
          density = voxel_code_density(code.rest);
    if (gamma > 0) gamma = opacity_gamma_for(1 + 16 * gamma * gamma * density * density, density);
    code.rest = (code.rest & (((uint32_t)1 << VOXEL_GAMMA_SHIFT) - 1)) | gamma_code(gamma);
    return code;
}
