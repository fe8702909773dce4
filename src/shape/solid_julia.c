/* julia_fractal: points of a slice through four dimensions that an iterated function keeps near. */
#include "shape/roots.h"
#include "shape/solid.h"

#include <complex.h>
#include <string.h>

typedef struct Four {
    double c[4];
} Four;

typedef struct Julia {
    const Solid *solid;
    double exit_square; /* of the size beyond which iterates grow without end */
    double slope;       /* how far a place in four dimensions moves where one in three moves by 1 along the steepest way, squared */
    bool product;       /* iterated by products of quaternions, whose sizes are products of sizes: the square or the cube */
} Julia;

static double exit_square(const Solid *s) {
    double c = 0;
    for (int i = 0; i < 4; i++) c += s->as.julia.c[i] * s->as.julia.c[i];
    double exit = (1 + sqrt(1 + 4 * sqrt(c))) / 2;
    return double_max(exit * exit, 4);
}

static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    const double *n = s->as.julia.slice;
    if (n[3] == 0) return NULL;
    Julia *j = arena_new(arena, Julia);
    *j = (Julia){.solid = s,
                 .exit_square = exit_square(s),
                 .slope = 1 + (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / (n[3] * n[3]),
                 .product = !s->as.julia.hypercomplex && (s->as.julia.function == JULIA_CUBE || s->as.julia.function == JULIA_SQR)};
    return j;
}

/* The place in four dimensions over a point: its fourth coordinate lies on the slice's plane. */
static Four lift(const Solid *s, Vec3 p) {
    const double *n = s->as.julia.slice;
    return (Four){{p.x, p.y, p.z, (s->as.julia.distance - n[0] * p.x - n[1] * p.y - n[2] * p.z) / n[3]}};
}

static Four quaternion_product(Four a, Four b) {
    const double *p = a.c, *q = b.c;
    return (Four){{p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
                   p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                   p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
                   p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]}};
}

/* C11's CMPLX(), which not every compiler has. */
static double complex complex_of(double real, double imaginary) {
    const double parts[2] = {real, imaginary};
    double complex z;
    memcpy(&z, parts, sizeof z);
    return z;
}

static double complex call(const Solid *s, double complex z) {
    switch (s->as.julia.function) {
    case JULIA_SQR: return z * z;
    case JULIA_CUBE: return z * z * z;
    case JULIA_EXP: return cexp(z);
    case JULIA_RECIPROCAL: return 1 / z;
    case JULIA_SIN: return csin(z);
    case JULIA_ASIN: return casin(z);
    case JULIA_SINH: return csinh(z);
    case JULIA_ASINH: return casinh(z);
    case JULIA_COS: return ccos(z);
    case JULIA_ACOS: return cacos(z);
    case JULIA_COSH: return ccosh(z);
    case JULIA_ACOSH: return cacosh(z);
    case JULIA_TAN: return ctan(z);
    case JULIA_ATAN: return catan(z);
    case JULIA_TANH: return ctanh(z);
    case JULIA_ATANH: return catanh(z);
    case JULIA_LOG: return clog(z);
    case JULIA_PWR: return cpow(z, complex_of(s->as.julia.exponent[0], s->as.julia.exponent[1]));
    }
    return z;
}

/* A hypercomplex number is a pair of complex ones, of its halves (x - w, y + z) and (x + w, y - z). */
static Four hypercomplex_call(const Solid *s, Four q) {
    double complex a = call(s, complex_of(q.c[0] - q.c[3], q.c[1] + q.c[2])),
                   b = call(s, complex_of(q.c[0] + q.c[3], q.c[1] - q.c[2]));
    return (Four){{(creal(a) + creal(b)) / 2, (cimag(a) + cimag(b)) / 2, (cimag(a) - cimag(b)) / 2,
                   (creal(b) - creal(a)) / 2}};
}

static double square_of(Four q) {
    return q.c[0] * q.c[0] + q.c[1] * q.c[1] + q.c[2] * q.c[2] + q.c[3] * q.c[3];
}

/* Its product with itself: what is left of quaternion_product(). */
static Four quaternion_square(Four q) {
    const double *c = q.c;
    return (Four){{c[0] * c[0] - c[1] * c[1] - c[2] * c[2] - c[3] * c[3], 2 * c[0] * c[1], 2 * c[0] * c[2], 2 * c[0] * c[3]}};
}

static Four next(const Solid *s, Four q) {
    Four r = s->as.julia.hypercomplex ? hypercomplex_call(s, q) : quaternion_square(q);
    if (!s->as.julia.hypercomplex && s->as.julia.function == JULIA_CUBE) r = quaternion_product(r, q);
    for (int i = 0; i < 4; i++) r.c[i] += s->as.julia.c[i];
    return r;
}

