/* Push and pull (Gortler et al. 1996, section 3.4) with relaxation: means of what is there go up a pyramid; on the way down each void
 * takes the bilinear interpolation of the level above, and some steps of Jacobi's iteration for Laplace's equation, the rim being fixed,
 * take the pyramid's grain out of it. The three finest levels are made for a block and its surroundings only, as far as they
 * matter to the block: neighbouring blocks come to the same values without having room for the whole lattice. */
#include "terrain/post_fill.h"

#include <string.h>

enum {
    STEPS = 6,
    FINE_LEVELS = 3,   /* 0: posts, 1: 2 x 2 posts, 2: 4 x 4 posts */
    COARSE_SIDE = 8,   /* posts along a cell of the first level that is kept */
    COARSE_LEVELS = 30,
    /* Posts around a block that it depends on: STEPS and one for the interpolation at each fine level, in the level's cells. */
    MARGIN = 48,
    WINDOW = POST_BLOCK + 2 * MARGIN
};

/* Cells of one level; those that were void are marked until they are final. */
typedef struct Level {
    int columns, rows;
    float *heights;
    bool *open;
} Level;

static size_t level_at(const Level *level, int column, int row) { return (size_t)row * (size_t)level->columns + (size_t)column; }
static float level_clamped(const Level *level, int column, int row) {
    return level->heights[level_at(level, int_clamp(column, 0, level->columns - 1), int_clamp(row, 0, level->rows - 1))];
}

static Level level_make(Arena *arena, int columns, int rows) {
    size_t count = (size_t)columns * (size_t)rows;
    return (Level){columns, rows, arena_new_array(arena, float, count), arena_new_array(arena, bool, count)};
}

/* Means of 2 x 2 cells, of those that are there. */
static void level_push(const Level *from, Level *to) {
    for (int r = 0; r < to->rows; r++)
        for (int c = 0; c < to->columns; c++) {
            double sum = 0;
            int count = 0;
            for (int k = 0; k < 4; k++) {
                int column = 2 * c + (k & 1), row = 2 * r + (k >> 1);
                if (column >= from->columns || row >= from->rows) continue;
                float h = from->heights[level_at(from, column, row)];
                if (isnan(h)) continue;
                sum += (double)h;
                count++;
            }
            to->heights[level_at(to, c, r)] = count ? (float)(sum / count) : NAN;
        }
}

/* Bilinear at the middle of a cell of the next finer level, whose cell (0, 0) lies in the corner of `level`'s cell (column0, row0). */
static float level_between(const Level *level, int column0, int row0, int column, int row) {
    int c = column0 + (column >> 1), r = row0 + (row >> 1);
    int c2 = c + (column & 1 ? 1 : -1), r2 = r + (row & 1 ? 1 : -1);
    float near = 0.75f * level_clamped(level, c, r) + 0.25f * level_clamped(level, c2, r);
    float far = 0.75f * level_clamped(level, c, r2) + 0.25f * level_clamped(level, c2, r2);
    return 0.75f * near + 0.25f * far;
}

static float mean_of_neighbours(const Level *level, int c, int r) {
    return 0.25f * (level_clamped(level, c - 1, r) + level_clamped(level, c + 1, r) + level_clamped(level, c, r - 1) + level_clamped(level, c, r + 1));
}

/* A row away from the border: both values are there before one is chosen, so that compilers can take several cells at a time. */
static void relax_inside(const float *above, const float *row, const float *below, const bool *open, int columns, float *next) {
    for (int c = 1; c < columns - 1; c++) {
        float mean = 0.25f * (row[c - 1] + row[c + 1] + above[c] + below[c]);
        next[c] = open[c] ? mean : row[c];
    }
}

static void level_relax(Level *level, float *next) {
    int columns = level->columns, rows = level->rows;
    for (int r = 0; r < rows; r++) {
        size_t at = level_at(level, 0, r);
        const float *row = level->heights + at;
        bool inside = r > 0 && r < rows - 1;
        if (inside) relax_inside(row - columns, row, row + columns, level->open + at, columns, next + at);
        for (int c = 0; c < columns; c += inside ? int_max(columns - 1, 1) : 1)
            next[at + (size_t)c] = level->open[at + (size_t)c] ? mean_of_neighbours(level, c, r) : row[c];
    }
    memcpy(level->heights, next, (size_t)columns * (size_t)rows * sizeof *next);
}

