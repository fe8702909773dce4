/* Surfaces that are given by two parameters: bicubic_patch, parametric. A grid of cells, each with a box that holds it,
 * tells where to look; Newton's steps find the place. */
#include "shape/box_tree.h"
#include "shape/intersect.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"

typedef struct ParamPoint {
    Vec3 p, du, dv;
} ParamPoint;

typedef struct ParamSurface {
    ParamPoint (*at)(const Solid *solid, double u, double v);
    const Solid *solid;
    double u0, v0, du, dv; /* of the grid; sizes of a cell */
    uint32_t cells;        /* along a side */
    const BoxTree *tree;
    Box3 bounds;
    const Object *container; /* NULL: none */
} ParamSurface;

enum { PATCH_CELLS = 16, PARAMETRIC_CELLS = 48, MOST_STEPS = 30 };

/* ---- the two kinds ---- */

static void bernstein(double t, double b[4], double d[4]) {
    double s = 1 - t;
    b[0] = s * s * s, b[1] = 3 * s * s * t, b[2] = 3 * s * t * t, b[3] = t * t * t;
    d[0] = -3 * s * s, d[1] = 3 * s * (s - 2 * t), d[2] = 3 * t * (2 * s - t), d[3] = 3 * t * t;
}

/* u runs along the rows of four points in the text, v from row to row. */
static ParamPoint patch_at(const Solid *s, double u, double v) {
    double bu[4], du[4], bv[4], dv[4];
    ParamPoint out = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    bernstein(u, bu, du);
    bernstein(v, bv, dv);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            Vec3 c = s->as.patch.points[4 * j + i];
            out.p = vec3_madd(out.p, c, bu[i] * bv[j]);
            out.du = vec3_madd(out.du, c, du[i] * bv[j]);
            out.dv = vec3_madd(out.dv, c, bu[i] * dv[j]);
        }
    return out;
}

static Vec3 parametric_point(const Solid *s, double u, double v) {
    double out[3][TAPE_CALL_MAX] = {{0}};
    for (int i = 0; i < 3; i++) tape_eval_once(s->as.parametric.functions[i], (double[]){u, v, 0}, out[i]);
    return vec3(out[0][0], out[1][0], out[2][0]);
}

static ParamPoint parametric_at(const Solid *s, double u, double v) {
    double hu = 1e-6 * double_max(fabs(s->as.parametric.u1 - s->as.parametric.u0), 1e-6);
    double hv = 1e-6 * double_max(fabs(s->as.parametric.v1 - s->as.parametric.v0), 1e-6);
    return (ParamPoint){
        parametric_point(s, u, v),
        vec3_scale(vec3_sub(parametric_point(s, u + hu, v), parametric_point(s, u - hu, v)), 0.5 / hu),
        vec3_scale(vec3_sub(parametric_point(s, u, v + hv), parametric_point(s, u, v - hv)), 0.5 / hv),
    };
}

/* ---- the grid ---- */

static double most(Vec3 v) { return double_max(fabs(v.x), double_max(fabs(v.y), fabs(v.z))); }

/* The box of nine points of a cell, widened by what the middles stand off the straight between their neighbours: for
 * smooth surfaces twice what a cell can bulge. */
static Box3 cell_box(const ParamSurface *surface, uint32_t i, uint32_t j) {
    Vec3 p[3][3];
    Box3 box = box3_empty();
    double bulge = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            p[a][b] = surface
                          ->at(surface->solid, surface->u0 + (i + 0.5 * b) * surface->du,
                               surface->v0 + (j + 0.5 * a) * surface->dv)
                          .p;
            if (!vec3_is_finite(p[a][b])) return box3_empty();
            box = box3_add_point(box, p[a][b]);
        }
    for (int a = 0; a < 3; a++) {
        bulge = double_max(bulge, most(vec3_sub(p[a][1], vec3_lerp(p[a][0], p[a][2], 0.5))));
        bulge = double_max(bulge, most(vec3_sub(p[1][a], vec3_lerp(p[0][a], p[2][a], 0.5))));
    }
    Vec3 margin = vec3_splat(bulge + 1e-12);
    return (Box3){vec3_sub(box.min, margin), vec3_add(box.max, margin)};
}

static const void *build(ParamSurface *surface, Arena *arena) {
    Box3 *boxes = arena_new_array(arena, Box3, (size_t)surface->cells * surface->cells);
    surface->bounds = box3_empty();
    for (uint32_t j = 0; j < surface->cells; j++)
        for (uint32_t i = 0; i < surface->cells; i++) {
            Box3 box = cell_box(surface, i, j);
            boxes[j * surface->cells + i] = box;
            if (!box3_is_empty(box)) surface->bounds = box3_union(surface->bounds, box);
        }
    surface->tree = box_tree_build(boxes, (size_t)surface->cells * surface->cells, arena);
    return surface;
}

static const void *patch_prepare(const Object *object, Arena *arena) {
    ParamSurface *surface = arena_new(arena, ParamSurface);
    *surface = (ParamSurface){.at = patch_at,
                              .solid = object->as.solid,
                              .cells = PATCH_CELLS,
                              .du = 1.0 / PATCH_CELLS,
                              .dv = 1.0 / PATCH_CELLS};
    return build(surface, arena);
}

