/* World ↔ skin space: evaluating and inverting the mapping of a cell, going from cell to cell, entering the layer. */
#include "render/skin.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

enum { NEWTON_STEPS = 12, MOST_HOPS = 64 };

static Vec3 bilinear_vec(const BilinearVec *f, double a, double b) {
    return vec3_madd(vec3_madd(f->c[0], f->c[1], a), vec3_madd(f->c[2], f->c[3], a), b);
}
static Vec3 bilinear_vec_da(const BilinearVec *f, double b) { return vec3_madd(f->c[1], f->c[3], b); }
static Vec3 bilinear_vec_db(const BilinearVec *f, double a) { return vec3_madd(f->c[2], f->c[3], a); }

Vec3 skin_cell_position(const SkinCell *cell, double a, double b, double w, Mat3 *jacobian) {
    Vec3 height = bilinear_vec(&cell->height, a, b);
    if (jacobian) {
        jacobian->c[0] = vec3_madd(bilinear_vec_da(&cell->foot, b), bilinear_vec_da(&cell->height, b), w);
        jacobian->c[1] = vec3_madd(bilinear_vec_db(&cell->foot, a), bilinear_vec_db(&cell->height, a), w);
        jacobian->c[2] = height;
    }
    return vec3_madd(bilinear_vec(&cell->foot, a, b), height, w);
}

/* One Newton step towards `world`; *error gets the distance before the step. False where the Jacobian is singular. */
static bool newton_step(const SkinCell *cell, Vec3 world, SkinPoint *p, double *error) {
    Mat3 j;
    Vec3 rest = vec3_sub(world, skin_cell_position(cell, p->a, p->b, p->w, &j));
    *error = vec3_length(rest);
    Vec3 bc = vec3_cross(j.c[1], j.c[2]);
    double det = vec3_dot(j.c[0], bc);
    double inverse = 1 / det;
    if (!isfinite(inverse)) return false;
    p->a += vec3_dot(bc, rest) * inverse;
    p->b += vec3_dot(vec3_cross(j.c[2], j.c[0]), rest) * inverse;
    p->w += vec3_dot(vec3_cross(j.c[0], j.c[1]), rest) * inverse;
    return true;
}

bool skin_cell_invert(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *point) {
    for (int i = 0; i < NEWTON_STEPS; i++) {
        double error;
        if (!newton_step(cell, world, point, &error)) return false;
        if (error <= tolerance) return true; /* the step just made has squared it */
        if (!(fabs(point->a) < 1e3 && fabs(point->b) < 1e3 && fabs(point->w) < 1e3)) return false;
    }
    return false;
}

/* ---- from cell to cell ---- */

/* How far the point is beyond each edge of its cell, in cell units; edges numbered as in surface_mesh.h. */
static int worst_edge(const SkinCell *cell, const SkinPoint *p, double *beyond) {
    double out[4] = {-p->b, 0, 0, -p->a};
    int count = 4;
    if (cell->triangle) {
        out[1] = p->a + p->b - 1;
        out[2] = -p->a;
        count = 3;
    } else {
        out[1] = p->a - 1;
        out[2] = p->b - 1;
    }
    int worst = 0;
    for (int e = 1; e < count; e++)
        if (out[e] > out[worst]) worst = e;
    *beyond = out[worst];
    return worst;
}

/* The place along edge e, 0 at its first corner. */
static double along_edge(const SkinCell *cell, int e, const SkinPoint *p) {
    if (cell->triangle) return e == 0 ? p->a : e == 1 ? (p->b - p->a + 1) / 2 : 1 - p->b;
    return e == 0 ? p->a : e == 1 ? p->b : e == 2 ? 1 - p->a : 1 - p->b;
}

