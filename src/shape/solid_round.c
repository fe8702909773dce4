/* Rounded bodies: ovus and superellipsoid. */
#include "shape/roots.h"
#include "shape/solid.h"

/* ---- ovus: two spheres and the arc that joins them ----
 * The bottom sphere about the origin, the top one about <0, bottom, 0>; between them an arc of radius R, whose middle lies across
 * the axis at height h and distance c, touches both from outside. */

typedef struct Ovus {
    double bottom, top, arc, across,
        height;       /* radii; the arc's middle at (-across, height) seen from its side */
    double low, high; /* where the arc meets the spheres */
    bool single;      /* one sphere holds the other */
} Ovus;

static const void *ovus_prepare(const Object *object, Arena *arena) {
    Ovus *o = arena_new(arena, Ovus);
    o->bottom = object->as.solid->as.ovus.bottom;
    o->top = object->as.solid->as.ovus.top;
    double a = o->bottom, b = o->top;
    if (!(a > 0 || b > 0)) return NULL;
    if (b < 1e-12 * a && b > 0) b = 0;
    if (b >= 2 * a) { /* the top sphere holds the bottom one */
        o->single = true;
        o->low = o->high = -b;
        return o;
    }
    /* POV-Ray's choice: the arc's radius is twice the larger of the two. */
    o->arc = 2 * double_max(a, b);
    /* distances of the arc's middle from both spheres' middles: arc - radius */
    double to_bottom = o->arc - a, to_top = o->arc - b;
    o->height = (to_bottom * to_bottom - to_top * to_top + a * a) / (2 * a);
    o->across = sqrt(double_max(to_bottom * to_bottom - o->height * o->height, 0));
    o->low = o->height - o->arc * (o->height / to_bottom);
    o->high = o->height - o->arc * ((o->height - a) / to_top);
    return o;
}

static bool sphere_zeros(const Ray *ray, double y, double radius, double t[2]) {
    Vec3 o = vec3(ray->origin.x, ray->origin.y - y, ray->origin.z), d = ray->direction;
    double a = vec3_length_squared(d), shift = -vec3_dot(o, d) / a;
    Vec3 nearest = vec3_madd(o, d, shift);
    double inner = radius * radius - vec3_length_squared(nearest);
    if (!(inner >= 0)) return false;
    double half = sqrt(inner / a);
    t[0] = shift - half, t[1] = shift + half;
    return true;
}

enum { PART_BOTTOM, PART_TOP, PART_ARC };

static void ovus_sphere(const Ovus *o, const Ray *ray, int part, SolidSink *sink) {
    double t[2], y = part == PART_TOP ? o->bottom : 0, radius = part == PART_TOP ? o->top : o->bottom;
    if (!(radius > 0) || !sphere_zeros(ray, y, radius, t)) return;
    for (int i = 0; i < 2; i++) {
        double at = ray->origin.y + t[i] * ray->direction.y;
        if (o->single ? part == PART_TOP : part == PART_TOP ? at >= o->high : at <= o->low)
            solid_offer(sink, t[i], (SolidTag){(uint32_t)part, 0, 0});
    }
}

/* Turned about the axis, the arc is the inner part of a spindle torus: |p|² with the ring at -across. */
static void ovus_arc(const Ovus *o, const Ray *ray, SolidSink *sink) {
    double length = vec3_length(ray->direction), t[4];
    Vec3 d = vec3_scale(ray->direction, 1 / length),
         from = vec3(ray->origin.x, ray->origin.y - o->height, ray->origin.z);
    double shift = -vec3_dot(from, d);
    from = vec3_madd(from, d, shift);
    /* (r + c)² + y² = R²: with q = |p|² + c² - R², q² = 4c²r², and r = -q/(2c) >= 0 */
    double k = vec3_length_squared(from) + o->across * o->across - o->arc * o->arc, b = vec3_dot(from, d);
    double square[3] = {k, 2 * b, 1}, polynomial[5], ring = 4 * o->across * o->across;
    roots_multiply(square, 2, square, 2, polynomial);
    polynomial[0] -= ring * (from.x * from.x + from.z * from.z);
    polynomial[1] -= 2 * ring * (from.x * d.x + from.z * d.z);
    polynomial[2] -= ring * (d.x * d.x + d.z * d.z);
    double reach = 4 * o->arc;
    int count = roots_in(polynomial, 4, -reach, reach, t);
    for (int i = 0; i < count; i++) {
        double y = o->height + from.y + t[i] * d.y, q = (t[i] + 2 * b) * t[i] + k;
        if (y > o->low && y < o->high && q <= 0)
            solid_offer(sink, (t[i] + shift) / length, (SolidTag){PART_ARC, 0, 0});
    }
}

static void ovus_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Ovus *o = data;
    ovus_sphere(o, ray, PART_BOTTOM, sink);
    ovus_sphere(o, ray, PART_TOP, sink);
    if (!o->single) ovus_arc(o, ray, sink);
}

