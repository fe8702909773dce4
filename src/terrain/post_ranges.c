#include "terrain/post_ranges.h"

enum { FIRST_SIDE = 1 << POST_RANGE_FIRST };

PostRange post_range_union(PostRange a, PostRange b) {
    return (PostRange){float_min(a.low, b.low), float_max(a.high, b.high), a.whole && b.whole};
}

static PostRange range_of(const float *heights, int columns, int rows, size_t stride) {
    PostRange range = {INFINITY, -INFINITY, true};
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            float h = heights[(size_t)r * stride + (size_t)c];
            range.whole &= !isnan(h);
            range.low = h < range.low ? h : range.low;
            range.high = h > range.high ? h : range.high;
        }
    return range;
}

static int cells_of(int posts, int side) { return int_max(1, (posts - 1 + side - 1) / side); }

static PostRange *add_level(PostRanges *ranges, Arena *arena, int columns, int rows) {
    int level = ranges->level_count++;
    ranges->columns[level] = columns;
    ranges->rows[level] = rows;
    return ranges->cells[level] = arena_new_array(arena, PostRange, (size_t)columns * (size_t)rows);
}

static void make_first_level(PostRanges *ranges, const Posts *posts, Arena *arena) {
    enum { WIDTH = POST_BLOCK + 1 };
    float rows[(FIRST_SIDE + 1) * WIDTH];
    int width = cells_of(posts->columns, FIRST_SIDE), height = cells_of(posts->rows, FIRST_SIDE);
    PostRange *cells = add_level(ranges, arena, width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x += POST_BLOCK / FIRST_SIDE) {
            int row = y * FIRST_SIDE, column = x * FIRST_SIDE;
            int here = int_min(FIRST_SIDE + 1, posts->rows - row);
            posts_read(posts, column, row, 1, WIDTH, here, rows, WIDTH);
            for (int k = 0; k < POST_BLOCK / FIRST_SIDE && x + k < width; k++) {
                int across = int_min(FIRST_SIDE + 1, posts->columns - column - k * FIRST_SIDE);
                cells[(size_t)y * (size_t)width + (size_t)(x + k)] = range_of(rows + k * FIRST_SIDE, across, here, WIDTH);
            }
        }
}

static void make_next_level(PostRanges *ranges, Arena *arena) {
    int below = ranges->level_count - 1, w = ranges->columns[below], h = ranges->rows[below];
    int width = (w + 1) / 2, height = (h + 1) / 2;
    const PostRange *from = ranges->cells[below];
    PostRange *cells = add_level(ranges, arena, width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            PostRange range = {INFINITY, -INFINITY, true};
            for (int b = 2 * y; b < int_min(2 * y + 2, h); b++)
                for (int a = 2 * x; a < int_min(2 * x + 2, w); a++) range = post_range_union(range, from[(size_t)b * (size_t)w + (size_t)a]);
            cells[(size_t)y * (size_t)width + (size_t)x] = range;
        }
}

void post_ranges_make(PostRanges *ranges, const Posts *posts, Arena *arena) {
    *ranges = (PostRanges){0};
    make_first_level(ranges, posts, arena);
    while (ranges->columns[ranges->level_count - 1] > 1 || ranges->rows[ranges->level_count - 1] > 1) make_next_level(ranges, arena);
}

/* Between posts that lie in the lattice, from the posts themselves. */
static PostRange range_of_few(const Posts *posts, int column0, int row0, int column1, int row1) {
    enum { SIDE = 2 * FIRST_SIDE + 1 };
    float heights[SIDE * SIDE];
    posts_read(posts, column0, row0, 1, column1 - column0 + 1, row1 - row0 + 1, heights, SIDE);
    return range_of(heights, column1 - column0 + 1, row1 - row0 + 1, SIDE);
}

/* By the finest level whose cells, at most 4 x 4 of them, cover what is asked. */
static PostRange range_of_cells(const PostRanges *ranges, int column0, int row0, int column1, int row1) {
    int level = 0;
    while (level + 1 < ranges->level_count && int_max(column1 - column0, row1 - row0) >> (level + POST_RANGE_FIRST) > 3) level++;
    int shift = level + POST_RANGE_FIRST, width = ranges->columns[level];
    int x1 = int_min(int_max(column1 - 1, column0) >> shift, width - 1), y1 = int_min(int_max(row1 - 1, row0) >> shift, ranges->rows[level] - 1);
    PostRange range = {INFINITY, -INFINITY, true};
    for (int y = int_min(row0 >> shift, y1); y <= y1; y++)
        for (int x = int_min(column0 >> shift, x1); x <= x1; x++)
            range = post_range_union(range, ranges->cells[level][(size_t)y * (size_t)width + (size_t)x]);
    return range;
}

PostRange post_ranges_over(const PostRanges *ranges, const Posts *posts, int column0, int row0, int column1, int row1) {
    int left = int_max(int_min(column0, column1), 0), right = int_min(int_max(column0, column1), posts->columns - 1);
    int top = int_max(int_min(row0, row1), 0), bottom = int_min(int_max(row0, row1), posts->rows - 1);
    if (left > right || top > bottom) return post_range_none();
    bool inside = left == int_min(column0, column1) && right == int_max(column0, column1) && top == int_min(row0, row1) &&
                  bottom == int_max(row0, row1);
    bool few = right - left <= 2 * FIRST_SIDE && bottom - top <= 2 * FIRST_SIDE;
    PostRange range = few ? range_of_few(posts, left, top, right, bottom) : range_of_cells(ranges, left, top, right, bottom);
    range.whole &= inside;
    return range;
}
