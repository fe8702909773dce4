/* Grids of densities: numbers in the cells of the unit cube. */
#ifndef VTS_VOLUME_GRID_H
#define VTS_VOLUME_GRID_H

#include "base/arena.h"
#include "scene/scene.h"

#include <stdatomic.h>

/* Between the centres of cells, trilinear. Outside of the unit cube there is nothing; an axis that is cyclic (bit 0 x, 1 y, 2 z) goes
 * on with the other side. The mean over any cells' boxes far from the rim is that of their numbers. */
double grid_value(const DensityGrid *grid, unsigned cyclic, Vec3 p);

/* The largest numbers in blocks of cells, for leaving out what is empty. */
typedef struct GridRange {
    int size[3];
    const float *most;
    const DensityGrid *grid;
} GridRange;

GridRange grid_range(const DensityGrid *grid, Arena *arena);
/* No value that grid_value() gives in the box is larger. */
double grid_range_most(const GridRange *range, unsigned cyclic, Box3 box);

/* A noise of fractal character: fbm of gradient noise whose surfaces of equal value have this fractal dimension (2 to 3), scaled so that
 * what is below `threshold` of its range is 0 and its top 1. Cells are cubes: the longest side of the grid is four wavelengths. False when `interrupted` (may be NULL) became
 * true. */
bool grid_fractal(const int size[3], double dimension, double threshold, uint32_t seed, const atomic_bool *interrupted, Arena *arena,
                  DensityGrid *out);

#endif
