/* Heights where a map has none: a membrane fastened to the rim of each void. */
#ifndef VTS_TERRAIN_POST_FILL_H
#define VTS_TERRAIN_POST_FILL_H

#include "terrain/posts.h"

/* A rectangle of posts. */
typedef struct PostRect {
    int column, row, columns, rows;
} PostRect;

bool post_is_within(const PostRect *rects, size_t count, int column, int row);

/* Fills the voids within the rectangles. What is filled lies between the lowest and the highest height; nothing happens where there is
 * no height at all. The same heights whatever else the lattice holds far away, and in whichever order it was made. */
void post_fill(Posts *posts, const PostRect *rects, size_t rect_count, Arena *arena);

#endif
