#include "shape/intersect_torus.h"

/* The quartic tells where to look, the distance itself says what is there: between two stationary points of the quartic it has
 * at most one root, found by the sign of the distance, which keeps its accuracy for thin rings. */

typedef struct TorusLine {
    Vec3 origin, direction;
    double major, minor;
} TorusLine;

/* A function along the line, with its slope. */
typedef struct Value {
    double value, slope;
} Value;
typedef Value (*LineFunction)(const void *context, double t);

/* The signed distance from the torus. */
static Value distance_at(const void *context, double t) {
    const TorusLine *line = context;
    Vec3 p = vec3_madd(line->origin, line->direction, t), d = line->direction;
    double ring = sqrt(p.x * p.x + p.z * p.z), out = ring - line->major, length = sqrt(out * out + p.y * p.y);
    double ring_slope = ring > 0 ? (p.x * d.x + p.z * d.z) / ring : 0;
    return (Value){length - line->minor, length > 0 ? (out * ring_slope + p.y * d.y) / length : 0};
}

/* A zero between a and b, where f has different signs: Newton's steps as long as they stay between and shrink, halving
 * otherwise, until one is no longer than `close`. */
static double zero_between(LineFunction f, const void *context, double a, double b, double close) {
    bool negative = f(context, a).value < 0;
    double t = a + (b - a) / 2, last = b - a;
    for (int i = 0; i < 200; i++) {
        Value at = f(context, t);
        if (at.value == 0) return t;
        if ((at.value < 0) == negative)
            a = t;
        else
            b = t;
        double next = t - at.value / at.slope;
        if (fabs(next - t) <= close) return double_clamp(next, double_min(a, b), double_max(a, b));
        bool slow = !(fabs(next - t) < last / 2);
        if (slow || !(next > fmin(a, b) && next < fmax(a, b))) next = a + (b - a) / 2;
        last = fabs(next - t);
        t = next;
        if (last <= 2e-16 * fabs(t) || t == a || t == b) break;
    }
    return t;
}

/* c[0] + c[1] t + c[2] t² + c[3] t³ */
static Value cubic_at(const void *context, double t) {
    const double *c = context;
    return (Value){((c[3] * t + c[2]) * t + c[1]) * t + c[0], (3 * c[3] * t + 2 * c[2]) * t + c[1]};
}

/* The ring has the size 1: of its surface all that doubles can tell; of a stationary point less will do, since the distance is nearly the same
 * around it. */
static const double CLOSE = 2e-16, CLOSE_STATION = 1e-9;

/* Real zeros of a t² + 2 b t + c within (lo, hi), ascending; a > 0. */
static int quadratic_zeros(double a, double b, double c, double lo, double hi, double *out) {
    double discriminant = b * b - a * c;
    int count = 0;
    if (!(discriminant > 0)) return 0;
    double sum = -(b + copysign(sqrt(discriminant), b)), t0 = sum / a, t1 = sum != 0 ? c / sum : 0;
    double first = double_min(t0, t1), second = double_max(t0, t1);
    if (first > lo && first < hi) out[count++] = first;
    if (second > lo && second < hi) out[count++] = second;
    return count;
}

/* Zeros of a cubic within (lo, hi) where it changes sign, ascending, one between each two of its derivative's. */
static int cubic_zeros(const double c[4], double lo, double hi, double *out) {
    double stations[4] = {lo};
    int count = 0, station_count = 1 + quadratic_zeros(3 * c[3], c[2], c[1], lo, hi, stations + 1);
    stations[station_count++] = hi;
    for (int i = 0; i + 1 < station_count; i++) {
        double a = stations[i], b = stations[i + 1];
        if ((cubic_at(c, a).value < 0) != (cubic_at(c, b).value < 0))
            out[count++] = zero_between(cubic_at, c, a, b, CLOSE_STATION);
    }
    return count;
}

/* The derivative of (|p|² + R² - r²)² - 4R²(x² + z²) along the line, and nothing else of it is needed. */
static void quartic_derivative(const TorusLine *line, double c[4]) {
    Vec3 o = line->origin, d = line->direction;
    double major2 = line->major * line->major, b = vec3_dot(o, d);
    double k = vec3_dot(o, o) + major2 - line->minor * line->minor;
    /* |p|² + … = t² + 2bt + k; x² + z² = a2 t² + 2 a1 t + a0 */
    double a2 = d.x * d.x + d.z * d.z, a1 = o.x * d.x + o.z * d.z;
    c[0] = 4 * b * k - 8 * major2 * a1;
    c[1] = 4 * k + 8 * b * b - 8 * major2 * a2;
    c[2] = 12 * b;
    c[3] = 4;
}

/* Where the line is near the torus: inside the sphere around it and between its two flat ends. */
static bool clip_line(const TorusLine *line, double *lo, double *hi) {
    double reach = (line->major + line->minor) * (1 + 1e-9), flat = line->minor * (1 + 1e-9);
    double b = vec3_dot(line->origin, line->direction);
    Vec3 nearest = vec3_madd(line->origin, line->direction, -b);
    double square = reach * reach - vec3_length_squared(nearest);
    if (!(square > 0)) return false;
    *lo = -b - sqrt(square);
    *hi = -b + sqrt(square);
    if (line->direction.y == 0) return fabs(line->origin.y) <= flat;
    double y0 = (-flat - line->origin.y) / line->direction.y,
           y1 = (flat - line->origin.y) / line->direction.y;
    *lo = double_max(*lo, double_min(y0, y1));
    *hi = double_min(*hi, double_max(y0, y1));
    return *lo < *hi;
}

int intersect_torus(Vec3 origin, Vec3 direction, double major, double minor, double t[4]) {
    const TorusLine line = {origin, direction, major, minor};
    double derivative[4], lo, hi, stations[5];
    int count = 0, station_count = 1;
    if (!clip_line(&line, &lo, &hi)) return 0;
    quartic_derivative(&line, derivative);
    stations[0] = lo;
    station_count += cubic_zeros(derivative, lo, hi, stations + 1);
    stations[station_count++] = hi;
    /* Both ends are outside, whatever rounding says. */
    bool inside = false;
    for (int i = 1; i < station_count; i++) {
        bool next = i + 1 < station_count && distance_at(&line, stations[i]).value < 0;
        if (next != inside) t[count++] = zero_between(distance_at, &line, stations[i - 1], stations[i], CLOSE);
        inside = next;
    }
    return count;
}