/* Fills `level` from the next coarser one, which is whole. `next` has room for the level's cells. */
static void level_pull(Level *level, const Level *above, int column0, int row0, float *next) {
    for (int r = 0; r < level->rows; r++)
        for (int c = 0; c < level->columns; c++) {
            size_t at = level_at(level, c, r);
            level->open[at] = isnan(level->heights[at]);
            if (level->open[at]) level->heights[at] = level_between(above, column0, row0, c, r);
        }
    for (int k = 0; k < STEPS; k++) level_relax(level, next);
}

static float mean_of(const float *heights, int side, size_t stride) {
    double sum = 0;
    int count = 0;
    for (int r = 0; r < side; r++)
        for (int c = 0; c < side; c++) {
            float h = heights[(size_t)r * stride + (size_t)c];
            if (isnan(h)) continue;
            sum += (double)h;
            count++;
        }
    return count ? (float)(sum / count) : NAN;
}

static void make_coarsest_known(const Posts *posts, Level *level) {
    float strip[COARSE_SIDE * POST_BLOCK];
    for (int r = 0; r < level->rows; r++)
        for (int c = 0; c < level->columns; c++) {
            int k = c % (POST_BLOCK / COARSE_SIDE);
            if (k == 0) posts_read(posts, c * COARSE_SIDE, r * COARSE_SIDE, 1, POST_BLOCK, COARSE_SIDE, strip, POST_BLOCK);
            level->heights[level_at(level, c, r)] = mean_of(strip + k * COARSE_SIDE, COARSE_SIDE, POST_BLOCK);
        }
}

/* The level of cells of COARSE_SIDE posts, whole; false where no post has a height. */
static bool make_coarse(const Posts *posts, Arena *arena, Level *out) {
    Level levels[COARSE_LEVELS];
    int count = 1;
    levels[0] = level_make(arena, (posts->columns + COARSE_SIDE - 1) / COARSE_SIDE, (posts->rows + COARSE_SIDE - 1) / COARSE_SIDE);
    make_coarsest_known(posts, &levels[0]);
    for (; levels[count - 1].columns > 1 || levels[count - 1].rows > 1; count++) {
        levels[count] = level_make(arena, (levels[count - 1].columns + 1) / 2, (levels[count - 1].rows + 1) / 2);
        level_push(&levels[count - 1], &levels[count]);
    }
    if (isnan(levels[count - 1].heights[0])) return false;
    float *next = arena_new_array(arena, float, (size_t)levels[0].columns * (size_t)levels[0].rows);
    for (int k = count - 2; k >= 0; k--) level_pull(&levels[k], &levels[k + 1], 0, 0, next);
    *out = levels[0];
    return true;
}

typedef struct Window {
    Level levels[FINE_LEVELS];
    Level above; /* the part of the coarse level over the window, and a cell around */
    float *next;
    int column, row; /* of its first post */
} Window;

enum { ABOVE = WINDOW / COARSE_SIDE + 2 };

static void window_init(Window *window, Arena *arena) {
    for (int k = 0; k < FINE_LEVELS; k++) window->levels[k] = level_make(arena, WINDOW >> k, WINDOW >> k);
    window->above = level_make(arena, ABOVE, ABOVE);
    window->next = arena_new_array(arena, float, (size_t)WINDOW * WINDOW);
}

/* Where the window of a block begins and how long it is, in whole coarse cells; it ends with the lattice. */
static int window_side(int block, int posts, int *first) {
    int cells = (posts + COARSE_SIDE - 1) / COARSE_SIDE;
    *first = int_max(block * POST_BLOCK - MARGIN, 0);
    return int_min((block + 1) * POST_BLOCK + MARGIN, cells * COARSE_SIDE) - *first;
}

static void window_place(Window *window, const Posts *posts, int block_column, int block_row) {
    int columns = window_side(block_column, posts->columns, &window->column), rows = window_side(block_row, posts->rows, &window->row);
    for (int k = 0; k < FINE_LEVELS; k++) window->levels[k].columns = columns >> k, window->levels[k].rows = rows >> k;
    window->above.columns = columns / COARSE_SIDE + 2;
    window->above.rows = rows / COARSE_SIDE + 2;
}

