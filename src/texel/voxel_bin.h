/* Which triangles, and which of their cyclic copies, meet which finest brick. */
#ifndef VTS_TEXEL_VOXEL_BIN_H
#define VTS_TEXEL_VOXEL_BIN_H

#include "texel/voxel_clip.h"
#include "texel/voxel_layer.h"

typedef struct BinnedTriangle {
    uint32_t triangle;
    uint8_t shift
        [4]; /* extents by which the copy is moved down, counted from the one that holds its smallest corner */
} BinnedTriangle;

typedef struct TriangleBins {
    uint32_t
        *start; /* bricks + 1: items[start[b]] … items[start[b + 1] − 1] meet brick b, in the mesh's order */
    BinnedTriangle *items;
    size_t count, bricks;
} TriangleBins;

/* A triangle in voxels of the finest level, moved by whole extents along cyclic axes so that its smallest corner lies in
 * the first; false if it has no finite area or spans more than MAX_COPIES extents. */
bool bin_load_triangle(const TexelMesh *mesh, const VoxelLayer *layer, size_t triangle, ClipPolygon *out);

/* False when memory ran out or the pool was cancelled. Memory is released by triangle_bins_free(). */
bool triangle_bins_build(TriangleBins *bins, const TexelMesh *mesh, const VoxelLayer *layer,
                         const TexelBuildOptions *options);
void triangle_bins_free(TriangleBins *bins, MemoryBudget *memory);

#endif