static const void *parametric_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    ParamSurface *surface = arena_new(arena, ParamSurface);
    *surface = (ParamSurface){.at = parametric_at,
                              .solid = s,
                              .cells = PARAMETRIC_CELLS,
                              .u0 = s->as.parametric.u0,
                              .v0 = s->as.parametric.v0,
                              .du = (s->as.parametric.u1 - s->as.parametric.u0) / PARAMETRIC_CELLS,
                              .dv = (s->as.parametric.v1 - s->as.parametric.v0) / PARAMETRIC_CELLS,
                              .container = s->as.parametric.container};
    return build(surface, arena);
}

void solid_sheet_at(const void *data, double u, double v, Vec3 *p, Vec3 *normal) {
    const ParamSurface *s = data;
    ParamPoint at = s->at(s->solid, s->u0 + u * s->du * s->cells, s->v0 + v * s->dv * s->cells);
    *p = at.p;
    *normal = vec3_normalize(vec3_cross(at.du, at.dv));
    if (!vec3_is_finite(*normal)) *normal = vec3_splat(0);
}

/* ---- rays ---- */

typedef struct ParamVisit {
    const ParamSurface *surface;
    const Ray *ray;
    Vec3 a, b; /* across the ray */
    SolidSink *sink;
    double last[16]; /* t of crossings found already: neighbouring cells may find the same */
    int count;
} ParamVisit;

/* Steps towards a place on the ray, by the two coordinates across it; false when they lead away. */
static bool newton(const ParamVisit *visit, double *u, double *v, ParamPoint *at) {
    const ParamSurface *s = visit->surface;
    for (int i = 0; i < MOST_STEPS; i++) {
        *at = s->at(s->solid, *u, *v);
        Vec3 off = vec3_sub(at->p, visit->ray->origin);
        double x = vec3_dot(off, visit->a), y = vec3_dot(off, visit->b);
        double xu = vec3_dot(at->du, visit->a), xv = vec3_dot(at->dv, visit->a),
               yu = vec3_dot(at->du, visit->b), yv = vec3_dot(at->dv, visit->b),
               determinant = xu * yv - xv * yu;
        double step_u = (x * yv - y * xv) / determinant, step_v = (y * xu - x * yu) / determinant;
        if (!isfinite(step_u) || !isfinite(step_v)) return false;
        *u -= step_u, *v -= step_v;
        if (fabs(step_u) <= 1e-13 * fabs(s->du) * s->cells && fabs(step_v) <= 1e-13 * fabs(s->dv) * s->cells)
            return true;
        if (fabs(step_u) > 8 * fabs(s->du) * s->cells) return false;
    }
    return fabs(vec3_dot(vec3_sub(at->p, visit->ray->origin), visit->a)) +
               fabs(vec3_dot(vec3_sub(at->p, visit->ray->origin), visit->b)) <
           1e-7 * (1 + most(at->p));
}

static bool within(double x, double from, double size) {
    double share = (x - from) / size;
    return share >= -1e-9 && share <= 1 + 1e-9;
}

static bool contained(const ParamSurface *s, Vec3 p) {
    if (!s->container) return true;
    Transform place = object_transform(s->container);
    return shape_inside(s->container, transform_point_back(&place, p));
}

static void visit_cell(void *context, uint32_t cell) {
    ParamVisit *visit = context;
    const ParamSurface *s = visit->surface;
    double u = s->u0 + (cell % s->cells + 0.5) * s->du, v = s->v0 + (cell / s->cells + 0.5) * s->dv;
    ParamPoint at;
    if (!newton(visit, &u, &v, &at) || !within(u, s->u0, s->du * s->cells) ||
        !within(v, s->v0, s->dv * s->cells))
        return;
    double t = vec3_dot(vec3_sub(at.p, visit->ray->origin), visit->ray->direction) /
               vec3_length_squared(visit->ray->direction);
    for (int i = 0; i < visit->count; i++)
        if (fabs(visit->last[i] - t) < 1e-9 * (1 + fabs(t))) return;
    if (visit->count < (int)VTS_ARRAY_COUNT(visit->last)) visit->last[visit->count++] = t;
    if (contained(s, at.p)) solid_offer(visit->sink, t, (SolidTag){0, u, v});
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    ParamVisit visit = {.surface = data, .ray = ray, .sink = sink};
    vec3_frame(vec3_normalize(ray->direction), &visit.a, &visit.b);
    box_tree_ray(visit.surface->tree, ray, sink->t_min, &sink->t_max, visit_cell, &visit);
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const ParamSurface *s = data;
    (void)p;
    ParamPoint at = s->at(s->solid, tag->u, tag->v);
    return vec3_normalize(vec3_cross(at.du, at.dv));
}

static Vec3 patch_normal(const void *data, Vec3 p, const SolidTag *tag) {
    return vec3_negate(normal(data, p, tag));
}

static TexCoord uv(const void *data, Vec3 p, const SolidTag *tag) {
    (void)data, (void)p;
    return (TexCoord){tag->u, tag->v};
}

static Box3 bounds(const void *data) { return ((const ParamSurface *)data)->bounds; }

const SolidOps solid_patch_ops = {
    .prepare = patch_prepare, .cross = cross, .normal = patch_normal, .uv = uv, .bounds = bounds};
const SolidOps solid_parametric_ops = {
    .prepare = parametric_prepare, .cross = cross, .normal = normal, .uv = uv, .bounds = bounds};
