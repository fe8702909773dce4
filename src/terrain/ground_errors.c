#include "terrain/ground_errors.h"

/* Errors are kept as logarithms in steps of an eighth of an octave above a millimetre, rounded up. */
enum { CODE_HOLE = 255, CODE_MOST = 254 };
static const double LEAST = 1e-3;

static uint8_t code_of(double error) {
    if (!(error > 0)) return 0;
    double code = ceil(8 * log2(error / LEAST)) + 1;
    return (uint8_t)double_clamp(code, 1, CODE_MOST);
}

static double error_of(uint8_t code) { return code == 0 || code == CODE_HOLE ? 0 : LEAST * exp2((code - 1) / 8.0); }

double ground_cell_error(const GroundSource *s, int column, int row) {
    double twist = ground_source_post(s, column, row) + ground_source_post(s, column + 1, row + 1) - ground_source_post(s, column + 1, row) - ground_source_post(s, column, row + 1);
    return fabs(twist) / 4;
}

typedef struct Square {
    int x, y, side; /* in posts */
    bool rising;    /* the diagonal of its triangles runs from (x, y) on */
} Square;

static double middle_error(const GroundSource *s, int x, int y, int x0, int y0, int x1, int y1) {
    double miss = ground_source_post(s, x, y) - 0.5 * (ground_source_post(s, x0, y0) + ground_source_post(s, x1, y1));
    return isfinite(miss) ? fabs(miss) : 0;
}

/* What the first halvings of the triangles of a square move: of the diagonal, and then of the sides. */
static double own_error(const GroundSource *s, const Square *q) {
    int x0 = q->x, y0 = q->y, x1 = x0 + q->side, y1 = y0 + q->side, x = x0 + q->side / 2, y = y0 + q->side / 2;
    double centre = q->rising ? middle_error(s, x, y, x0, y0, x1, y1) : middle_error(s, x, y, x1, y0, x0, y1);
    double sides = fmax(fmax(middle_error(s, x, y0, x0, y0, x1, y0), middle_error(s, x, y1, x0, y1, x1, y1)),
                        fmax(middle_error(s, x0, y, x0, y0, x0, y1), middle_error(s, x1, y, x1, y0, x1, y1)));
    return centre + sides;
}

/* What is known of the quarters of a square. */
typedef struct Quarters {
    double error;
    bool some, gaps;
} Quarters;

static void add_cell(const GroundSource *s, int column, int row, Quarters *out) {
    if (column >= s->columns - 1 || row >= s->rows - 1) return;
    double error = ground_cell_error(s, column, row);
    if (isnan(error)) out->gaps = true;
    else out->some = true, out->error = fmax(out->error, error);
}

static void add_square(const GroundErrors *e, int level, int column, int row, Quarters *out) {
    if (column >= e->columns[level] || row >= e->rows[level]) return;
    uint8_t code = e->codes[level][(size_t)row * (size_t)e->columns[level] + (size_t)column];
    if (code == CODE_HOLE) out->gaps = true;
    else out->some = true, out->error = fmax(out->error, error_of(code));
}

static uint8_t square_code(const GroundSource *s, const GroundErrors *e, int level, int column, int row) {
    Quarters quarters = {0};
    for (int k = 0; k < 4; k++) {
        int c = 2 * column + (k & 1), r = 2 * row + (k >> 1);
        if (level == 1) add_cell(s, c, r, &quarters);
        else add_square(e, level - 1, c, r, &quarters);
    }
    if (!quarters.some) return CODE_HOLE;
    const Square square = {column << level, row << level, 1 << level, (column + row) % 2 == 0};
    double error = own_error(s, &square) + quarters.error;
    if (quarters.gaps) error = fmax(error, s->spacing * square.side);
    return code_of(error);
}

typedef struct LevelJob {
    const GroundSource *source;
    GroundErrors *errors;
    int level;
} LevelJob;

static void code_row(void *context, size_t row, int worker) {
    (void)worker;
    const LevelJob *job = context;
    GroundErrors *e = job->errors;
    int columns = e->columns[job->level];
    uint8_t *codes = e->codes[job->level] + row * (size_t)columns;
    for (int c = 0; c < columns; c++) codes[c] = square_code(job->source, e, job->level, c, (int)row);
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
        LevelJob job = {source, out, level};
        pool_run(pool, (size_t)out->rows[level], code_row, &job);
    }
}

static uint8_t code_at(const GroundErrors *e, int level, int column, int row) {
    if (column >= e->columns[level] || row >= e->rows[level]) return CODE_HOLE;
    return e->codes[level][(size_t)row * (size_t)e->columns[level] + (size_t)column];
}

double ground_error(const GroundErrors *errors, int level, int column, int row) { return error_of(code_at(errors, level, column, row)); }

bool ground_is_hole(const GroundErrors *errors, int level, int column, int row) { return code_at(errors, level, column, row) == CODE_HOLE; }
