/* Inside of a voxel layer: per level a flat index of bricks of 8³ voxels; a brick keeps only its occupied voxels. */
#ifndef VTS_TEXEL_VOXEL_LAYER_H
#define VTS_TEXEL_VOXEL_LAYER_H

#include "texel/texel.h"
#include "texel/voxel_code.h"

enum { BRICK_SIDE = 8, BRICK_VOXELS = 512, PLAIN_FLOATS = 12 };
/* Levels of up to 8 voxels, and directions each way, for which it is known how much they have to be trimmed. */
enum { TRIM_LEVELS = 7, TRIM_NODES = 9 };
/* Directions that are looked along in pairs: the zenith, and rings of so many below it. */
enum { PAIR_RINGS = 4, PAIR_RING = 8, PAIR_NODES = 1 + PAIR_RINGS * PAIR_RING, PAIR_HEIGHTS = 1 + PAIR_RINGS };

/* Voxel (x, y, z) is stored if bit 8·y + x of slice[z] is set; its code is then
 * codes[first[z] + number of lower bits set in the slice]. */
typedef struct VoxelBrick {
    uint64_t slice[BRICK_SIDE];
    uint32_t first[BRICK_SIDE];
} VoxelBrick;

static inline uint32_t count_bits(uint64_t x) {
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (uint32_t)(x * 0x0101010101010101u >> 56);
}

static inline uint32_t count_bits_of_byte(uint32_t x) {
    x -= x >> 1 & 0x55u;
    x = (x & 0x33u) + (x >> 2 & 0x33u);
    return (x + (x >> 4)) & 0x0fu;
}

/* Where interpolation can find anything, one bit for each cell of eight voxel centres. Cell (x, y, z) lies between the centres
 * of voxels x − 1 and x, …: there is one more of them than voxels. Only bricks of 8³ cells with a set bit are kept. */
typedef struct VoxelSupport {
    int brick_size[3];   /* bricks of cells */
    int32_t *index;      /* per brick, x fastest; −1: all empty */
    uint64_t (*bits)[8]; /* [z] bit 8·y + x */
    size_t count;
} VoxelSupport;

typedef struct VoxelLevel {
    int size[3];        /* voxels */
    int brick_size[3];  /* bricks */
    float sides[3];     /* of a voxel */
    float per_side[3];  /* 1 / sides */
    float density_unit; /* 1 / the voxel's side along the longest axis of the extent */
    int32_t *index;     /* per brick, x fastest; −1: nothing in it */
    VoxelSupport support;
    VoxelBrick *bricks;
    VoxelCode *codes; /* two more than code_count: readers look past the last before they know */
    size_t brick_count, code_count;
    /* While voxel_layer_unpack() has it so, codes taken apart, behind one that is empty, and the number there of each voxel and of one more along each axis, x fastest; else NULL. */
    float (*plain)[PLAIN_FLOATS];
    uint16_t *plain_at;
} VoxelLevel;

/* Angles over which what is seen and what is lit forget each other, radians: up and down, and around the zenith, by height; 0: not known. */
typedef struct PairWidths {
    float at[2][PAIR_HEIGHTS];
} PairWidths;

/* What eye and light have in common: voxel_pairs.h. */
typedef struct VoxelPairs {
    float lit[PAIR_NODES * PAIR_NODES]; /* by direction to the eye, then to the light; below 0: not known */
    PairWidths glow, spot;            /* of matter, and of the ground */
    PairWidths peak[2][TRIM_LEVELS];  /* the same of what voxels do not know of that, by level as powers */
    uint8_t matter[TRIM_LEVELS][PAIR_NODES * PAIR_NODES], ground[TRIM_LEVELS][PAIR_NODES * PAIR_NODES]; /* powers: voxel_lit.h */
    uint8_t facing[2][TRIM_LEVELS][PAIR_NODES * PAIR_NODES]; /* factors: voxel_lit.h */
} VoxelPairs;

struct VoxelLayer {
    int owners; /* voxel_layer_destroy() takes one away */
    int levels;
    bool cyclic[3];
    bool scattered; /* all matter is random: gamma is 0 */
    TexelFiltering filtering;
    VoxelLevel level[TEXEL_MAX_LEVELS];
    float trim[TRIM_LEVELS][TRIM_NODES * TRIM_NODES]; /* of the coarsest levels, the last first, by direction: voxel_trim.h */
    VoxelPairs pairs;
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
/* Fills `support` of a level from its bricks; false when memory ran out. */
bool voxel_level_mark_support(VoxelLayer *layer, VoxelLevel *level);
/* Lays the voxels of coarse levels side by side, taken apart, so that reading them, which gives the same, takes a third of the time: for building, which reads each
 * many times. Of levels that would take much memory, or when there is none, nothing. Ends with voxel_layer_pack(). */
void voxel_layer_unpack(VoxelLayer *layer);
void voxel_layer_pack(VoxelLayer *layer);
/* Of every byte that reading depends on. */
Hash128 voxel_layer_hash(const VoxelLayer *layer);

#endif
