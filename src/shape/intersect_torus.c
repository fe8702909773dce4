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

/* A zero between a and b, where f has different signs, `negative` at a: Newton's steps from t as long as they stay between and shrink,
 * halving otherwise, until one is no longer than `close`. */
static double zero_between(LineFunction f, const void *context, double a, double b, bool negative, double t, double close) {
    double last = b - a;
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

/* Whether the stationary point between a and b, where the cubic changes its sign, is inside as t is. A least distance is where any place
 * about it is, and a largest is outside where any is; besides, a distance changes by no more than the way. */
static bool settles(const double c[4], double a, double b, double t, double distance) {
    const bool least = cubic_at(c, a).value < 0;
    if ((distance < 0) == least) return true;
    const double way = fabs(distance);
    return (t - way <= a || (cubic_at(c, t - way).value < 0) == least) && (t + way >= b || (cubic_at(c, t + way).value < 0) != least);
}

/* A place between a and b, at all of which the cubic has the sign it has at a and then that at b, where the line is inside just if it is at the
 * stationary point: mostly a few of Newton's steps away from the middle. */
static double station_between(const TorusLine *line, const double c[4], double a, double b) {
    double t = a + (b - a) / 2;
    for (int i = 0; i < 3; i++) {
        if (settles(c, a, b, t, distance_at(line, t).value)) return t;
        const Value at = cubic_at(c, t);
        const double next = t - at.value / at.slope;
        if (!(next > a && next < b)) break;
        t = next;
    }
    return zero_between(cubic_at, c, a, b, cubic_at(c, a).value < 0, a + (b - a) / 2, CLOSE_STATION);
}

/* For the derivative c of the quartic: places within (lo, hi) for its stationary points, ascending, one between each two zeros of its own
 * derivative. */
static int find_stations(const TorusLine *line, const double c[4], double lo, double hi, double *out) {
    double bends[4] = {lo};
    int count = 0, bend_count = 1 + quadratic_zeros(3 * c[3], c[2], c[1], lo, hi, bends + 1);
    bends[bend_count++] = hi;
    for (int i = 0; i + 1 < bend_count; i++) {
        double a = bends[i], b = bends[i + 1];
        if ((cubic_at(c, a).value < 0) != (cubic_at(c, b).value < 0)) out[count++] = station_between(line, c, a, b);
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

/* Where the line crosses the surface between two places, one of which is outside: looked for from where a parabola about the place inside, which
 * is near a least distance, crosses it. */
static double crossing_between(const TorusLine *line, const double place[2], const double distance[2]) {
    const int in = distance[1] < 0;
    const double inner = distance[in], outer = distance[!in];
    const double way = outer > 0 && inner < 0 ? sqrt(inner / (inner - outer)) : 0.5;
    return zero_between(distance_at, line, place[0], place[1], in == 0, place[in] + (place[!in] - place[in]) * way, CLOSE);
}

int intersect_torus(Vec3 origin, Vec3 direction, double major, double minor, double t[4]) {
    const TorusLine line = {origin, direction, major, minor};
    double derivative[4], lo, hi, places[5], distances[5];
    int count = 0, place_count = 1;
    if (!clip_line(&line, &lo, &hi)) return 0;
    quartic_derivative(&line, derivative);
    places[0] = lo;
    place_count += find_stations(&line, derivative, lo, hi, places + 1);
    places[place_count++] = hi;
    for (int i = 0; i < place_count; i++) distances[i] = distance_at(&line, places[i]).value;
    /* Both ends are outside, whatever rounding says. */
    distances[0] = fmax(distances[0], 0), distances[place_count - 1] = fmax(distances[place_count - 1], 0);
    for (int i = 1; i < place_count; i++)
        if ((distances[i - 1] < 0) != (distances[i] < 0)) t[count++] = crossing_between(&line, places + i - 1, distances + i - 1);
    return count;
}
