#include "terrain/ground_errors.h"

#include <float.h>
#include <limits.h>

/* Errors are kept as logarithms in steps of an eighth of an octave above a millimetre, rounded up. */
enum { CODE_HOLE = 255, CODE_MOST = 254 };
static const double LEAST = 1e-3;

static uint8_t code_of(double error) {
    if (!(error > 0)) return 0;
    double code = ceil(8 * log2(error / LEAST)) + 1;
    return (uint8_t)double_clamp(code, 1, CODE_MOST);
}

static double error_of(uint8_t code) { return code == 0 || code == CODE_HOLE ? 0 : LEAST * exp2((code - 1) / 8.0); }

/* The posts of a tile at hand, or all of them one by one. */
typedef struct Window {
    const GroundSource *source;
    const float *posts; /* TILE_POSTS in a row; NULL: the source is asked */
    int column, row;    /* of the first */
} Window;

enum { TILE_LEVEL = 7, TILE_SIDE = 1 << TILE_LEVEL, TILE_POSTS = TILE_SIDE + 1 };

static inline double post(const Window *w, int column, int row) {
    return w->posts ? (double)w->posts[(row - w->row) * TILE_POSTS + column - w->column] : ground_source_post(w->source, column, row);
}

static inline double cell_error(const Window *w, int column, int row) {
    double twist = post(w, column, row) + post(w, column + 1, row + 1) - post(w, column + 1, row) - post(w, column, row + 1);
    return fabs(twist) / 4;
}

double ground_cell_error(const GroundSource *s, int column, int row) { return cell_error(&(Window){.source = s}, column, row); }

typedef struct Square {
    int x, y, side; /* in posts */
    bool rising;    /* the diagonal of its triangles runs from (x, y) on */
} Square;

static inline double miss(double middle, double a, double b) {
    double off = fabs(middle - 0.5 * (a + b));
    return off <= DBL_MAX ? off : 0;
}

/* What the first halvings of the triangles of a square move: of the diagonal, and then of the sides. */
static double own_error(const Window *w, const Square *q) {
    int x0 = q->x, y0 = q->y, x1 = x0 + q->side, y1 = y0 + q->side, x = x0 + q->side / 2, y = y0 + q->side / 2;
    double corner[4] = {post(w, x0, y0), post(w, x1, y0), post(w, x1, y1), post(w, x0, y1)};
    double centre = miss(post(w, x, y), corner[!q->rising], corner[2 + !q->rising]);
    double north = miss(post(w, x, y0), corner[0], corner[1]), south = miss(post(w, x, y1), corner[3], corner[2]);
    double west = miss(post(w, x0, y), corner[0], corner[3]), east = miss(post(w, x1, y), corner[1], corner[2]);
    return centre + fmax(fmax(north, south), fmax(west, east));
}

/* What is known of the quarters of a square. */
typedef struct Quarters {
    double error;
    bool some, gaps;
} Quarters;

static void add_cell(const Window *w, int column, int row, Quarters *out) {
    if (column >= w->source->columns - 1 || row >= w->source->rows - 1) return;
    double error = cell_error(w, column, row);
    if (isnan(error)) out->gaps = true;
    else out->some = true, out->error = fmax(out->error, error);
}

static void add_square(const GroundErrors *e, int level, int column, int row, Quarters *out) {
    if (column >= e->columns[level] || row >= e->rows[level]) return;
    uint8_t code = e->codes[level][(size_t)row * (size_t)e->columns[level] + (size_t)column];
    if (code == CODE_HOLE) out->gaps = true;
    else out->some = true, out->error = fmax(out->error, error_of(code));
}

static uint8_t square_code(const Window *w, const GroundErrors *e, int level, int column, int row) {
    Quarters quarters = {0};
    for (int k = 0; k < 4; k++) {
        int c = 2 * column + (k & 1), r = 2 * row + (k >> 1);
        if (level == 1) add_cell(w, c, r, &quarters);
        else add_square(e, level - 1, c, r, &quarters);
    }
    if (!quarters.some) return CODE_HOLE;
    const Square square = {column << level, row << level, 1 << level, (column + row) % 2 == 0};
    double error = own_error(w, &square) + quarters.error;
    if (quarters.gaps) error = fmax(error, w->source->spacing * square.side);
    return code_of(error);
}

typedef struct TileJob {
    const GroundSource *source;
    GroundErrors *errors;
    int across; /* tiles */
} TileJob;

static void code_squares(const Window *w, GroundErrors *e, int level, int column0, int row0, int column1, int row1) {
    for (int r = row0; r < int_min(row1, e->rows[level]); r++)
        for (int c = column0; c < int_min(column1, e->columns[level]); c++)
            e->codes[level][(size_t)r * (size_t)e->columns[level] + (size_t)c] = square_code(w, e, level, c, r);
}

static void read_tile(const GroundSource *s, int column, int row, float *posts) {
    if (s->block && column + TILE_POSTS <= s->columns && row + TILE_POSTS <= s->rows) {
        s->block(s->map, column, row, TILE_POSTS, TILE_POSTS, posts);
        return;
    }
    for (int r = 0; r < TILE_POSTS; r++)
        for (int c = 0; c < TILE_POSTS; c++) posts[r * TILE_POSTS + c] = (float)ground_source_post(s, column + c, row + r);
}

static void code_tile(void *context, size_t index, int worker) {
    (void)worker;
    const TileJob *job = context;
    int column = (int)index % job->across, row = (int)index / job->across;
    float posts[TILE_POSTS * TILE_POSTS];
    const Window window = {job->source, posts, column * TILE_SIDE, row * TILE_SIDE};
    read_tile(job->source, window.column, window.row, posts);
    for (int level = 1; level <= int_min(TILE_LEVEL, job->errors->levels); level++) {
        int side = TILE_SIDE >> level;
        code_squares(&window, job->errors, level, column * side, row * side, (column + 1) * side, (row + 1) * side);
    }
}

static int squares_across(int posts, int level) {
    int cells = posts - 1, side = 1 << level;
    return cells / side + (cells % side != 0);
}

void ground_errors_build(const GroundSource *source, Pool *pool, Arena *arena, GroundErrors *out) {
    *out = (GroundErrors){.levels = 1};
    while (out->levels < GROUND_MOST_LEVELS && 1 << out->levels < int_max(source->columns, source->rows) - 1) out->levels++;
    for (int level = 1; level <= out->levels; level++) {
        out->columns[level] = squares_across(source->columns, level);
        out->rows[level] = squares_across(source->rows, level);
        out->codes[level] = arena_new_array(arena, uint8_t, (size_t)out->columns[level] * (size_t)out->rows[level]);
    }
    const Window all = {.source = source};
    TileJob job = {source, out, squares_across(source->columns, TILE_LEVEL)};
    pool_run(pool, (size_t)job.across * (size_t)squares_across(source->rows, TILE_LEVEL), code_tile, &job);
    for (int level = TILE_LEVEL + 1; level <= out->levels; level++) code_squares(&all, out, level, 0, 0, INT_MAX, INT_MAX);
}

static uint8_t code_at(const GroundErrors *e, int level, int column, int row) {
    if (column >= e->columns[level] || row >= e->rows[level]) return CODE_HOLE;
    return e->codes[level][(size_t)row * (size_t)e->columns[level] + (size_t)column];
}

double ground_error(const GroundErrors *errors, int level, int column, int row) { return error_of(code_at(errors, level, column, row)); }

bool ground_is_hole(const GroundErrors *errors, int level, int column, int row) { return code_at(errors, level, column, row) == CODE_HOLE; }
