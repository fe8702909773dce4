/* What the builder knows of a voxel before it is coded, and how cells are merged into the cell of the next level. */
#ifndef VTS_TEXEL_VOXEL_CELL_H
#define VTS_TEXEL_VOXEL_CELL_H

#include "texel/texel.h"

/* Coverage is known from 8 × 8 rays along each axis: bit 8·row + column, axis k's columns run along axis k + 1 and its
 * rows along k + 2 (cyclically). Merging keeps one ray in four, always the same ones, so that each bit stays a true ray. */
typedef struct VoxelCell {
    float sheet, solid;   /* area of open sheets; of walls of solids, both walls counted */
    float normals[6];     /* sum of area · n nᵗ: xx yy zz xy xz yz */
    float walls, bodies;  /* walls of solids that the rays met, and solids: a pair of walls, or one wall alone */
    uint64_t cover[3];    /* rays that met anything */
    uint64_t inside[3];   /* rays that met an odd number of walls: they leave, or came, inside a solid */
} VoxelCell;

/* The cell as it is drawn. */
typedef struct VoxelMatter {
    float density;  /* in units of 1/side */
    float gamma;
    Sym3f root;     /* square root of S */
} VoxelMatter;

/* Smallest ratio of axis projections, so that S can be inverted. */
#define VOXEL_ROUGHNESS 0.02f

static inline bool voxel_cell_is_empty(const VoxelCell *cell) { return !(cell->sheet + cell->solid > 0); }
/* Area with the two walls of a solid counted once where both are in the cell. */
float voxel_cell_area(const VoxelCell *cell);

/* The step from one level to the next. */
typedef struct VoxelMerge {
    int level;      /* the parent's: chooses the rays kept */
    bool halved[3]; /* whether there are two children along the axis */
    float rays[3];  /* per axis: rays of the finest level for which a ray of the parent stands */
} VoxelMerge;

/* Adds `child` to `parent`, in any order, each once. corner: which half of the parent along each axis (0 or 1; 0 where not
 * halved). */
void voxel_cell_merge(VoxelCell *parent, const VoxelCell *child, const VoxelMerge *step, const int corner[3]);

/* sides: lengths of the cell; side: the length h by which rays will be marched (opacity.h). */
VoxelMatter voxel_cell_matter(const VoxelCell *cell, const float sides[3], float side);

#endif