/* The point at `s` along edge e, `in` inside of it. */
static void point_at_edge(const SkinCell *cell, int e, double s, double in, SkinPoint *p) {
    if (cell->triangle) {
        static const double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        const double *from = corner[e], *to = corner[(e + 1) % 3], *opposite = corner[(e + 2) % 3];
        double a = from[0] + s * (to[0] - from[0]), b = from[1] + s * (to[1] - from[1]);
        double middle_a = (from[0] + to[0]) / 2, middle_b = (from[1] + to[1]) / 2;
        p->a = a + in * (opposite[0] - middle_a);
        p->b = b + in * (opposite[1] - middle_b);
        return;
    }
    switch (e) {
    case 0: p->a = s, p->b = in; break;
    case 1: p->a = 1 - in, p->b = s; break;
    case 2: p->a = 1 - s, p->b = 1 - in; break;
    default: p->a = in, p->b = 1 - s; break;
    }
}

SkinSide skin_locate(const CompiledSkin *skin, Vec3 world, double tolerance, SkinPoint *point, bool *crossed_seam) {
    int32_t before = -1;
    for (int hop = 0; hop < MOST_HOPS; hop++) {
        const SkinCell *cell = &skin->cells[point->cell];
        if (!skin_cell_invert(cell, world, tolerance, point)) return SKIN_LOST;
        double beyond;
        int edge = worst_edge(cell, point, &beyond);
        if (beyond <= 0) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_INSIDE;
        SurfaceNeighbour next = cell->neighbour[edge];
        /* A point on a wall may lie outside of both cells by rounding: the first one keeps it. */
        if (next.cell == before && beyond < 1e-9) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_INSIDE;
        if (next.cell < 0) return point->w > 1 ? SKIN_ABOVE : point->w < 0 ? SKIN_BELOW : SKIN_BORDER;
        *crossed_seam |= next.seam;
        double s = 1 - along_edge(cell, edge, point);
        before = point->cell;
        point->cell = next.cell;
        point_at_edge(&skin->cells[next.cell], next.edge, double_clamp(s, -2, 3), double_min(beyond, 2), point);
    }
    return SKIN_LOST;
}

/* ---- entering the layer ---- */

static void add_crossing(SkinCuts *c, double t, double t_min, double t_max) {
    if (!(t > t_min && t < t_max) || c->count == MOST_SKIN_CUTS - 1) return; /* room for the end */
    int i = c->count++;
    for (; i > 0 && c->t[i - 1] > t; i--) c->t[i] = c->t[i - 1];
    c->t[i] = t;
}

/* Where the ray meets the bilinear patch q0 + q1·s + q2·r + q3·s·r (s, r in [0, 1] with a margin): the quadratic of
 * Reshetov 2019 in s, from the coplanarity of the ray and the patch's ruling at s. */
static void cross_patch(SkinCuts *out, const Ray *ray, Vec3 q0, Vec3 q1, Vec3 q2, Vec3 q3, double t_min, double t_max) {
    const double margin = 1e-7;
    /* Ruling at s: base q0 + s·q1 (relative to the origin), direction q2 + s·q3. Coplanar with d: (base × ruling) · d = 0. */
    Vec3 base = vec3_sub(q0, ray->origin), d = ray->direction;
    double c0 = vec3_dot(vec3_cross(base, q2), d);
    double c2 = vec3_dot(vec3_cross(q1, q3), d);
    double c1 = vec3_dot(vec3_add(vec3_cross(base, q3), vec3_cross(q1, q2)), d);
    double roots[2];
    int count = 0;
    double scale = fabs(c0) + fabs(c1) + fabs(c2);
    if (fabs(c2) <= 1e-14 * scale) {
        if (c1 != 0) roots[count++] = -c0 / c1;
    } else {
        double disc = c1 * c1 - 4 * c0 * c2;
        if (disc < 0) return;
        double half = -0.5 * (c1 + copysign(sqrt(disc), c1));
        roots[count++] = half / c2;
        if (half != 0) roots[count++] = c0 / half;
    }
    for (int i = 0; i < count; i++) {
        double s = roots[i];
        if (!(s >= -margin && s <= 1 + margin)) continue;
        Vec3 on = vec3_madd(base, q1, s), along = vec3_madd(q2, q3, s);
        /* on + r·along = t·d: least squares by the normal of both. */
        Vec3 n = vec3_cross(along, d);
        double nn = vec3_length_squared(n);
        if (nn == 0) continue;
        double r = -vec3_dot(vec3_cross(on, d), n) / nn;
        if (!(r >= -margin && r <= 1 + margin)) continue;
        double t = vec3_dot(vec3_madd(on, along, r), d) / vec3_length_squared(d);
        add_crossing(out, t, t_min, t_max);
    }
}