static Vec3 ovus_normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Ovus *o = data;
    if (tag->part != PART_ARC)
        return vec3_normalize(vec3(p.x, p.y - (tag->part == PART_TOP ? o->bottom : 0), p.z));
    double r = hypot(p.x, p.z), out = r > 0 ? (r + o->across) / r : 0;
    return vec3_normalize(vec3(p.x * out, p.y - o->height, p.z * out));
}

/* Seen from the middle of its height. */
static TexCoord ovus_uv(const void *data, Vec3 p, const SolidTag *tag) {
    const Ovus *o = data;
    (void)tag;
    return (TexCoord){solid_turn(p.x, p.z), 0.5 + atan2(p.y - o->top / 2, hypot(p.x, p.z)) / VTS_PI};
}

static bool ovus_inside(const void *data, Vec3 p) {
    const Ovus *o = data;
    double r2 = p.x * p.x + p.z * p.z, up = p.y - o->bottom;
    if (o->single || p.y >= o->high) return r2 + up * up <= o->top * o->top;
    if (p.y <= o->low) return r2 + p.y * p.y <= o->bottom * o->bottom;
    double out = sqrt(r2) + o->across, rise = p.y - o->height;
    return out * out + rise * rise <= o->arc * o->arc;
}

static Box3 ovus_bounds(const void *data) {
    const Ovus *o = data;
    if (o->single)
        return (Box3){{-o->top, o->bottom - o->top, -o->top}, {o->top, o->bottom + o->top, o->top}};
    double r = double_max(o->bottom, o->top);
    if (o->height > o->low && o->height < o->high) r = double_max(r, o->arc - o->across);
    return (Box3){{-r, -o->bottom, -r}, {r, o->bottom + o->top, r}};
}

const SolidOps solid_ovus_ops = {.prepare = ovus_prepare,
                                 .cross = ovus_cross,
                                 .uv = ovus_uv,
                                 .normal = ovus_normal,
                                 .inside = ovus_inside,
                                 .bounds = ovus_bounds};

/* ---- superellipsoid: (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1 ---- */

static const void *super_prepare(const Object *object, Arena *arena) {
    (void)arena;
    return object->as.solid;
}

/* How far the surface is beyond the point on the line from the middle: of degree 1, 1 on the surface. Its shape is in the
 * two rings: the larger of |x| and |y|, and of what they make and |z|, each times a power of 1 + the ratio's. */
typedef struct SuperGauge {
    double x, y, ring, wide, high,
        value; /* x, y: the powers of |x| and |y| over the larger; wide, high: of ring and |z| */
} SuperGauge;

static SuperGauge super_gauge(const Solid *s, Vec3 p) {
    double e = s->as.superellipsoid.east_west, n = s->as.superellipsoid.north_south;
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z), side = double_max(x, y);
    SuperGauge g = {0};
    if (side > 0) {
        g.x = x == side ? 1 : pow(x / side, 2 / e);
        g.y = y == side ? 1 : pow(y / side, 2 / e);
        g.ring = side * pow(g.x + g.y, e / 2);
    }
    double most = double_max(g.ring, z);
    if (!(most > 0)) return g;
    g.wide = g.ring == most ? 1 : pow(g.ring / most, 2 / n);
    g.high = z == most ? 1 : pow(z / most, 2 / n);
    g.value = most * pow(g.wide + g.high, n / 2);
    return g;
}

static double super_value(const Solid *s, Vec3 p) { return super_gauge(s, p).value - 1; }

/* The gauge's gradient, by the chain of its rings: of ring(x, y) = (x^(2/e) + y^(2/e))^(e/2) it is ring/x · x^(2/e)/(x^(2/e) + y^(2/e)). */
static Vec3 super_gradient(const SuperGauge *g, Vec3 p) {
    double outer = g->value * g->wide / (g->wide + g->high), sum = g->x + g->y;
    return (Vec3){p.x != 0 && sum > 0 ? outer * g->x / (sum * p.x) : 0,
                  p.y != 0 && sum > 0 ? outer * g->y / (sum * p.y) : 0,
                  p.z != 0 ? g->value * g->high / ((g->wide + g->high) * p.z) : 0};
}

static Vec3 super_normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Solid *s = data;
    double e = s->as.superellipsoid.east_west, n = s->as.superellipsoid.north_south;
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z), side = double_max(x, y);
    (void)tag;
    double ring = side > 0 ? side * pow(pow(x / side, 2 / e) + pow(y / side, 2 / e), e / 2) : 0;
    double most = double_max(ring, z), outer = ring > 0 ? pow(ring / most, 2 / n - 1) : 0;
    double gx = side > 0 ? outer * pow(x / (ring > 0 ? ring : 1), 2 / e - 1) : 0;
    double gy = side > 0 ? outer * pow(y / (ring > 0 ? ring : 1), 2 / e - 1) : 0,
           gz = pow(z / most, 2 / n - 1);
    Vec3 g = {copysign(gx, p.x), copysign(gy, p.y), copysign(gz, p.z)};
    return vec3_is_finite(g) ? vec3_normalize(g) : vec3_normalize(p);
}

