/* Inside of a voxel layer: per level a flat index of bricks of 8³ voxels; a brick keeps only its occupied voxels. */
#ifndef VTS_TEXEL_VOXEL_LAYER_H
#define VTS_TEXEL_VOXEL_LAYER_H

#include "texel/texel.h"
#include "texel/voxel_code.h"

enum { BRICK_SIDE = 8, BRICK_ROWS = 64, BRICK_VOXELS = 512 };

/* A row is 8 voxels along x; row 8·z + y. Voxel (x, y, z) is stored if bit x of its row is set; its code is then
 * codes[first + before[row] + number of lower bits set in the row]. */
typedef struct VoxelBrick {
    uint32_t first;
    uint16_t before[BRICK_ROWS];
    uint8_t mask[BRICK_ROWS];
} VoxelBrick;

typedef struct VoxelLevel {
    int size[3];        /* voxels */
    int brick_size[3];  /* bricks */
    float sides[3];     /* of a voxel */
    float per_side[3];  /* 1 / sides */
    float density_unit; /* 1 / the voxel's side along the longest axis of the extent */
    int32_t *index;     /* per brick, x fastest; −1: nothing in it */
    uint8_t *reached;   /* per brick: some point of it is within reach (interpolation) of an occupied voxel */
    VoxelBrick *bricks;
    VoxelCode *codes;
    size_t brick_count, code_count;
} VoxelLevel;

struct VoxelLayer {
    int levels;
    bool cyclic[3];
    VoxelLevel level[TEXEL_MAX_LEVELS];
    MemoryBudget *memory;
    size_t bytes; /* taken from memory */
};

static inline size_t voxel_level_bricks(const VoxelLevel *level) {
    return (size_t)level->brick_size[0] * (size_t)level->brick_size[1] * (size_t)level->brick_size[2];
}
static inline size_t voxel_level_brick_at(const VoxelLevel *level, int x, int y, int z) {
    return ((size_t)z * (size_t)level->brick_size[1] + (size_t)y) * (size_t)level->brick_size[0] + (size_t)x;
}
/* Whether the axis has fewer voxels at level + 1. */
static inline bool voxel_layer_halves(const VoxelLayer *layer, int level, int axis) {
    return layer->level[level].size[axis] > 1;
}

/* A layer without voxels; sizes and levels set, nothing allocated but itself. NULL when memory ran out. */
VoxelLayer *voxel_layer_create(const TexelBuildOptions *options);
/* Zeroed memory that belongs to the layer; NULL when there is none left. */
void *voxel_layer_allocate(VoxelLayer *layer, size_t count, size_t size);
/* Fills `reached` of a level from its bricks. */
void voxel_level_mark_reached(VoxelLevel *level, const bool cyclic[3]);
/* Of every byte that reading depends on. */
Hash128 voxel_layer_hash(const VoxelLayer *layer);

#endif
