/* A piece of a ray's way through texel space: a cubic, known by its ends and its rates there (Hermite). Its parameter s is linear
 * along the ray and runs from 0 to 1; parts of a curve remember which parts they are. */
#ifndef VTS_RENDER_CURVE_H
#define VTS_RENDER_CURVE_H

#include "base/vec.h"

/* from + s·chord + s(1−s)·((1−s)·bow_from − s·bow_to): the bows are what the rates at the ends exceed the chord by. */
typedef struct Curve {
    Vec3 from, chord, bow_from, bow_to;
    double start, length; /* its s stands for start + length·s of the whole: 0 and 1 where it is the whole */
} Curve;

static inline Vec3 curve_point(const Curve *c, double s) {
    double hump = s * (1 - s);
    return vec3_madd(vec3_madd(vec3_madd(c->from, c->chord, s), c->bow_from, hump * (1 - s)), c->bow_to, -hump * s);
}

static inline Vec3 curve_rate(const Curve *c, double s) {
    return vec3_madd(vec3_madd(c->chord, c->bow_from, (1 - s) * (1 - 3 * s)), c->bow_to, s * (3 * s - 2));
}

/* The curve between s0 and s1, as a curve of its own. */
static inline Curve curve_part(const Curve *c, double s0, double s1) {
    Vec3 from = curve_point(c, s0), chord = vec3_sub(curve_point(c, s1), from);
    Vec3 rate_from = vec3_scale(curve_rate(c, s0), s1 - s0), rate_to = vec3_scale(curve_rate(c, s1), s1 - s0);
    return (Curve){from, chord, vec3_sub(rate_from, chord), vec3_sub(rate_to, chord), c->start + c->length * s0, c->length * (s1 - s0)};
}

/* How far it leaves its chord along each axis, at most: of s(1−s)((1−s)A − sB), a quarter of the larger bow. */
static inline Vec3 curve_spread(const Curve *c) {
    Vec3 a = c->bow_from, b = c->bow_to;
    return vec3(double_max(fabs(a.x), fabs(b.x)) / 4, double_max(fabs(a.y), fabs(b.y)) / 4, double_max(fabs(a.z), fabs(b.z)) / 4);
}

/* A box around it: that of its control points. */
static inline Box3 curve_hull(const Curve *c) {
    Vec3 to = vec3_add(c->from, c->chord);
    Vec3 p = vec3_madd(c->from, vec3_add(c->chord, c->bow_from), 1.0 / 3), q = vec3_madd(to, vec3_add(c->chord, c->bow_to), -1.0 / 3);
    Box3 box = {c->from, c->from};
    for (int i = 0; i < 3; i++) {
        Vec3 at = i == 0 ? to : i == 1 ? p : q;
        box.min = vec3(double_min(box.min.x, at.x), double_min(box.min.y, at.y), double_min(box.min.z, at.z));
        box.max = vec3(double_max(box.max.x, at.x), double_max(box.max.y, at.y), double_max(box.max.z, at.z));
    }
    return box;
}

/* The height of a curve over a plane: Bernstein coefficients of n·(x(s) − corner), which its values lie between. */
typedef struct CurvePlane {
    double b[4];
} CurvePlane;

static inline CurvePlane curve_over_plane(const Curve *c, Vec3 corner, Vec3 n) {
    double from = vec3_dot(n, vec3_sub(c->from, corner)), chord = vec3_dot(n, c->chord);
    return (CurvePlane){{from, from + (chord + vec3_dot(n, c->bow_from)) / 3, from + chord - (chord + vec3_dot(n, c->bow_to)) / 3, from + chord}};
}

static inline bool curve_misses_plane(const CurvePlane *p) {
    const double *b = p->b;
    return (b[0] > 0 && b[1] > 0 && b[2] > 0 && b[3] > 0) || (b[0] < 0 && b[1] < 0 && b[2] < 0 && b[3] < 0);
}

/* The places where it meets the plane, ascending, in s; at most three. What touches the plane without passing it may be left out. */
int curve_plane_roots(const CurvePlane *plane, double s[3]);

#endif
