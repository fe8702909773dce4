#include "shape/outline.h"

#include "shape/roots.h"

static double value(const double c[4], double s) { return ((c[3] * s + c[2]) * s + c[1]) * s + c[0]; }
static double slope(const double c[4], double s) { return (3 * c[3] * s + 2 * c[2]) * s + c[1]; }

Point2 outline_at(const OutlinePiece *piece, double s) {
    return (Point2){value(piece->x, s), value(piece->y, s)};
}
Point2 outline_tangent(const OutlinePiece *piece, double s) {
    return (Point2){slope(piece->x, s), slope(piece->y, s)};
}

/* The least and the largest value on [0, 1]: at an end or where the slope vanishes. */
static void range(const double c[4], double *lo, double *hi) {
    double places[4] = {0, 1}, derivative[3] = {c[1], 2 * c[2], 3 * c[3]};
    int count = 2 + roots_in(derivative, 2, 0, 1, places + 2);
    *lo = VTS_INFINITY, *hi = -VTS_INFINITY;
    for (int i = 0; i < count; i++) {
        double v = value(c, places[i]);
        *lo = double_min(*lo, v);
        *hi = double_max(*hi, v);
    }
}

void outline_add(Arena *arena, Outline *outline, const double x[4], const double y[4]) {
    OutlinePiece piece;
    for (int i = 0; i < 4; i++) piece.x[i] = x[i], piece.y[i] = y[i];
    range(x, &piece.min.x, &piece.max.x);
    range(y, &piece.min.y, &piece.max.y);
    bool first = outline->count == 0;
    outline->min.x = first ? piece.min.x : double_min(outline->min.x, piece.min.x);
    outline->min.y = first ? piece.min.y : double_min(outline->min.y, piece.min.y);
    outline->max.x = first ? piece.max.x : double_max(outline->max.x, piece.max.x);
    outline->max.y = first ? piece.max.y : double_max(outline->max.y, piece.max.y);
    *list_push(arena, outline) = piece;
}

void outline_add_line(Arena *arena, Outline *outline, Point2 a, Point2 b) {
    if (a.x == b.x && a.y == b.y) return;
    outline_add(arena, outline, (double[]){a.x, b.x - a.x, 0, 0}, (double[]){a.y, b.y - a.y, 0, 0});
}

void outline_coefficients(CurveKind kind, const double p[4], double c[4]) {
    switch (kind) {
    case CURVE_LINEAR: c[0] = p[1], c[1] = p[2] - p[1], c[2] = c[3] = 0; return;
    case CURVE_QUADRATIC:
        c[0] = p[1], c[1] = (p[2] - p[0]) / 2, c[2] = (p[0] + p[2]) / 2 - p[1], c[3] = 0;
        return;
    case CURVE_CUBIC:
        c[0] = p[1], c[1] = (p[2] - p[0]) / 2, c[2] = p[0] - 2.5 * p[1] + 2 * p[2] - p[3] / 2;
        c[3] = (p[3] - p[0]) / 2 + 1.5 * (p[1] - p[2]);
        return;
    case CURVE_B_SPLINE:
        c[0] = (p[0] + 4 * p[1] + p[2]) / 6, c[1] = (p[2] - p[0]) / 2, c[2] = (p[0] + p[2]) / 2 - p[1];
        c[3] = (p[3] - p[0]) / 6 + (p[1] - p[2]) / 2;
        return;
    case CURVE_BEZIER:
        c[0] = p[0], c[1] = 3 * (p[1] - p[0]), c[2] = 3 * (p[0] - 2 * p[1] + p[2]);
        c[3] = p[3] - p[0] + 3 * (p[1] - p[2]);
        return;
    }
}

static void add_piece(Arena *arena, Outline *outline, CurveKind kind, const Point2 p[4]) {
    double x[4], y[4];
    outline_coefficients(kind, (double[]){p[0].x, p[1].x, p[2].x, p[3].x}, x);
    outline_coefficients(kind, (double[]){p[0].y, p[1].y, p[2].y, p[3].y}, y);
    outline_add(arena, outline, x, y);
}

void outline_add_bezier(Arena *arena, Outline *outline, const Point2 points[4]) {
    add_piece(arena, outline, CURVE_BEZIER, points);
}

