/* julia_fractal: points of a slice through four dimensions that an iterated function keeps near. */
#include "shape/roots.h"
#include "shape/solid.h"

#include <complex.h>
#include <string.h>

typedef struct Four {
    double c[4];
} Four;

static const void *prepare(const Object *object, Arena *arena) {
    (void)arena;
    const Solid *s = object->as.solid;
    return s->as.julia.slice[3] != 0 ? s : NULL;
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

static Four next(const Solid *s, Four q) {
    Four r = s->as.julia.hypercomplex ? hypercomplex_call(s, q) : quaternion_product(q, q);
    if (!s->as.julia.hypercomplex && s->as.julia.function == JULIA_CUBE) r = quaternion_product(r, q);
    for (int i = 0; i < 4; i++) r.c[i] += s->as.julia.c[i];
    return r;
}

static double exit_square(const Solid *s) {
    double c = 0;
    for (int i = 0; i < 4; i++) c += s->as.julia.c[i] * s->as.julia.c[i];
    double exit = (1 + sqrt(1 + 4 * sqrt(c))) / 2; /* beyond it squares grow without end */
    return double_max(exit * exit, 4);
}

/* log of how far the last iterate is past the exit: negative inside, continuous across the surface. */
static double value_at(const Solid *s, Vec3 p) {
    Four q = lift(s, p);
    double most = exit_square(s), square = square_of(q);
    for (int i = 0; i < s->as.julia.iterations; i++) {
        q = next(s, q);
        square = square_of(q);
        if (!(square < 1e30)) return (double)(s->as.julia.iterations - i) + 100;
    }
    return log(square / most + 1e-300);
}

static bool inside(const void *data, Vec3 p) { return value_at(data, p) <= 0; }

static double radius(const Solid *s) { return sqrt(exit_square(s)); }

static Box3 bounds(const void *data) {
    double r = radius(data);
    return (Box3){vec3_splat(-r), vec3_splat(r)};
}

enum { STEPS = 400 };

typedef struct JuliaLine {
    const Solid *solid;
    const Ray *ray;
} JuliaLine;

static double value_along(const void *context, double t) {
    const JuliaLine *line = context;
    return value_at(line->solid, vec3_madd(line->ray->origin, line->ray->direction, t));
}

/* About how far the surface is from a point outside: log|q| over the length of its gradient, q the last iterate, whose size in the
 * exit's is 1 on the surface (Hart, Sandin and Kauffman, Ray Tracing Deterministic 3-D Fractals, 1989, section 4). The derivative of the
 * iterated quaternion power is a product of sizes. 0 for functions of which it is not known. */
static double distance_about(const Solid *s, Vec3 p) {
    bool cube = s->as.julia.function == JULIA_CUBE;
    if (s->as.julia.hypercomplex || (!cube && s->as.julia.function != JULIA_SQR)) return 0;
    Four q = lift(s, p);
    const double *n = s->as.julia.slice;
    /* How fast the fourth coordinate moves with the other three. */
    double square = square_of(q),
           derivative = sqrt(1 + (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / (n[3] * n[3]));
    for (int i = 0; i < s->as.julia.iterations && square < 1e30; i++) {
        derivative *= cube ? 3 * square : 2 * sqrt(square);
        q = next(s, q);
        square = square_of(q);
    }
    double beyond = log(square / exit_square(s)) / 2;
    return beyond > 0 && derivative > 0 ? sqrt(square) * beyond / derivative : 0;
}

/* The next place where to look: half way to where the surface may be, but some part of the whole way at least. */
static double next_place(const JuliaLine *line, double t, double least) {
    double distance = distance_about(line->solid, vec3_madd(line->ray->origin, line->ray->direction, t));
    return t + double_max(least, distance / (2 * vec3_length(line->ray->direction)));
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const JuliaLine line = {data, ray};
    double near = -VTS_INFINITY, far = VTS_INFINITY;
    if (!box3_clip_ray(bounds(data), ray, &near, &far) || !isfinite(near) || !isfinite(far)) return;
    double step = (far - near) / STEPS, a = double_max(near, sink->t_min), at_a = value_along(&line, a);
    while (a < far && a < sink->t_max) {
        double b = double_min(at_a > 0 ? next_place(&line, a, step) : a + step, far),
               at_b = value_along(&line, b);
        if ((at_a <= 0) != (at_b <= 0))
            solid_offer(sink,
                        roots_between(value_along, &line, a, at_a, b, at_b, 1e-14 * (fabs(a) + fabs(b))),
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
        g[axis] = value_at(data, vec3_add(p, step)) - value_at(data, vec3_sub(p, step));
    }
    return vec3_normalize(vec3(g[0], g[1], g[2]));
}

const SolidOps solid_julia_ops = {.prepare = prepare,
                                  .cross = cross,
                                  .normal = normal,
                                  .inside = inside,
                                  .bounds = bounds,
                                  .keeps_normal = true};
