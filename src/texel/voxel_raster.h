/* A brick's cells from its triangles: areas, normals, and what 8 × 8 rays along each axis of every voxel meet. */
#ifndef VTS_TEXEL_VOXEL_RASTER_H
#define VTS_TEXEL_VOXEL_RASTER_H

#include "texel/voxel_cell.h"
#include "texel/voxel_clip.h"
#include "texel/voxel_layer.h"

/* Adds a triangle, given in voxels from the brick's corner, to the cells (x fastest) of the brick, of which `size` voxels
 * exist along each axis. sides: of a voxel, in texel space. */
void voxel_raster_add(VoxelCell cells[BRICK_VOXELS], const ClipPolygon *triangle, bool solid,
                      const int size[3], const float sides[3]);

#endif
