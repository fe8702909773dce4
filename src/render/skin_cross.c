#include "render/skin_cross.h"

/* Faces reach this far beyond their edges. */
static const double MARGIN = 1e-7;

typedef struct Crossings {
    const Ray *ray;
    double t_min, t_max;
    SkinCrossing *list;
    int count;
} Crossings;

/* A bilinear patch q0 + q1·s + q2·r + q3·s·r. */
typedef struct Patch {
    Vec3 q0, q1, q2, q3;
} Patch;

/* Corners of the unit square and the unit triangle, in the order of their edges. */
static const double SQUARE[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}, TRIANGLE[4][2] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}};

static Vec3 at(const BilinearVec *f, double a, double b) {
    return vec3_madd(vec3_madd(f->c[0], f->c[1], a), vec3_madd(f->c[2], f->c[3], a), b);
}

static void add(Crossings *c, SkinCrossing x) {
    if (!(x.t > c->t_min && x.t < c->t_max) || c->count == MOST_CROSSINGS) return;
    int i = c->count++;
    for (; i > 0 && c->list[i - 1].t > x.t; i--) c->list[i] = c->list[i - 1];
    c->list[i] = x;
}

static bool within(double x) { return x >= -MARGIN && x <= 1 + MARGIN; }

/* Zeros of c0 + c1·s + c2·s² without cancellation. */
static int solve_quadratic(double c0, double c1, double c2, double roots[2]) {
    int count = 0;
    if (fabs(c2) <= 1e-14 * (fabs(c0) + fabs(c1) + fabs(c2))) {
        if (c1 != 0) roots[count++] = -c0 / c1;
        return count;
    }
    double disc = c1 * c1 - 4 * c0 * c2;
    if (disc < 0) return 0;
    double half = -0.5 * (c1 + copysign(sqrt(disc), c1));
    roots[count++] = half / c2;
    if (half != 0) roots[count++] = c0 / half;
    return count;
}

/* Whether c0 + c1·s + c2·s² is surely not 0 in the unit interval with its margin: its Bernstein coefficients. Most walls pass by this. */
static bool keeps_its_sign(double c0, double c1, double c2) {
    double half = c0 + 0.5 * c1, end = c0 + c1 + c2, hair = 4 * MARGIN * (fabs(c0) + fabs(c1) + fabs(c2));
    return (c0 > hair && half > hair && end > hair) || (c0 < -hair && half < -hair && end < -hair);
}

/* The places (s, r) at which the ray meets the patch, in the unit square with its margin: the quadratic of Reshetov 2019 in s, from
 * the coplanarity of the ray and the patch's ruling at s. */
typedef struct PatchHit {
    double t, s, r, facing; /* facing = direction · (∂/∂s × ∂/∂r) */
} PatchHit;

static int meet_patch(const Ray *ray, const Patch *p, PatchHit hits[2]) {
    /* Ruling at s: base q0 + s·q1 (relative to the origin), direction q2 + s·q3. Coplanar with d: (base × ruling) · d = 0. */
    Vec3 base = vec3_sub(p->q0, ray->origin), d = ray->direction;
    double c0 = vec3_dot(vec3_cross(base, p->q2), d), c2 = vec3_dot(vec3_cross(p->q1, p->q3), d);
    double c1 = vec3_dot(vec3_add(vec3_cross(base, p->q3), vec3_cross(p->q1, p->q2)), d), roots[2];
    if (keeps_its_sign(c0, c1, c2)) return 0;
    int found = solve_quadratic(c0, c1, c2, roots), count = 0;
    for (int i = 0; i < found; i++) {
        double s = roots[i];
        if (!within(s)) continue;
        Vec3 on = vec3_madd(base, p->q1, s), along = vec3_madd(p->q2, p->q3, s);
        /* on + r·along = t·d: least squares by the normal of both. */
        Vec3 n = vec3_cross(along, d);
        double nn = vec3_length_squared(n);
        if (nn == 0) continue;
        double r = -vec3_dot(vec3_cross(on, d), n) / nn;
        if (!within(r)) continue;
        double t = vec3_dot(vec3_madd(on, along, r), d) / vec3_length_squared(d);
        hits[count++] = (PatchHit){t, s, r, vec3_dot(vec3_madd(p->q1, p->q3, r), n)};
    }
    return count;
}

static void cross_wall(Crossings *out, const SkinCell *cell, int edge) {
    const double *from = cell->triangle ? TRIANGLE[edge] : SQUARE[edge], *to = cell->triangle ? TRIANGLE[edge + 1] : SQUARE[edge + 1];
    Vec3 p0 = at(&cell->foot, from[0], from[1]), p1 = at(&cell->foot, to[0], to[1]);
    Vec3 h0 = at(&cell->height, from[0], from[1]), h1 = at(&cell->height, to[0], to[1]);
    const Patch patch = {p0, vec3_sub(p1, p0), h0, vec3_sub(h1, h0)};
    PatchHit hits[2];
    int count = meet_patch(out->ray, &patch, hits);
    for (int i = 0; i < count; i++) {
        double s = hits[i].s;
        add(out, (SkinCrossing){hits[i].t, from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1]), hits[i].r, edge, hits[i].facing});
    }
}

static void cross_bilinear_lid(Crossings *out, const Patch *p, int face) {
    PatchHit hits[2];
    int count = meet_patch(out->ray, p, hits);
    for (int i = 0; i < count; i++)
        add(out, (SkinCrossing){hits[i].t, hits[i].s, hits[i].r, face == FACE_TOP, face, face == FACE_TOP ? hits[i].facing : -hits[i].facing});
}

static void cross_flat_lid(Crossings *out, const Patch *p, int face) {
    Vec3 h = vec3_cross(out->ray->direction, p->q2);
    double det = vec3_dot(p->q1, h);
    if (det == 0) return;
    Vec3 s = vec3_sub(out->ray->origin, p->q0), q = vec3_cross(s, p->q1);
    double a = vec3_dot(s, h) / det, b = vec3_dot(out->ray->direction, q) / det;
    if (a < -MARGIN || b < -MARGIN || a + b > 1 + MARGIN) return;
    add(out, (SkinCrossing){vec3_dot(p->q2, q) / det, a, b, face == FACE_TOP, face, face == FACE_TOP ? -det : det});
}

static void cross_lid(Crossings *out, const SkinCell *cell, int face) {
    Vec3 q[4];
    for (int i = 0; i < 4; i++) q[i] = face == FACE_TOP ? vec3_add(cell->foot.c[i], cell->height.c[i]) : cell->foot.c[i];
    const Patch patch = {q[0], q[1], q[2], q[3]};
    if (cell->triangle) cross_flat_lid(out, &patch, face);
    else cross_bilinear_lid(out, &patch, face);
}

int skin_cell_cross(const SkinCell *cell, const Ray *ray, double t_min, double t_max, SkinCrossing *list) {
    Crossings c = {ray, t_min, t_max, list, 0};
    cross_lid(&c, cell, FACE_FOOT);
    cross_lid(&c, cell, FACE_TOP);
    for (int edge = 0; edge < (cell->triangle ? 3 : 4); edge++) cross_wall(&c, cell, edge);
    return c.count;
}