/* How many points lie before a piece's start, and how many it reads from there on. */
static size_t points_before(CurveKind kind) { return kind == CURVE_LINEAR || kind == CURVE_BEZIER ? 0 : 1; }
static size_t points_from(CurveKind kind) {
    return kind == CURVE_BEZIER ? 4 : kind == CURVE_LINEAR || kind == CURVE_QUADRATIC ? 2 : 3;
}

void outline_add_curve(Arena *arena, Outline *outline, CurveKind kind, const Point2 *points, size_t count) {
    size_t step = kind == CURVE_BEZIER ? 4 : 1, before = points_before(kind), from = points_from(kind);
    for (size_t i = before; i + from <= count; i += step) {
        Point2 p[4] = {points[i], points[i], points[i + 1], points[i + 1]};
        if (kind == CURVE_BEZIER)
            p[1] = points[i + 1], p[2] = points[i + 2], p[3] = points[i + 3];
        else if (before)
            p[0] = points[i - 1];
        if (from == 3) p[3] = points[i + 2];
        add_piece(arena, outline, kind, p);
    }
}

static bool same(Point2 a, Point2 b) { return fabs(a.x - b.x) < 1e-9 && fabs(a.y - b.y) < 1e-9; }

void outline_add_closed(Arena *arena, Outline *outline, CurveKind kind, const Point2 *points, size_t count) {
    size_t before = points_before(kind), after = points_from(kind) - 2;
    if (kind == CURVE_BEZIER) {
        outline_add_curve(arena, outline, kind, points, count);
        return;
    }
    for (size_t begin = 0; begin + before + 1 < count;) {
        size_t start = begin + before, end = start + 1;
        while (end + 1 < count && !same(points[start], points[end])) end++;
        size_t stop = size_min(end + 1 + after, count);
        outline_add_curve(arena, outline, kind, points + begin, stop - begin);
        if (!same(points[start], points[end])) outline_add_line(arena, outline, points[end], points[start]);
        begin = stop;
    }
}

/* Whether the line passes the box around the piece by more than rounding. */
static bool line_passes(const OutlinePiece *piece, double a, double b, double c) {
    double x = a * (piece->min.x + piece->max.x), y = b * (piece->min.y + piece->max.y);
    double reach = fabs(a) * (piece->max.x - piece->min.x) + fabs(b) * (piece->max.y - piece->min.y);
    return fabs(x + y + 2 * c) > reach + 1e-12 * (fabs(x) + fabs(y) + 2 * fabs(c));
}

int outline_meet(const OutlinePiece *piece, double a, double b, double c, double s[3]) {
    double p[4];
    if (line_passes(piece, a, b, c)) return 0;
    for (int i = 0; i < 4; i++) p[i] = a * piece->x[i] + b * piece->y[i];
    p[0] += c;
    if (p[3] == 0 && p[2] == 0) { /* the common case, and exact at its ends */
        if (p[1] == 0) return 0;
        s[0] = -p[0] / p[1];
        return s[0] >= 0 && s[0] <= 1;
    }
    return roots_in(p, 3, 0, 1, s);
}

/* Crossings of y = p.y to the right of p. Where two pieces meet on that line, an end that lies on it counts as above, so
 * that pieces that pass cross once and pieces that touch do not. */
static int crossings(const Outline *outline, Point2 p, bool directed) {
    int total = 0;
    for (size_t i = 0; i < outline->count; i++) {
        const OutlinePiece *piece = &outline->items[i];
        if (p.y < piece->min.y || p.y > piece->max.y || p.x > piece->max.x) continue;
        double s[4];
        int count = outline_meet(piece, 0, 1, -p.y, s);
        bool above = value(piece->y, 0) >= p.y, last = value(piece->y, 1) >= p.y;
        for (int k = 0; k <= count; k++) { /* one more round for a change that rounding hides */
            double at = k < count ? s[k] : 1;
            bool next = k + 1 < count ? value(piece->y, (at + s[k + 1]) / 2) >= p.y : last;
            if (next != above && value(piece->x, at) > p.x) total += directed ? (next ? 1 : -1) : 1;
            above = next;
        }
    }
    return total;
}

int outline_winding(const Outline *outline, Point2 p) { return crossings(outline, p, true); }
bool outline_odd(const Outline *outline, Point2 p) { return crossings(outline, p, false) & 1; }
