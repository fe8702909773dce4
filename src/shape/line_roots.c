#include "shape/line_roots.h"

#include "shape/line_parts.h"
#include "shape/roots.h"
#include "tape/tape_detail.h"
#include "tape/tape_interval.h"

#include <stdlib.h>

enum { FEW_SLOTS = 192 };

/* Ends of lines without end. */
static const double FARTHEST = 0x1p100;

double line_value(LineSearch *s, double t) {
    const Line *line = s->line;
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double in[3] = {p.x, p.y, p.z}, out;
    s->work.values++;
    if (line_is_wide(line))
        out = tape_sum_value(line->sum, p, line->width.start + line->width.spread * t, s->values);
    else
        tape_eval(line->tape, in, &out, s->values);
    out -= line->level;
    return out == out ? out : HUGE_VAL;
}

AffineForm line_place(double origin, double direction, double middle, double half) {
    double centre = origin + middle * direction, slope = half * direction;
    double size = fabs(origin) + (fabs(middle) + half) * fabs(direction);
    return affine_rounded(centre, slope, 0, size, false);
}

static AffineForm standard_bounds(LineSearch *s, const AffineForm in[3]) {
    uint32_t next = 1;
    StandardForm forms[3], out;
    for (int k = 0; k < 3; k++) forms[k] = standard_of_line(in[k], &next);
    tape_eval_standard(s->line->tape, forms, &out, s->standard);
    return standard_reduced(&out);
}

AffineForm line_bounds(LineSearch *s, double a, double b) {
    const Line *line = s->line;
    double middle = a / 2 + b / 2, half = round_up(fmax(b - middle, middle - a));
    AffineForm in[3] = {line_place(line->origin.x, line->direction.x, middle, half),
                        line_place(line->origin.y, line->direction.y, middle, half),
                        line_place(line->origin.z, line->direction.z, middle, half)};
    AffineForm out = affine_unknown(true);
    s->work.bounds++;
    if (line_is_wide(line)) {
        AffineForm width = line_place(line->width.start, line->width.spread, middle, half);
        return affine_SUB(tape_sum_form(line->sum, in, width, s->forms), affine_point(line->level));
    }
    if (line->method == LINE_STANDARD)
        out = standard_bounds(s, in);
    else if (line->method != LINE_INTERVAL)
        tape_eval_affine(line->tape, in, &out, s->forms);
    /* What may be no number may be none at all, which counts as above: intervals know. */
    if (line->method == LINE_INTERVAL || out.nan) {
        Interval spans[3], range;
        for (int k = 0; k < 3; k++) spans[k] = affine_range(in[k]);
        tape_eval_interval(line->tape, spans, &range, s->intervals);
        if (range.low > line->level) return (AffineForm){HUGE_VAL, 0, 0, false};
        if (line->method == LINE_INTERVAL || range.high <= line->level) out = affine_of_interval(range);
        out.nan = range.nan;
    }
    return affine_SUB(out, affine_point(line->level));
}

static double size_at(const Line *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    double most = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
    return fmax(fabs(t), most / vec3_length(line->direction));
}

void line_cut(const AffineForm *f, double *a, double *b) {
    if (f->slope == 0 || !(f->error < HUGE_VAL)) return;
    double middle = *a / 2 + *b / 2, half = *b - middle;
    double one = (-f->centre - f->error) / f->slope, other = (-f->centre + f->error) / f->slope;
    double low = round_down(fmin(one, other)), high = round_up(fmax(one, other));
    /* Half of an ulp of the ends on either side. */
    double slack = 0x1p-52 * (fabs(middle) + half);
    if (low > -1) *a = fmax(*a, middle + half * low - slack);
    if (high < 1) *b = fmin(*b, middle + half * high + slack);
}

double line_shortest(const Line *line, double t) { return 0x1p-40 * size_at(line, t); }

/* Over a place a function is a line, or it jumps. */
static double between(double a, double at_a, double b, double at_b) { return double_clamp(a + (b - a) * (at_a / (at_a - at_b)), a, b); }

static double value_on(const void *context, double t) {
    return line_value((LineSearch *)(uintptr_t)context, t);
}