static void cross_triangle(SkinCuts *out, const Ray *ray, Vec3 p, Vec3 e1, Vec3 e2, double t_min, double t_max) {
    const double margin = 1e-7;
    Vec3 h = vec3_cross(ray->direction, e2);
    double det = vec3_dot(e1, h);
    if (det == 0) return;
    Vec3 s = vec3_sub(ray->origin, p), q = vec3_cross(s, e1);
    double a = vec3_dot(s, h) / det, b = vec3_dot(ray->direction, q) / det;
    if (a < -margin || b < -margin || a + b > 1 + margin) return;
    add_crossing(out, vec3_dot(e2, q) / det, t_min, t_max);
}

/* Side wall over the edge from (a0, b0) to (a1, b1). */
static void cross_wall(SkinCuts *out, const Ray *ray, const SkinCell *cell, double a0, double b0, double a1, double b1,
                       double t_min, double t_max) {
    Vec3 p0 = bilinear_vec(&cell->foot, a0, b0), p1 = bilinear_vec(&cell->foot, a1, b1);
    Vec3 h0 = bilinear_vec(&cell->height, a0, b0), h1 = bilinear_vec(&cell->height, a1, b1);
    cross_patch(out, ray, p0, vec3_sub(p1, p0), h0, vec3_sub(h1, h0), t_min, t_max);
}

Box3 skin_cell_bounds(const SkinCell *cell) {
    Box3 box = box3_empty();
    for (int i = 0; i < 4; i++) {
        double a = i & 1, b = (i >> 1) & 1;
        if (cell->triangle && i == 3) break;
        box = box3_add_point(box, skin_cell_position(cell, a, b, 0, NULL));
        box = box3_add_point(box, skin_cell_position(cell, a, b, 1, NULL));
    }
    return box;
}

bool skin_cell_holds(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *p) {
    double beyond;
    p->a = p->b = cell->triangle ? 1.0 / 3 : 0.5;
    p->w = 0.5;
    if (!skin_cell_invert(cell, world, tolerance, p)) return false;
    worst_edge(cell, p, &beyond);
    return beyond <= 1e-7 && p->w >= -1e-7 && p->w <= 1 + 1e-7;
}

bool skin_cell_cut(const SkinCell *cell, const Ray *ray, double t_min, double t_max, SkinCuts *c) {
    double lo = t_min, hi = t_max;
    c->count = 0;
    if (!box3_clip_ray(cell->bounds, ray, &lo, &hi)) return false;
    for (int k = 0; k < 2; k++) { /* foot and top */
        Vec3 q[4];
        for (int i = 0; i < 4; i++) q[i] = k ? vec3_add(cell->foot.c[i], cell->height.c[i]) : cell->foot.c[i];
        if (cell->triangle) cross_triangle(c, ray, q[0], q[1], q[2], lo, hi);
        else cross_patch(c, ray, q[0], q[1], q[2], q[3], lo, hi);
    }
    cross_wall(c, ray, cell, 0, 0, 1, 0, lo, hi);
    cross_wall(c, ray, cell, 0, 0, 0, 1, lo, hi);
    if (cell->triangle) cross_wall(c, ray, cell, 1, 0, 0, 1, lo, hi);
    else {
        cross_wall(c, ray, cell, 1, 0, 1, 1, lo, hi);
        cross_wall(c, ray, cell, 0, 1, 1, 1, lo, hi);
    }
    c->from = lo;
    c->t[c->count++] = hi;
    return true;
}

