#include "terrain/ground_normals.h"

enum { BLOCK = 64 }; /* posts along a side of what shares its axes: the map bends little over them */

typedef struct BlockAxes {
    bool known;
    Vec3 across, down, up; /* of one post, and of a metre */
} BlockAxes;

struct GroundAxes {
    const GroundSource *source;
    int columns;
    BlockAxes *blocks;
};

GroundAxes *ground_axes_create(const GroundSource *source, Arena *arena) {
    GroundAxes *axes = arena_new(arena, GroundAxes);
    int columns = source->columns / BLOCK + 1, rows = source->rows / BLOCK + 1;
    *axes = (GroundAxes){source, columns, arena_new_array(arena, BlockAxes, (size_t)columns * (size_t)rows)};
    return axes;
}

static const BlockAxes *axes_at(GroundAxes *axes, double column, double row) {
    const GroundSource *s = axes->source;
    int c = (int)column / BLOCK, r = (int)row / BLOCK;
    BlockAxes *block = &axes->blocks[(size_t)r * (size_t)axes->columns + (size_t)c];
    if (block->known) return block;
    double x = fmin(c * BLOCK + BLOCK / 2, s->columns - 1.5), y = fmin(r * BLOCK + BLOCK / 2, s->rows - 1.5);
    Vec3 west = s->place(s->map, x - 0.5, y, 0), east = s->place(s->map, x + 0.5, y, 0);
    Vec3 north = s->place(s->map, x, y - 0.5, 0), south = s->place(s->map, x, y + 0.5, 0);
    Vec3 up = vec3_sub(s->place(s->map, x, y, 1), s->place(s->map, x, y, 0));
    *block = (BlockAxes){true, vec3_sub(east, west), vec3_sub(south, north), up};
    return block;
}

/* The rise over a post between two places, of which one may be missing: then it is the middle that counts. */
static bool slope(const GroundSource *s, const double middle[2], const double low[2], const double high[2], double *out) {
    double a = ground_source_height(s, low[0], low[1]), b = ground_source_height(s, high[0], high[1]);
    const double *from = low, *to = high;
    if (isnan(a)) from = middle, a = ground_source_height(s, middle[0], middle[1]);
    if (isnan(b)) to = middle, b = ground_source_height(s, middle[0], middle[1]);
    double run = to[0] - from[0] + to[1] - from[1];
    *out = (b - a) / run;
    return run > 0 && isfinite(*out);
}

Vec3 ground_normal(GroundAxes *axes, double column, double row, double step) {
    const GroundSource *s = axes->source;
    const double middle[2] = {column, row};
    step = fmax(step, 1);
    double across, down;
    if (!slope(s, middle, (double[]){fmax(0, column - step), row}, (double[]){fmin(s->columns - 1, column + step), row}, &across) ||
        !slope(s, middle, (double[]){column, fmax(0, row - step)}, (double[]){column, fmin(s->rows - 1, row + step)}, &down))
        return vec3_splat(0);
    const BlockAxes *local = axes_at(axes, column, row);
    Vec3 n = vec3_cross(vec3_madd(local->across, local->up, across), vec3_madd(local->down, local->up, down));
    n = vec3_normalize(n);
    if (!vec3_is_finite(n)) return vec3_splat(0);
    return vec3_dot(n, local->up) < 0 ? vec3_negate(n) : n;
}