/* Once bounds leave a piece this short, one change is all that can be told. */
bool line_place_between(LineSearch *s, double a, double b, double *t, bool *falling) {
    double at_a = line_value(s, a), at_b = line_value(s, b);
    if ((at_a <= 0) == (at_b <= 0)) return false;
    *falling = at_b <= 0;
    *t = b;
    if (isfinite(at_a) && isfinite(at_b)) {
        bool is_place = b - a <= 2 * line_shortest(s->line, b);
        *t = is_place ? between(a, at_a, b, at_b) : roots_between(value_on, s, a, at_a, b, at_b, 0x1p-52 * (fabs(a) + fabs(b)));
    }
    return true;
}

bool line_give_up(LineSearch *s, LinePiece piece, double *t, bool *falling) {
    s->work.unsettled++;
    return line_place_between(s, piece.a, piece.b, t, falling);
}

/* Where a function only touches its level, or runs along it, no halving ends. */
static const double ROUNDING_MATTERS = 0x1p20;

static bool all_is_rounding(LineSearch *s, const AffineForm *f, double a, double b) {
    double middle = a / 2 + b / 2;
    return affine_radius(*f) <= 4 * line_bounds(s, middle, middle).error;
}

bool line_search_halves(LineSearch *s, double from, double to, double *t, bool *falling) {
    LinePiece stack[LINE_MOST_PIECES];
    int count = 1;
    stack[0] = (LinePiece){from, to};
    while (count > 0) {
        LinePiece piece = stack[--count];
        AffineForm f = line_bounds(s, piece.a, piece.b);
        Interval range = affine_range(f);
        if (range.low > 0 || (range.high <= 0 && !f.nan)) continue;
        double a = piece.a, b = piece.b, width = b - a;
        if (s->line->method == LINE_AFFINE_OPTIMISED && !f.nan) line_cut(&f, &a, &b);
        if (!(b > a)) continue;
        double least = line_shortest(s->line, b);
        if (b - a <= least || (b - a <= ROUNDING_MATTERS * least && all_is_rounding(s, &f, a, b))) {
            /* What was cut away holds no zero, so its ends have the signs of the piece's. */
            if (line_place_between(s, piece.a, piece.b, t, falling)) return true;
            continue;
        }
        if (count + 2 > LINE_MOST_PIECES || s->work.bounds > LINE_MOST_BOUNDS) {
            if (line_give_up(s, piece, t, falling)) return true;
            continue;
        }
        if (b - a < 0.5 * width) {
            stack[count++] = (LinePiece){a, b};
        } else {
            double middle = a / 2 + b / 2;
            stack[count++] = (LinePiece){middle, b};
            stack[count++] = (LinePiece){a, middle};
        }
    }
    return false;
}

bool line_first_root(const Line *line, double from, double to, double *t, bool *falling, LineWork *work) {
    AffineForm few_forms[FEW_SLOTS];
    Interval few_intervals[FEW_SLOTS];
    double few_values[FEW_SLOTS];
    size_t slots = size_max(tape_scratch_size(line->tape), line->sum ? line->sum->scratch_size : 0);
    LineSearch s = {line, few_forms, few_intervals, few_values, NULL, {0, 0, 0}};
    bool more = slots > FEW_SLOTS, found = false, standard = line->method == LINE_STANDARD;
    if (standard) s.standard = malloc((slots + 1) * sizeof *s.standard);
    if (more) {
        s.forms = malloc(slots * sizeof *s.forms);
        s.intervals = malloc(slots * sizeof *s.intervals);
        s.values = malloc(slots * sizeof *s.values);
    }
    to = fmin(to, FARTHEST);
    if (s.forms && s.intervals && s.values && (s.standard || !standard))
        found = from < to && (line->sum ? line_search_lanes : line_search_halves)(&s, from, to, t, falling);
    if (work) work->bounds += s.work.bounds, work->values += s.work.values, work->unsettled += s.work.unsettled;
    free(s.standard);
    if (more) {
        free(s.forms);
        free(s.intervals);
        free(s.values);
    }
    return found;
}

double line_behind(const Line *line, double t) { return t + 0x1p-44 * size_at(line, t); }
