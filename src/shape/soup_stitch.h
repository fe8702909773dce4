/* Surfaces that were cut along the same curves become one closed surface. */
#ifndef VTS_SHAPE_SOUP_STITCH_H
#define VTS_SHAPE_SOUP_STITCH_H

#include "shape/soup.h"

/* For the triangles after the mark: ends of open edges that are nearer to each other than `reach` (along each axis) become one place, and gaps
 * no wider than a few times that are filled. Vertices keep their own normals. Scratch memory stays in `arena`. */
void soup_stitch(Arena *arena, TriangleSoup *soup, SoupMark since, double reach);
/* Sets `solid` of the triangles after the mark: of each part whose triangles hang together by edges (found by equal places),
 * whether every edge has an even number of triangles. */
void soup_mark_closed(Arena *arena, TriangleSoup *soup, SoupMark since);

#endif
