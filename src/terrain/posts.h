/* Heights of a lattice, kept in blocks, each as compactly as its samples allow without loss: a number for all, codes of two bytes, or
 * floats. A height is a float; NaN where there is none. */
#ifndef VTS_TERRAIN_POSTS_H
#define VTS_TERRAIN_POSTS_H

#include "base/arena.h"

enum { POST_BLOCK = 128, POST_BLOCK_COUNT = POST_BLOCK * POST_BLOCK }; /* posts along a side of a block, and in it */

/* From a file's samples to metres. */
typedef struct PostScale {
    double scale, offset, unit;
} PostScale;
static inline float post_scale_apply(const PostScale *s, double sample) {
    return (float)((sample * s->scale + s->offset) * s->unit);
}

typedef struct PostBlock PostBlock;

typedef struct Posts {
    int columns, rows;
    int block_columns, block_rows;
    const PostBlock **blocks; /* NULL: nothing in it */
} Posts;

void posts_init(Posts *posts, Arena *arena, int columns, int rows);

/* The height of a post; NaN for those outside too. */
float posts_get(const Posts *posts, int column, int row);
/* Every step-th post from (column, row) on into rows of `stride` floats. */
void posts_read(const Posts *posts, int column, int row, int step, int columns, int rows, float *out, size_t stride);

/* A block whole, in rows of POST_BLOCK floats; NaN beyond the lattice. */
void posts_load_block(const Posts *posts, int block_column, int block_row, float out[POST_BLOCK_COUNT]);
/* Replaces a block. Samples that came through `scale` are kept as codes where that is without loss. */
void posts_store_block(Posts *posts, Arena *arena, int block_column, int block_row, const float heights[POST_BLOCK_COUNT],
                       const PostScale *scale);
/* Whether the arena's budget lets it grow by `size` bytes: for those who hold what must be given back before running out of memory. */
bool posts_have_room(const Arena *arena, size_t size);
/* Posts of the block that have no height, those beyond the lattice not counted. */
size_t posts_voids_in(const Posts *posts, int block_column, int block_row);

#endif
