/* Surfaces where a polynomial of the place is zero: quadric, cubic, quartic, poly. */
#include "shape/roots.h"
#include "shape/solid.h"

#include <string.h>

/* The ray with its origin moved to where it is nearest to <0, 0, 0>, and a direction of unit length. */
typedef struct NearRay {
    Vec3 o, d;
    double shift, scale; /* t = (local + shift)·scale */
} NearRay;

static NearRay near_ray(const Ray *ray) {
    double length = vec3_length(ray->direction);
    Vec3 d = vec3_scale(ray->direction, 1 / length);
    double shift = -vec3_dot(ray->origin, d);
    return (NearRay){vec3_madd(ray->origin, d, shift), d, shift, 1 / length};
}

static void offer_zeros(const double *c, int degree, const NearRay *near, SolidSink *sink) {
    double t[ROOTS_HIGHEST_DEGREE];
    int count = roots_real(c, degree, t);
    for (int i = 0; i < count; i++)
        solid_offer(sink, (t[i] + near->shift) * near->scale, (SolidTag){0, 0, 0});
}

static Box3 everywhere(void) { return (Box3){vec3_splat(-VTS_INFINITY), vec3_splat(VTS_INFINITY)}; }

/* ---- quadric ---- */

static const void *quadric_prepare(const Object *object, Arena *arena) {
    (void)arena;
    return object->as.solid;
}

static Vec3 quadric_gradient(const Solid *s, Vec3 p) {
    Vec3 a = s->as.quadric.squares, b = s->as.quadric.mixed, c = s->as.quadric.linear;
    return vec3(2 * a.x * p.x + b.x * p.y + b.y * p.z + c.x, 2 * a.y * p.y + b.x * p.x + b.z * p.z + c.y,
                2 * a.z * p.z + b.y * p.x + b.z * p.y + c.z);
}

static double quadric_value(const Solid *s, Vec3 p) {
    Vec3 a = s->as.quadric.squares, b = s->as.quadric.mixed;
    return vec3_dot(a, vec3_mul(p, p)) + vec3_dot(b, vec3(p.x * p.y, p.x * p.z, p.y * p.z)) +
           vec3_dot(s->as.quadric.linear, p) + s->as.quadric.constant;
}

static void quadric_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Solid *s = data;
    const NearRay near = near_ray(ray);
    Vec3 d = near.d;
    double a = quadric_value(s, d) - vec3_dot(s->as.quadric.linear, d) - s->as.quadric.constant;
    double b = vec3_dot(quadric_gradient(s, near.o), d), c = quadric_value(s, near.o);
    double discriminant = b * b - 4 * a * c;
    if (a == 0) {
        if (b != 0) solid_offer(sink, (-c / b + near.shift) * near.scale, (SolidTag){0, 0, 0});
        return;
    }
    if (!(discriminant >= 0)) return;
    double sum = -(b + copysign(sqrt(discriminant), b)) / 2;
    solid_offer(sink, (sum / a + near.shift) * near.scale, (SolidTag){0, 0, 0});
    if (sum != 0) solid_offer(sink, (c / sum + near.shift) * near.scale, (SolidTag){0, 0, 0});
}

static Vec3 quadric_normal(const void *data, Vec3 p, const SolidTag *tag) {
    (void)tag;
    return vec3_normalize(quadric_gradient(data, p));
}

static bool quadric_inside(const void *data, Vec3 p) { return quadric_value(data, p) <= 0; }

static Box3 quadric_bounds(const void *data) {
    (void)data;
    return everywhere();
}

const SolidOps solid_quadric_ops = {.prepare = quadric_prepare,
                                    .cross = quadric_cross,
                                    .normal = quadric_normal,
                                    .inside = quadric_inside,
                                    .bounds = quadric_bounds,
                                    .keeps_normal = true};

/* ---- polynomials of any order ---- */

typedef struct Term {
    uint8_t power[3];
    double factor;
} Term;

typedef struct Polynomial {
    int order;
    Term *terms; /* those that are not zero */
    size_t count;
} Polynomial;

