#include "render/curve.h"

/* Near a place where the curve touches the plane, halving never ends; in the plane itself, it doubles without end. */
enum { MOST_HALVINGS = 64, MOST_NEWTON_STEPS = 60 };

static double bernstein_value(const double b[4], double s) {
    double r = 1 - s;
    return r * r * r * b[0] + 3 * r * r * s * b[1] + 3 * r * s * s * b[2] + s * s * s * b[3];
}

static double bernstein_slope(const double b[4], double s) {
    double r = 1 - s;
    return 3 * (r * r * (b[1] - b[0]) + 2 * r * s * (b[2] - b[1]) + s * s * (b[3] - b[2]));
}

/* The root of a monotonous polynomial with values of both signs at 0 and 1: Newton's method, kept within what is known. */
static double only_root(const double b[4]) {
    double lo = 0, hi = 1, s = b[0] / (b[0] - b[3]);
    for (int i = 0; i < MOST_NEWTON_STEPS && hi - lo > 1e-15; i++) {
        double f = bernstein_value(b, s);
        if ((f > 0) == (b[0] > 0)) lo = s;
        else hi = s;
        double next = s - f / bernstein_slope(b, s);
        if (!(next >= lo && next <= hi)) next = (lo + hi) / 2;
        if (fabs(next - s) <= 1e-10) return next; /* the step has squared it */
        s = next;
    }
    return s;
}

static bool same_sign(const double *x, int count) {
    int positive = 0, negative = 0;
    for (int i = 0; i < count; i++) positive += x[i] > 0, negative += x[i] < 0;
    return positive == count || negative == count;
}

typedef struct Roots {
    double *s;
    int count, halvings_left;
} Roots;

static void find_roots(const double b[4], double from, double length, Roots *out) {
    if (same_sign(b, 4) || out->count == 3) return;
    const double slope[3] = {b[1] - b[0], b[2] - b[1], b[3] - b[2]};
    bool crosses = (b[0] <= 0 && b[3] > 0) || (b[0] >= 0 && b[3] < 0);
    if (same_sign(slope, 3) || out->halvings_left-- <= 0) {
        if (crosses) out->s[out->count++] = from + length * only_root(b);
        return;
    }
    double left[4], right[4]; /* de Casteljau's halves */
    double m = (b[1] + b[2]) / 2;
    left[0] = b[0], left[1] = (b[0] + b[1]) / 2, left[2] = (left[1] + m) / 2;
    right[3] = b[3], right[2] = (b[2] + b[3]) / 2, right[1] = (right[2] + m) / 2;
    left[3] = right[0] = (left[2] + right[1]) / 2;
    find_roots(left, from, length / 2, out);
    find_roots(right, from + length / 2, length / 2, out);
}

int curve_plane_roots(const CurvePlane *plane, double s[3]) {
    Roots roots = {s, 0, MOST_HALVINGS};
    find_roots(plane->b, 0, 1, &roots);
    return roots.count;
}
