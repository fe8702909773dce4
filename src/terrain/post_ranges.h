/* Lowest and highest heights over squares of a lattice, in levels: what the ground lies in, without looking at all posts. */
#ifndef VTS_TERRAIN_POST_RANGES_H
#define VTS_TERRAIN_POST_RANGES_H

#include "terrain/posts.h"

typedef struct PostRange {
    float low, high; /* low > high: nothing there */
    bool whole;      /* every post has a height */
} PostRange;

static inline PostRange post_range_none(void) { return (PostRange){INFINITY, -INFINITY, false}; }
PostRange post_range_union(PostRange a, PostRange b);

enum { POST_RANGE_LEVELS = 32, POST_RANGE_FIRST = 3 };

/* A cell of level k holds the posts from 2^(k + POST_RANGE_FIRST) times its column and row to the first of the next cell, inclusive:
 * what the bilinear ground over it depends on. */
typedef struct PostRanges {
    int level_count;
    int columns[POST_RANGE_LEVELS], rows[POST_RANGE_LEVELS];
    PostRange *cells[POST_RANGE_LEVELS];
} PostRanges;

void post_ranges_make(PostRanges *ranges, const Posts *posts, Arena *arena);

/* Of the ground between the posts (column0, row0) and (column1, row1), in either order: never too narrow. Not whole where some of it is
 * outside of the lattice. */
PostRange post_ranges_over(const PostRanges *ranges, const Posts *posts, int column0, int row0, int column1, int row1);

#endif
