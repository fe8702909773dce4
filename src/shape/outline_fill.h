/* Areas bounded by outlines, as triangles. */
#ifndef VTS_SHAPE_OUTLINE_FILL_H
#define VTS_SHAPE_OUTLINE_FILL_H

#include "shape/outline.h"

typedef struct OutlineFill {
    const Point2 *points;
    size_t point_count;
    const uint32_t (*triangles)[3]; /* turning from x to y */
    size_t triangle_count;
    const uint32_t (*border)[2]; /* edges of only one triangle, in its direction: the area lies to the left */
    size_t border_count;
    bool too_intricate; /* nothing is filled: millions of triangles */
} OutlineFill;

/* Fills what the outline's curves enclose an odd number of times (`odd`), or wind round. Curves become chords within
 * `tolerance`; they may cross each other and themselves. Lives in `arena`. */
void outline_fill(const Outline *outline, bool odd, double tolerance, Arena *arena, OutlineFill *out);
/* Chords that keep a piece within the tolerance, at most 256. */
int outline_chords(const OutlinePiece *piece, double tolerance);

#endif