static bool super_inside(const void *data, Vec3 p) { return super_value(data, p) <= 0; }

static Box3 super_bounds(const void *data) {
    (void)data;
    return (Box3){vec3_splat(-1), vec3_splat(1)};
}

enum { SUPER_PARTS = 64 };

typedef struct SuperLine {
    const Solid *solid;
    const Ray *ray;
} SuperLine;

static double super_along(const void *context, double t) {
    const SuperLine *line = context;
    return super_value(line->solid, vec3_madd(line->ray->origin, line->ray->direction, t));
}

static bool super_is_convex(const Solid *s) {
    return s->as.superellipsoid.east_west <= 2 && s->as.superellipsoid.north_south <= 2;
}

/* The first zero from t on, forwards or backwards. The gauge of a convex body is a convex function: from above 0 Newton's steps come
 * nearer to the zero and never pass it, and where it rises there is none. */
static bool super_newton(const SuperLine *line, double t, double way, double *zero) {
    const Ray *ray = line->ray;
    for (int i = 0; i < 200; i++) {
        Vec3 p = vec3_madd(ray->origin, ray->direction, t);
        SuperGauge g = super_gauge(line->solid, p);
        double value = g.value - 1, slope = vec3_dot(super_gradient(&g, p), ray->direction),
               next = t - value / slope;
        *zero = t;
        if (value <= 0) return true;
        if (!(slope * way < 0)) return false;
        if (!((next - t) * way > 4e-16 * fabs(t))) return value < 1e-12;
        t = next;
    }
    return false;
}

static void super_cross_convex(const SuperLine *line, double in, double out, SolidSink *sink) {
    double first, last;
    if (!super_newton(line, in, 1, &first)) return;
    solid_offer(sink, first, (SolidTag){0, 0, 0});
    if (first > sink->t_max || out < sink->t_min) return;
    if (!super_newton(line, out, -1, &last) || last < first) last = first;
    solid_offer(sink, last, (SolidTag){0, 0, 0});
}

/* Where the value is least between a and b, by golden section. */
static double super_least(const SuperLine *line, double a, double b) {
    const double golden = 0.6180339887498949;
    for (int i = 0; i < 60; i++) {
        double p = b - golden * (b - a), q = a + golden * (b - a);
        if (super_along(line, p) < super_along(line, q))
            b = q;
        else
            a = p;
    }
    return (a + b) / 2;
}

/* By halving: hollow ones have fins that steps by the values would fall into. */
static void super_offer(const SuperLine *line, double a, double b, SolidSink *sink) {
    bool inside = super_along(line, a) <= 0;
    for (int i = 0; i < 60; i++) {
        double middle = (a + b) / 2;
        if ((super_along(line, middle) <= 0) == inside)
            a = middle;
        else
            b = middle;
    }
    solid_offer(sink, (a + b) / 2, (SolidTag){0, 0, 0});
}

static void super_cross_hollow(const SuperLine *line, double in, double out, SolidSink *sink) {
    double places[SUPER_PARTS + 1], values[SUPER_PARTS + 1], step = (out - in) / SUPER_PARTS;
    for (int i = 0; i <= SUPER_PARTS; i++) {
        places[i] = in + i * step;
        values[i] = i == 0 || i == SUPER_PARTS ? 1 : super_along(line, places[i]);
    }
    for (int i = 0; i < SUPER_PARTS; i++) {
        if ((values[i] <= 0) != (values[i + 1] <= 0)) {
            super_offer(line, places[i], places[i + 1], sink);
            continue;
        }
        if (i == 0 || values[i] <= 0 || values[i] > values[i - 1] || values[i] > values[i + 1]) continue;
        double least = super_least(line, places[i - 1], places[i + 1]);
        if (super_along(line, least) > 0) continue;
        super_offer(line, places[i - 1], least, sink);
        super_offer(line, least, places[i + 1], sink);
    }
}

static void super_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const SuperLine line = {data, ray};
    const Box3 box = {vec3_splat(-1 - 1e-9), vec3_splat(1 + 1e-9)};
    double in = -VTS_INFINITY, out = VTS_INFINITY;
    if (!box3_clip_ray(box, ray, &in, &out) || !isfinite(in) || !isfinite(out) || out < sink->t_min ||
        in > sink->t_max)
        return;
    (super_is_convex(line.solid) ? super_cross_convex : super_cross_hollow)(&line, in, out, sink);
}

const SolidOps solid_super_ops = {.prepare = super_prepare,
                                  .cross = super_cross,
                                  .normal = super_normal,
                                  .inside = super_inside,
                                  .bounds = super_bounds};