/* The first t of the ray within this cell: the first piece between walls whose middle lies inside. */
static bool enter_cell(const SkinCell *cell, const Ray *ray, double t_min, double t_max, SkinPoint *point, double *t) {
    SkinCuts cuts;
    if (!skin_cell_cut(cell, ray, t_min, t_max, &cuts)) return false;
    double size = vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min)), tolerance = 1e-9 * size;
    double from = cuts.from;
    for (int i = 0; i < cuts.count; i++) {
        double to = cuts.t[i];
        Vec3 middle = vec3_madd(ray->origin, ray->direction, (from + to) / 2);
        if (to > from && skin_cell_holds(cell, middle, tolerance, point)) {
            *t = from;
            return true;
        }
        from = to;
    }
    return false;
}

/* Embree's hierarchy over the cells, each a user primitive. */
struct CellTree {
    RTCScene scene;
};

typedef struct EnterQuery {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const CompiledSkin *skin;
    const Ray *ray;
    double t_min, t;
    SkinPoint point;
} EnterQuery;

void skin_bound_cell(const struct RTCBoundsFunctionArguments *args) {
    const CompiledSkin *skin = args->geometryUserPtr;
    Box3 box = skin->cells[args->primID].bounds;
    /* Floats are coarser than doubles: grow by more than their rounding. */
    Vec3 size = vec3_max(vec3_max(vec3_negate(box.min), box.max), vec3_max(box.min, vec3_negate(box.max)));
    double margin = 1e-6 * (size.x + size.y + size.z) + 1e-30;
    struct RTCBounds *b = args->bounds_o;
    b->lower_x = (float)(box.min.x - margin), b->upper_x = (float)(box.max.x + margin);
    b->lower_y = (float)(box.min.y - margin), b->upper_y = (float)(box.max.y + margin);
    b->lower_z = (float)(box.min.z - margin), b->upper_z = (float)(box.max.z + margin);
}

static void intersect_cell(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    EnterQuery *query = (EnterQuery *)(void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    SkinPoint point = {.cell = (int32_t)args->primID};
    double t;
    if (!enter_cell(&query->skin->cells[args->primID], query->ray, query->t_min, query->t, &point, &t) || t >= query->t) return;
    query->t = t;
    query->point = point;
    rayhit->ray.tfar = (float)t;
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

CellTree *cell_tree_build(CompiledSkin *skin, void *embree_device) {
    CellTree *tree = calloc(1, sizeof *tree);
    if (!tree) return NULL;
    RTCDevice device = embree_device;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)skin->cell_count);
    rtcSetGeometryUserData(geometry, skin);
    rtcSetGeometryBoundsFunction(geometry, skin_bound_cell, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_cell);
    rtcCommitGeometry(geometry);
    tree->scene = rtcNewScene(device);
    rtcAttachGeometry(tree->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree->scene);
    return tree;
}

void cell_tree_destroy(CellTree *tree) {
    if (!tree) return;
    rtcReleaseScene(tree->scene);
    free(tree);
}

bool skin_enter(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, SkinPoint *point, double *t) {
    EnterQuery query = {.skin = skin, .ray = ray, .t_min = t_min, .t = t_max, .point = {.cell = -1}};
    rtcInitIntersectContext(&query.context);
    struct RTCRayHit rayhit = {
        .ray = {.org_x = (float)ray->origin.x, .org_y = (float)ray->origin.y, .org_z = (float)ray->origin.z,
                .dir_x = (float)ray->direction.x, .dir_y = (float)ray->direction.y, .dir_z = (float)ray->direction.z,
                .tnear = (float)t_min, .tfar = t_max < 1e30 ? (float)t_max : INFINITY, .mask = 0xFFFFFFFFu},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(skin->tree->scene, &query.context, &rayhit);
    if (query.point.cell < 0) return false;
    *point = query.point;
    *t = query.t;
    return true;
}