static void window_fill(Window *window, const Posts *posts, const Level *coarse, int block_column, int block_row) {
    window_place(window, posts, block_column, block_row);
    Level *finest = &window->levels[0], *above = &window->above;
    posts_read(posts, window->column, window->row, 1, finest->columns, finest->rows, finest->heights, (size_t)finest->columns);
    for (int k = 1; k < FINE_LEVELS; k++) level_push(&window->levels[k - 1], &window->levels[k]);
    for (int r = 0; r < above->rows; r++)
        for (int c = 0; c < above->columns; c++)
            above->heights[level_at(above, c, r)] =
                level_clamped(coarse, window->column / COARSE_SIDE + c - 1, window->row / COARSE_SIDE + r - 1);
    for (int k = FINE_LEVELS - 1; k >= 0; k--) {
        bool coarsest = k == FINE_LEVELS - 1;
        level_pull(&window->levels[k], coarsest ? above : &window->levels[k + 1], coarsest, coarsest, window->next);
    }
}

bool post_is_within(const PostRect *rects, size_t count, int column, int row) {
    for (size_t i = 0; i < count; i++)
        if (column >= rects[i].column && column - rects[i].column < rects[i].columns && row >= rects[i].row &&
            row - rects[i].row < rects[i].rows)
            return true;
    return false;
}

/* Takes the voids of a block from the window around it. Returns whether there were any to be filled. */
static bool take_block(const Window *window, const PostRect *rects, size_t count, int block_column, int block_row,
                       float out[POST_BLOCK_COUNT]) {
    const Level *level = &window->levels[0];
    bool any = false;
    for (int i = 0; i < POST_BLOCK_COUNT; i++) {
        int column = block_column * POST_BLOCK + i % POST_BLOCK, row = block_row * POST_BLOCK + i / POST_BLOCK;
        int c = column - window->column, r = row - window->row;
        out[i] = NAN;
        if (c >= level->columns || r >= level->rows) continue;
        size_t at = level_at(level, c, r);
        bool wanted = !level->open[at] || post_is_within(rects, count, column, row);
        if (wanted) out[i] = level->heights[at];
        any |= wanted && level->open[at];
    }
    return any;
}

static bool block_has_voids_to_fill(const Posts *posts, const PostRect *rects, size_t count, int block_column, int block_row) {
    if (posts_voids_in(posts, block_column, block_row) == 0) return false;
    int left = block_column * POST_BLOCK, top = block_row * POST_BLOCK;
    for (size_t i = 0; i < count; i++)
        if (rects[i].column < left + POST_BLOCK && rects[i].column + rects[i].columns > left && rects[i].row < top + POST_BLOCK &&
            rects[i].row + rects[i].rows > top)
            return true;
    return false;
}

static void fill_blocks(const Posts *posts, const PostRect *rects, size_t rect_count, const Level *coarse, Arena *scratch, Arena *arena,
                        Posts *out) {
    static const PostScale metres = {1, 0, 1};
    Window window;
    float heights[POST_BLOCK_COUNT];
    window_init(&window, scratch);
    for (int y = 0; y < posts->block_rows; y++)
        for (int x = 0; x < posts->block_columns; x++) {
            if (!block_has_voids_to_fill(posts, rects, rect_count, x, y)) continue;
            window_fill(&window, posts, coarse, x, y);
            if (!posts_have_room(arena, sizeof heights)) {
                arena_destroy(scratch);
                memory_budget_fail(arena->budget);
            }
            if (take_block(&window, rects, rect_count, x, y, heights)) posts_store_block(out, arena, x, y, heights, &metres);
        }
}

static bool has_voids_to_fill(const Posts *posts, const PostRect *rects, size_t rect_count) {
    for (int y = 0; y < posts->block_rows; y++)
        for (int x = 0; x < posts->block_columns; x++)
            if (block_has_voids_to_fill(posts, rects, rect_count, x, y)) return true;
    return false;
}

void post_fill(Posts *posts, const PostRect *rects, size_t rect_count, Arena *arena) {
    if (!has_voids_to_fill(posts, rects, rect_count)) return;
    Arena scratch; /* not charged: a fraction of the posts, and it must be given back when these run out of room */
    Level coarse = {0};
    size_t count = (size_t)posts->block_columns * (size_t)posts->block_rows;
    Posts filled = *posts; /* the voids of the neighbours are needed until all are filled */
    filled.blocks = arena_copy(arena, posts->blocks, count * sizeof *posts->blocks);
    arena_init(&scratch, NULL, 0);
    if (make_coarse(posts, &scratch, &coarse)) fill_blocks(posts, rects, rect_count, &coarse, &scratch, arena, &filled);
    arena_destroy(&scratch);
    *posts = filled;
}
