/* Where the corners of a regular grid are inside a solid, and the surface between them: one vertex for each sheet that passes a
 * cell, joined across the grid's edges (dual contouring; Gibson 1998, Nielson 2004). Closed wherever it does not leave the grid. */
#ifndef VTS_SHAPE_INSIDE_GRID_H
#define VTS_SHAPE_INSIDE_GRID_H

#include "shape/solid_project.h"
#include "shape/soup.h"

#include <stdatomic.h>

typedef struct InsideGrid {
    Vec3 origin, step; /* of the corners */
    uint32_t size[3];  /* corners along each axis, at least 2 */
    uint8_t *inside;   /* per corner, x fastest */
    size_t missed;     /* parts or gaps seen between two corners that are alike: too thin for the grid */
} InsideGrid;

/* Fills a grid over the box, `cells` along its longest side; false where the box does not end or has no extent, and when interrupted (which
 * may be NULL). */
bool inside_grid_fill(const ExactSurface *surface, Box3 box, uint32_t cells, const atomic_bool *interrupted, Arena *arena, InsideGrid *out);
/* Appends the surface; vertices are the means of the middles of the edges that it crosses, normals are not set. */
void inside_grid_surface(const InsideGrid *grid, Arena *arena, TriangleSoup *out);

#endif