/* What is known at a place. */
typedef struct Sight {
    double value;    /* log of how far the last iterate is past the exit: negative inside, continuous across the surface */
    double distance; /* about how far the surface is from here, outside; 0 where nothing is known of it */
} Sight;

/* The distance: log|q| over the length of its gradient, q the last iterate, whose size in the exit's is 1 on the surface (Hart, Sandin
 * and Kauffman, Ray Tracing Deterministic 3-D Fractals, 1989, section 4). The derivative of the iterated power is a product of sizes,
 * found as its square, so that one root is drawn and not one of every iterate. */
static Sight look_at(const Julia *j, Vec3 p) {
    const Solid *s = j->solid;
    Four q = lift(s, p);
    double square = square_of(q), derivative = j->slope;
    const bool cube = s->as.julia.function == JULIA_CUBE;
    int left = s->as.julia.iterations;
    for (; left > 0 && square < 1e30; left--) {
        derivative *= cube ? 9 * square * square : 4 * square;
        q = next(s, q);
        square = square_of(q);
    }
    const double past = square < 1e30 ? log(square / j->exit_square + 1e-300) : left + 101;
    if (!j->product || !(past > 0) || !(derivative > 0)) return (Sight){past, 0};
    const double size = square < 1e30 ? past / 2 : log(square / j->exit_square) / 2;
    return (Sight){past, size > 0 ? sqrt(square / derivative) * size : 0};
}

static bool inside(const void *data, Vec3 p) { return look_at(data, p).value <= 0; }

static double radius(const Julia *j) { return sqrt(j->exit_square); }

static Box3 bounds(const void *data) {
    double r = radius(data);
    return (Box3){vec3_splat(-r), vec3_splat(r)};
}

enum { STEPS = 400 };

typedef struct JuliaLine {
    const Julia *julia;
    const Ray *ray;
} JuliaLine;

static Sight sight_along(const JuliaLine *line, double t) {
    return look_at(line->julia, vec3_madd(line->ray->origin, line->ray->direction, t));
}

static double value_along(const void *context, double t) { return sight_along(context, t).value; }

/* The part of a line along which the surface may be; false: none. The bounds, and the ball within them where sizes are multiplied:
 * there what begins beyond the exit never comes back. */
static bool find_span(const Julia *j, const Ray *ray, double *near, double *far) {
    if (!box3_clip_ray(bounds(j), ray, near, far) || !isfinite(*near) || !isfinite(*far)) return false;
    if (!j->product) return true;
    const double square = vec3_dot(ray->direction, ray->direction), middle = -vec3_dot(ray->origin, ray->direction) / square;
    const Vec3 closest = vec3_madd(ray->origin, ray->direction, middle);
    const double half = (j->exit_square - vec3_dot(closest, closest)) / square;
    if (!(half > 0)) return false;
    *near = double_max(*near, middle - sqrt(half)), *far = double_min(*far, middle + sqrt(half));
    return *near < *far;
}

/* The next place where to look is half way to where the surface may be, but some part of the bounds' size at least. */
static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const JuliaLine line = {data, ray};
    double near = -VTS_INFINITY, far = VTS_INFINITY;
    if (!find_span(data, ray, &near, &far)) return;
    const double length = vec3_length(ray->direction), step = 2 * radius(data) / STEPS / length;
    double a = double_max(near, sink->t_min);
    Sight at_a = sight_along(&line, a);
    while (a < far && a < sink->t_max) {
        double b = double_min(a + double_max(step, at_a.distance / (2 * length)), far);
        Sight at_b = sight_along(&line, b);
        if ((at_a.value <= 0) != (at_b.value <= 0))
            solid_offer(sink,
                        roots_between(value_along, &line, a, at_a.value, b, at_b.value, 1e-14 * (fabs(a) + fabs(b))),
                        (SolidTag){0, 0, 0});
        a = b, at_a = at_b;
    }
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const double h = 1e-6;
    double g[3];
    (void)tag;
    for (int axis = 0; axis < 3; axis++) {
        Vec3 step = vec3(axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0);
        g[axis] = look_at(data, vec3_add(p, step)).value - look_at(data, vec3_sub(p, step)).value;
    }
    return vec3_normalize(vec3(g[0], g[1], g[2]));
}

const SolidOps solid_julia_ops = {.prepare = prepare,
                                  .cross = cross,
                                  .normal = normal,
                                  .inside = inside,
                                  .bounds = bounds,
                                  .keeps_normal = true};
