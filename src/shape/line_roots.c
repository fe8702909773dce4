#include "shape/line_roots.h"

#include "shape/roots.h"
#include "tape/tape_affine.h"
#include "tape/tape_interval.h"

#include <stdlib.h>

/* Halves of halves down to neighbouring doubles, with room. */
enum { MOST_PIECES = 256, FEW_SLOTS = 192 };

/* Ends of lines without end. */
static const double FARTHEST = 0x1p100;

typedef struct Search {
    const Line *line;
    AffineForm *forms;
    Interval *intervals;
    double *values;
    LineWork work;
} Search;

static double value_at(Search *s, double t) {
    const Line *line = s->line;
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double in[3] = {p.x, p.y, p.z}, out;
    tape_eval(line->tape, in, &out, s->values);
    s->work.values++;
    out -= line->level;
    return out == out ? out : HUGE_VAL;
}

/* The place at middle + s·half, with the rounding of vec3_madd() and of the middle. */
static AffineForm place_form(double origin, double direction, double middle, double half) {
    double centre = origin + middle * direction, slope = half * direction;
    double size = fabs(origin) + (fabs(middle) + half) * fabs(direction);
    return affine_rounded(centre, slope, 0, size, false);
}

/* Bounds for the function less its level on [a, b]. */
static AffineForm bounds_on(Search *s, double a, double b) {
    const Line *line = s->line;
    double middle = a / 2 + b / 2, half = round_up(fmax(b - middle, middle - a));
    AffineForm in[3] = {place_form(line->origin.x, line->direction.x, middle, half), place_form(line->origin.y, line->direction.y, middle, half),
                        place_form(line->origin.z, line->direction.z, middle, half)};
    AffineForm out;
    s->work.bounds++;
    if (line->method == LINE_INTERVAL) {
        Interval spans[3], range;
        for (int k = 0; k < 3; k++) spans[k] = affine_range(in[k]);
        tape_eval_interval(line->tape, spans, &range, s->intervals);
        out = affine_of_interval(range);
        if (!(out.error < HUGE_VAL) && range.low > line->level) return (AffineForm){HUGE_VAL, 0, 0, false};
    } else {
        tape_eval_affine(line->tape, in, &out, s->forms);
    }
    return affine_SUB(out, affine_point(line->level));
}

/* Cuts [a, b] to where centre + slope·s may be within the error of 0: equation 16. */
static void cut(AffineForm f, double *a, double *b) {
    if (f.slope == 0 || !(f.error < HUGE_VAL)) return;
    double middle = *a / 2 + *b / 2, half = *b - middle;
    double one = (-f.centre - f.error) / f.slope, other = (-f.centre + f.error) / f.slope;
    double low = round_down(fmin(one, other)), high = round_up(fmax(one, other));
    /* Half of an ulp of the ends on either side. */
    double slack = 0x1p-52 * (fabs(middle) + half);
    if (low > -1) *a = fmax(*a, middle + half * low - slack);
    if (high < 1) *b = fmin(*b, middle + half * high + slack);
}

typedef struct Piece {
    double a, b;
} Piece;

/* Below this a piece is a place: what a double of that size, or the way to it, tells apart. */
static double shortest(const Line *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double size = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) / vec3_length(line->direction);
    return 0x1p-48 * fmax(fabs(t), size);
}

static double value_on(const void *context, double t) { return value_at((Search *)(uintptr_t)context, t); }

/* The sign changes between a and b: where? Once bounds leave a piece this short, one change is all that can be told. */
static bool place_between(Search *s, double a, double b, double *t, bool *falling) {
    double at_a = value_at(s, a), at_b = value_at(s, b);
    if ((at_a <= 0) == (at_b <= 0)) return false;
    *falling = at_b <= 0;
    *t = isfinite(at_a) && isfinite(at_b) ? roots_between(value_on, s, a, at_a, b, at_b, 0x1p-52 * (fabs(a) + fabs(b))) : b;
    return true;
}

/* Where a function only touches its level, or runs along it, no halving tells more once the bounds are those of a single place. */
static const double ROUNDING_MATTERS = 0x1p28;

static bool all_is_rounding(Search *s, const AffineForm *f, double a, double b) {
    double middle = a / 2 + b / 2;
    return affine_radius(*f) <= 4 * bounds_on(s, middle, middle).error;
}

static bool search(Search *s, double from, double to, double *t, bool *falling) {
    Piece stack[MOST_PIECES];
    int count = 1;
    stack[0] = (Piece){from, to};
    while (count > 0) {
        Piece piece = stack[--count];
        AffineForm f = bounds_on(s, piece.a, piece.b);
        Interval range = affine_range(f);
        if (range.low > 0 || (range.high <= 0 && !f.nan)) continue;
        double a = piece.a, b = piece.b, width = b - a;
        if (s->line->method == LINE_AFFINE_OPTIMISED && !f.nan) cut(f, &a, &b);
        if (!(b > a)) continue;
        double least = shortest(s->line, b);
        if (b - a <= least || (b - a <= ROUNDING_MATTERS * least && all_is_rounding(s, &f, a, b))) {
            /* What was cut away holds no zero, so its ends have the signs of the piece's. */
            if (place_between(s, piece.a, piece.b, t, falling)) return true;
            continue;
        }
        if (count + 2 > MOST_PIECES) return place_between(s, piece.a, piece.b, t, falling);
        if (b - a < 0.5 * width) {
            stack[count++] = (Piece){a, b};
        } else {
            double middle = a / 2 + b / 2;
            stack[count++] = (Piece){middle, b};
            stack[count++] = (Piece){a, middle};
        }
    }
    return false;
}

bool line_first_root(const Line *line, double from, double to, double *t, bool *falling, LineWork *work) {
    AffineForm few_forms[FEW_SLOTS];
    Interval few_intervals[FEW_SLOTS];
    double few_values[FEW_SLOTS];
    size_t slots = tape_scratch_size(line->tape);
    Search s = {line, few_forms, few_intervals, few_values, {0, 0}};
    bool more = slots > FEW_SLOTS, found = false;
    if (more) {
        s.forms = malloc(slots * sizeof *s.forms);
        s.intervals = malloc(slots * sizeof *s.intervals);
        s.values = malloc(slots * sizeof *s.values);
    }
    to = fmin(to, FARTHEST);
    if (s.forms && s.intervals && s.values) found = from < to && search(&s, from, to, t, falling);
    if (work) work->bounds += s.work.bounds, work->values += s.work.values;
    if (more) {
        free(s.forms);
        free(s.intervals);
        free(s.values);
    }
    return found;
}
