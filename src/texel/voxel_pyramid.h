/* The cells of all levels from binned triangles, coded brick by brick. */
#ifndef VTS_TEXEL_VOXEL_PYRAMID_H
#define VTS_TEXEL_VOXEL_PYRAMID_H

#include "texel/grow_buffer.h"
#include "texel/voxel_bin.h"
#include "texel/voxel_cell.h"
#include "texel/voxel_fill.h"

/* A coded brick on its way into the layer; its codes are in the same output, from `first` on. */
typedef struct BuiltBrick {
    int level;
    uint32_t place; /* in the level's index */
    size_t first, count;
    uint64_t slice[BRICK_SIDE];
} BuiltBrick;

typedef struct PyramidOutput {
    GrowBuffer bricks; /* BuiltBrick */
    GrowBuffer codes;  /* VoxelCode */
} PyramidOutput;

enum {
    BRICK_AREA = 1,   /* some triangle meets it */
    BRICK_INSIDE = 2, /* it lies within a solid as a whole */
    BRICK_BUILT = 4,  /* it, or one below it, has voxels: area, or the inside next to it */
};

/* A part of the pyramid is the tree under one brick: bricks are built from the finest up, and coded when their parent is
 * known; only the children of one brick per level are in memory as cells. */
typedef struct Pyramid {
    const TexelMesh *mesh;
    const VoxelLayer *layer;
    const TriangleBins *bins;
    const VoxelFill *fill;
    const TexelField *field; /* or NULL */
    uint8_t *marks[TEXEL_MAX_LEVELS]; /* per brick: BRICK_… */
    /* Level whose bricks are built as parallel jobs; their cells are kept for the levels above. */
    int job_level;
    VoxelCell **job_cells; /* per brick of job_level: BRICK_VOXELS cells, or NULL */
} Pyramid;

enum { PYRAMID_CHILDREN = 8 };

/* Builds the cells of brick `at` of `level` (cleared by the caller) and codes all bricks below it. scratch:
 * PYRAMID_CHILDREN · BRICK_VOXELS cells for each level below. from_top: at the job level, takes the kept cells instead. */
void pyramid_build_brick(const Pyramid *pyramid, int level, const int at[3], bool from_top, VoxelCell *cells,
                         VoxelCell *scratch, PyramidOutput *out);

/* Codes the topmost brick, which has no parent. */
void pyramid_code_top(const Pyramid *pyramid, const VoxelCell *cells, PyramidOutput *out);

#endif
