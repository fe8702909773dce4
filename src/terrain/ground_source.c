#include "terrain/ground_source.h"

/* a + (b - a)·t, for which only what has a share must exist. */
static double between(double a, double b, double t) { return t <= 0 ? a : t >= 1 ? b : a + (b - a) * t; }

static double post_of_row(const GroundSource *s, int column, int row) {
    int last = s->columns - 1;
    if (column <= last) return s->height(s->map, column, row);
    return 2 * s->height(s->map, last, row) - s->height(s->map, int_max(0, 2 * last - column), row);
}

double ground_source_post(const GroundSource *s, int column, int row) {
    int last = s->rows - 1;
    if (row <= last) return post_of_row(s, column, row);
    return 2 * post_of_row(s, column, last) - post_of_row(s, column, int_max(0, 2 * last - row));
}

double ground_source_beyond(const GroundSource *s, double column, double row) {
    int c = (int)column, r = (int)row;
    double u = column - c, v = row - r;
    if (u == 0 && v == 0) return ground_source_post(s, c, r);
    double north = u == 0 ? ground_source_post(s, c, r) : between(ground_source_post(s, c, r), ground_source_post(s, c + 1, r), u);
    if (v == 0) return north;
    double south = u == 0 ? ground_source_post(s, c, r + 1) : between(ground_source_post(s, c, r + 1), ground_source_post(s, c + 1, r + 1), u);
    return between(north, south, v);
}

double ground_source_height(const GroundSource *s, double column, double row) {
    if (!(column >= 0 && row >= 0 && column <= s->columns - 1 && row <= s->rows - 1)) return (double)NAN;
    return ground_source_beyond(s, column, row);
}
