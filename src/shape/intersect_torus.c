#include "shape/intersect_torus.h"

/* The quartic tells where to look, the distance itself says what is there: between two stationary points of the quartic it has
 * at most one root, found by the sign of the distance, which keeps its accuracy for thin rings. */

typedef struct TorusLine {
    Vec3 origin, direction;
    double major, minor;
} TorusLine;

static double distance_at(const TorusLine *line, double t) {
    Vec3 p = vec3_madd(line->origin, line->direction, t);
    return hypot(hypot(p.x, p.z) - line->major, p.y) - line->minor;
}

/* c[0] + c[1] t + … + c[degree] t^degree */
static double polynomial(const double *c, int degree, double t) {
    double sum = c[degree];
    for (int i = degree - 1; i >= 0; i--) sum = sum * t + c[i];
    return sum;
}

typedef double (*LineFunction)(const void *context, double t);

/* A zero between a and b, where f has different signs: false position with halved ends (Illinois), then bisection. */
static double zero_between(LineFunction f, const void *context, double a, double b) {
    double fa = f(context, a), fb = f(context, b);
    for (int i = 0; i < 200; i++) {
        double middle = i % 3 == 2 || fa == fb ? a + (b - a) / 2 : a + (b - a) * (fa / (fa - fb));
        double value = f(context, middle);
        if (value == 0 || middle == a || middle == b) return middle;
        if ((value < 0) == (fa < 0))
            a = middle, fa = value, fb *= 0.5;
        else
            b = middle, fb = value, fa *= 0.5;
        if (fabs(b - a) <= 4e-16 * fmax(fabs(a), fabs(b))) break;
    }
    return fabs(f(context, a)) < fabs(f(context, b)) ? a : b;
}

typedef struct Polynomial {
    const double *c;
    int degree;
} Polynomial;

static double polynomial_at(const void *context, double t) {
    const Polynomial *p = context;
    return polynomial(p->c, p->degree, t);
}

/* Real zeros of a polynomial in (lo, hi) where it changes sign, ascending, from those of its derivative. */
static int polynomial_zeros(const double *c, int degree, double lo, double hi, double *out) {
    double derivative[4], bounds[6];
    int count = 0, stations = 1;
    if (degree == 0) return 0;
    for (int i = 1; i <= degree; i++) derivative[i - 1] = c[i] * i;
    bounds[0] = lo;
    stations += polynomial_zeros(derivative, degree - 1, lo, hi, bounds + 1);
    bounds[stations++] = hi;
    const Polynomial p = {c, degree};
    for (int i = 0; i + 1 < stations; i++) {
        double a = polynomial(c, degree, bounds[i]), b = polynomial(c, degree, bounds[i + 1]);
        if ((a < 0) != (b < 0)) out[count++] = zero_between(polynomial_at, &p, bounds[i], bounds[i + 1]);
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

static double torus_distance(const void *context, double t) { return distance_at(context, t); }

int intersect_torus(Vec3 origin, Vec3 direction, double major, double minor, double t[4]) {
    const TorusLine line = {origin, direction, major, minor};
    double derivative[4], stations[5];
    int count = 0, station_count = 1;
    if (!clip_line(&line, &stations[0], &stations[4])) return 0;
    double end = stations[4];
    quartic_derivative(&line, derivative);
    station_count += polynomial_zeros(derivative, 3, stations[0], end, stations + 1);
    stations[station_count++] = end;
    /* Both ends are outside, whatever rounding says. */
    bool inside = false;
    for (int i = 1; i < station_count; i++) {
        bool next = i + 1 < station_count && distance_at(&line, stations[i]) < 0;
        if (next != inside) t[count++] = zero_between(torus_distance, &line, stations[i - 1], stations[i]);
        inside = next;
    }
    return count;
}
