/* Which finest voxels lie within closed solids: by the walls that the lines along y through the voxels' middles meet. */
#ifndef VTS_TEXEL_VOXEL_FILL_H
#define VTS_TEXEL_VOXEL_FILL_H

#include "texel/voxel_layer.h"

typedef struct VoxelFill {
    uint32_t *
        start; /* columns + 1, x fastest: walls[start[c]] … of column c, none if there are no solids (start NULL) */
    int32_t *
        walls; /* 2·y + 1 or 2·y: a wall that faces up or down lies just below the middle of voxel y; in order */
    int32_t *
        below; /* per column: how many more walls face up than down above all of it, by copies on a cyclic axis */
    int size[3];
    size_t bytes;
} VoxelFill;

/* From the mesh's solids. Columns in which walls do not come in pairs hold nothing. False when memory ran out. */
bool voxel_fill_build(VoxelFill *fill, const TexelMesh *mesh, const VoxelLayer *layer, MemoryBudget *memory);
void voxel_fill_free(VoxelFill *fill, MemoryBudget *memory);

/* Bit i: the middle of voxel (x, y + i, z) lies within a solid; i < 8. */
uint32_t voxel_fill_column(const VoxelFill *fill, int x, int y, int z);

#endif
