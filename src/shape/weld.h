/* Which points are one, and which cells share an edge. */
#ifndef VTS_SHAPE_WELD_H
#define VTS_SHAPE_WELD_H

#include "base/arena.h"
#include "base/vec.h"

/* Gives each point the number of its place: points within `tolerance` (>= 0) of an earlier place, along each axis, join it.
 * Places are numbered from 0 in the order of their first points. Returns the number of places; place[i] in [0, that).
 * Not transitive: chains of close points may make several places. Scratch memory stays in `arena`. */
uint32_t weld_points(const Vec3 *points, size_t count, double tolerance, Arena *arena, uint32_t *place);
/* A tolerance for points of a scene's coordinates: rounding errors, no detail. 1e-9 of the largest extent. */
double weld_tolerance(const Vec3 *points, size_t count);

/* One side of an edge: edge `edge` of cell `cell`, between vertices lo < hi; `forward` where the cell runs from lo to hi. */
typedef struct WeldEdge {
    uint32_t lo, hi, cell;
    uint8_t edge;
    bool forward;
} WeldEdge;

/* Sorts the sides so that those of one edge stand together, by cell and edge; deterministic. vertex_count > all hi. */
void weld_sort_edges(WeldEdge *edges, size_t count, size_t vertex_count, Arena *scratch);

#endif