static const void *polynomial_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    Polynomial *p = arena_new(arena, Polynomial);
    const double *c = s->as.polynomial.coefficients;
    p->order = s->as.polynomial.order;
    p->terms = arena_new_array(arena, Term, s->as.polynomial.count);
    for (int i = p->order; i >= 0; i--)
        for (int j = p->order - i; j >= 0; j--)
            for (int k = p->order - i - j; k >= 0; k--, c++)
                if (*c != 0) p->terms[p->count++] = (Term){{(uint8_t)i, (uint8_t)j, (uint8_t)k}, *c};
    return p;
}

typedef double Powers[3][ROOTS_HIGHEST_DEGREE + 1];

static void powers_of(const Polynomial *p, Vec3 at, Powers powers) {
    for (int axis = 0; axis < 3; axis++) {
        powers[axis][0] = 1;
        for (int i = 1; i <= p->order; i++) powers[axis][i] = powers[axis][i - 1] * vec3_get(at, axis);
    }
}

/* (o + t d)ⁱ for all i, as coefficients of t. */
static void line_powers(int order, double o, double d, double out[][ROOTS_HIGHEST_DEGREE + 1]) {
    const double line[2] = {o, d};
    out[0][0] = 1;
    for (int i = 1; i <= order; i++) roots_multiply(out[i - 1], i - 1, line, 1, out[i]);
}

static void polynomial_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Polynomial *p = data;
    const NearRay near = near_ray(ray);
    double x[ROOTS_HIGHEST_DEGREE + 1][ROOTS_HIGHEST_DEGREE + 1],
        y[ROOTS_HIGHEST_DEGREE + 1][ROOTS_HIGHEST_DEGREE + 1],
        z[ROOTS_HIGHEST_DEGREE + 1][ROOTS_HIGHEST_DEGREE + 1];
    double total[ROOTS_HIGHEST_DEGREE + 1] = {0}, xy[ROOTS_HIGHEST_DEGREE + 1], xyz[ROOTS_HIGHEST_DEGREE + 1];
    line_powers(p->order, near.o.x, near.d.x, x);
    line_powers(p->order, near.o.y, near.d.y, y);
    line_powers(p->order, near.o.z, near.d.z, z);
    int last_i = -1, last_j = -1;
    for (size_t n = 0; n < p->count; n++) {
        const Term *term = &p->terms[n];
        int i = term->power[0], j = term->power[1], k = term->power[2];
        if (i != last_i || j != last_j) roots_multiply(x[i], i, y[j], j, xy);
        last_i = i, last_j = j;
        roots_multiply(xy, i + j, z[k], k, xyz);
        for (int m = 0; m <= i + j + k; m++) total[m] += term->factor * xyz[m];
    }
    /* What rounding leaves of coefficients that cancel is no coefficient. */
    double largest = 0;
    for (int m = 0; m <= p->order; m++) largest = double_max(largest, fabs(total[m]));
    for (int m = p->order; m > 0 && fabs(total[m]) < 1e-15 * largest; m--) total[m] = 0;
    offer_zeros(total, p->order, &near, sink);
}

static Vec3 polynomial_normal(const void *data, Vec3 at, const SolidTag *tag) {
    const Polynomial *p = data;
    Powers powers;
    double gradient[3] = {0, 0, 0};
    (void)tag;
    powers_of(p, at, powers);
    for (size_t n = 0; n < p->count; n++)
        for (int axis = 0; axis < 3; axis++) {
            const Term *term = &p->terms[n];
            int own = term->power[axis], a = (axis + 1) % 3, b = (axis + 2) % 3;
            if (own)
                gradient[axis] += term->factor * own * powers[axis][own - 1] * powers[a][term->power[a]] *
                                  powers[b][term->power[b]];
        }
    return vec3_normalize(vec3(gradient[0], gradient[1], gradient[2]));
}

static bool polynomial_inside(const void *data, Vec3 at) {
    const Polynomial *p = data;
    Powers powers;
    double value = 0;
    powers_of(p, at, powers);
    for (size_t n = 0; n < p->count; n++) {
        const Term *term = &p->terms[n];
        value +=
            term->factor * powers[0][term->power[0]] * powers[1][term->power[1]] * powers[2][term->power[2]];
    }
    return value <= 0;
}

const SolidOps solid_polynomial_ops = {.prepare = polynomial_prepare,
                                       .cross = polynomial_cross,
                                       .normal = polynomial_normal,
                                       .inside = polynomial_inside,
                                       .bounds = quadric_bounds};
