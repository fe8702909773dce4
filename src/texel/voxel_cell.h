/* What the builder knows of a voxel before it is coded, and how cells are merged into the cell of the next level. */
#ifndef VTS_TEXEL_VOXEL_CELL_H
#define VTS_TEXEL_VOXEL_CELL_H

#include "texel/texel.h"

/* Coverage is known from 8 × 8 rays along each axis: bit 8·row + column, axis k's columns run along axis k + 1 and its
 * rows along k + 2 (cyclically). Merging keeps one ray in four, always the same ones, so that each bit stays a true ray.
 *
 * Walls of solids come in pairs along a ray. How many walls are still without the other one of their pair, in cells and in
 * cells twice as large, tells thin solids from walls that stand alone. */
typedef struct VoxelCell {
    float sheet, solid; /* area of open sheets; of walls of solids, both walls counted */
    float normals[6];   /* sum of area · n nᵗ: xx yy zz xy xz yz. With TEXEL_FILTER_PUBLISHED, in an open merged cell: sum of area · Q⁻¹ */
    float fill;         /* the share of it that lies within solids, of the finest voxels' middles */
    float net[3];       /* until the finest cell is closed: walls that its rays left a solid by, less those that they entered by */
    float single;       /* of `walls`, without the other one of their pair in the cell */
    float apart;        /* the same while pairs had to be in the same child; both are valid once the cell is closed */
    float odd, joined;  /* rays kept that left a child inside a solid, and those of them that met again */
    /* What rays change, beside each other: 64 bytes. */
    float walls;        /* walls that the finest level's rays met in the cell */
    float met[3];       /* how often the rays along an axis met anything, on the mean over them */
    uint64_t cover[3];  /* rays that met anything: a byte of columns for each of eight rows, along voxel_ray_columns() and voxel_ray_rows() */
    uint64_t inside[3]; /* rays that met an odd number of walls */
} VoxelCell;

/* Which axis the columns and rows of rays along an axis count along. Columns go up where they can: what grows, and is higher than wide, is
 * met by few rows. */
static inline int voxel_ray_columns(int axis) { return axis == 1 ? 2 : 1; }
static inline int voxel_ray_rows(int axis) { return axis == 0 ? 2 : 0; }

/* The cell as it is drawn. */
typedef struct VoxelMatter {
    float density; /* in units of 1/side */
    float gamma;
    bool wall; /* of a solid, with its inside behind it */
    Sym3f root; /* square root of S */
} VoxelMatter;

/* Smallest ratio of axis projections, so that S can be inverted. */
#define VOXEL_ROUGHNESS 0.01f

static inline bool voxel_cell_is_empty(const VoxelCell *cell) { return !(cell->sheet + cell->solid > 0); }

/* Nothing but the inside of a solid. */
static inline bool voxel_cell_is_inside(const VoxelCell *cell) {
    return voxel_cell_is_empty(cell) && cell->fill > 0.5f;
}

/* The step from one level to the next. */
typedef struct VoxelMerge {
    int level;      /* the parent's: chooses the rays kept */
    float share;    /* of the parent that a child is */
    TexelFiltering filtering;
    bool halved[3]; /* whether there are two children along the axis */
    float rays[3];  /* per axis: rays of the finest level for which a ray of the parent stands */
} VoxelMerge;

/* Adds `child` (closed) to `parent`, in any order, each once. corner: which half of the parent along each axis (0 or 1; 0
 * where not halved). */
void voxel_cell_merge(VoxelCell *parent, const VoxelCell *child, const VoxelMerge *step, const int corner[3]);
/* To be called once all triangles or children are in. */
void voxel_cell_close_finest(VoxelCell *cell);
void voxel_cell_close_merged(VoxelCell *cell, TexelFiltering filtering);

/* How many of the walls in a closed cell's children are halves of solids thinner than a child, 0 … 1: all where solids are
 * thinner than one side of a child, falling to none at two. fine: all or half of the finest rays are kept; may then be a little more than 1. */
float voxel_cell_thinness(const VoxelCell *parent, bool fine);

/* The cells before and behind a cell along each axis; NULL where it is not known what is there. */
typedef struct VoxelSurround {
    const VoxelCell *near[3][2];
} VoxelSurround;

/* sides: lengths of the cell; side: the length h that opacity.h is told; thin: the parent's thinness; backed: the cell or one around it is
 * the inside of a solid. The two walls of a thin solid count once. */
VoxelMatter voxel_cell_matter(const VoxelCell *cell, const VoxelSurround *around, const float sides[3],
                              float side, float thin, bool backed);
/* Square root of the S of a cell within a solid: as the walls around it are turned, rounded so that it is seen from everywhere. */
Sym3f voxel_cell_root_inside(const VoxelCell *parent);

#endif
