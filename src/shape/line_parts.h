/* What the searches for changes of sign share: for line_roots.c and line_lanes.c alone. */
#ifndef VTS_SHAPE_LINE_PARTS_H
#define VTS_SHAPE_LINE_PARTS_H

#include "shape/line_roots.h"
#include "tape/standard.h"
#include "tape/tape_affine.h"

/* Halves of halves down to neighbouring doubles, with room. */
enum { LINE_MOST_PIECES = 256 };
/* For one root. What is left then is known by the signs at the ends of its pieces: functions that jump everywhere have no others. */
enum { LINE_MOST_BOUNDS = 20000 };

typedef struct LinePiece {
    double a, b;
} LinePiece;

typedef struct LineSearch {
    const Line *line;
    AffineForm *forms;
    Interval *intervals;
    double *values;
    StandardForm *standard; /* NULL but for LINE_STANDARD */
    LineWork work;
} LineSearch;

/* The function less its level; what is no number is infinite. */
double line_value(LineSearch *s, double t);
/* Bounds for that on [a, b] by the line's method. */
AffineForm line_bounds(LineSearch *s, double a, double b);
static inline bool line_is_wide(const Line *line) { return line->sum && (line->width.start > 0 || line->width.spread > 0); }
/* The place at middle + s·half along one axis, with the rounding of vec3_madd() and of the middle. */
AffineForm line_place(double origin, double direction, double middle, double half);
/* Cuts [a, b], where the form holds, to where centre + slope·s may be within the error of 0: equation 16. */
void line_cut(const AffineForm *f, double *a, double *b);
/* Below this a piece that ends at t is a place, and has at most one change of sign: 2⁻⁴⁰ of the way or of the coordinates there. */
double line_shortest(const Line *line, double t);
/* Where the sign changes between a and b; false: it is the same at both. */
bool line_place_between(LineSearch *s, double a, double b, double *t, bool *falling);
/* The same for a piece that is given up before it is a place. */
bool line_give_up(LineSearch *s, LinePiece piece, double *t, bool *falling);
/* The search by halves, one piece at a time. */
bool line_search_halves(LineSearch *s, double from, double to, double *t, bool *falling);
/* The search with many pieces at once: `line->sum` is not NULL. */
bool line_search_lanes(LineSearch *s, double from, double to, double *t, bool *falling);

#endif
