#include "shape/extent.h"

#include "shape/intersect.h"
#include "shape/solid_text.h"

/* Boxes are made in the shape's own space, for sets around the boxes of their parts, and moved with all that is applied: a
 * box around a turned box. Infinite in an axis: no end there. */

enum { DEEPEST = 1000 };

typedef struct Extent {
    ShapeTracer *tracer;
    uint64_t budget; /* objects that may still be looked at */
    int depth;
} Extent;

static Box3 infinite(void) { return (Box3){vec3_splat(-VTS_INFINITY), vec3_splat(VTS_INFINITY)}; }
static bool is_finite(Box3 b) { return vec3_is_finite(b.min) && vec3_is_finite(b.max); }
static Box3 moved(const Transform *t, Box3 b) { return is_finite(b) ? box3_transform(t, b) : infinite(); }
static Box3 widened(Box3 b, double by) {
    return (Box3){vec3_sub(b.min, vec3_splat(by)), vec3_add(b.max, vec3_splat(by))};
}
static Box3 common(Box3 a, Box3 b) { return (Box3){vec3_max(a.min, b.min), vec3_min(a.max, b.max)}; }

/* The frame in which POV-Ray keeps what stands along a unit vector: about z by the vector's azimuth, about y by its
 * angle to z, about z by the azimuth again. */
static Transform standing_frame(Vec3 n, Vec3 origin) {
    double h = hypot(n.x, n.y), c = h > 1e-9 ? n.x / h : 1, s = h > 1e-9 ? n.y / h : 0;
    Transform t = transform_identity();
    t.linear.c[0] = vec3(c * n.z * c - s * s, s * n.z * c + c * s, -h * c);
    t.linear.c[1] = vec3(-c * n.z * s - s * c, -s * n.z * s + c * c, h * s);
    t.linear.c[2] = n;
    t.offset = origin;
    return t;
}

static Box3 standing_box(Vec3 n, Vec3 origin, Box3 box, const Transform *place) {
    Transform frame = standing_frame(n, origin);
    Transform t = {.linear = mat3_multiply(&place->linear, &frame.linear),
                   .offset = transform_point(place, origin)};
    return box3_transform(&t, box);
}

/* From the wider end to the other. */
static Box3 cone_box(const Object *o, const Transform *place) {
    Vec3 from = o->as.cone.base, to = o->as.cone.cap;
    double r0 = fabs(o->as.cone.base_radius), r1 = fabs(o->as.cone.cap_radius), r = double_max(r0, r1);
    if (r1 > r0) from = o->as.cone.cap, to = o->as.cone.base;
    Vec3 axis = vec3_sub(to, from);
    double length = vec3_length(axis);
    return standing_box(vec3_scale(axis, 1 / length), from, (Box3){{-r, -r, 0}, {r, r, length}}, place);
}

static Box3 disc_box(const Object *o, const Transform *place) {
    double r = o->as.disc.radius;
    return standing_box(vec3_negate(o->as.disc.normal), o->as.disc.center,
                        (Box3){{-r, -r, -0.001}, {r, r, 0.001}}, place);
}

/* A sphere that is still one after `t` keeps its own box. */
static Box3 sphere_box(const Object *o, const Transform *t) {
    Vec3 x = t->linear.c[0], y = t->linear.c[1], z = t->linear.c[2];
    double scale = vec3_length(x), r = fabs(o->as.sphere.radius);
    bool skewed = fabs(vec3_dot(x, y)) + fabs(vec3_dot(x, z)) + fabs(vec3_dot(y, z)) > 1e-9 * scale * scale;
    if (skewed || fabs(scale - vec3_length(y)) + fabs(scale - vec3_length(z)) > 1e-9 * scale)
        return box3_transform(t, widened((Box3){o->as.sphere.center, o->as.sphere.center}, r));
    Vec3 c = transform_point(t, o->as.sphere.center);
    return widened((Box3){c, c}, r * scale);
}

static Box3 points_box(const Vec3 *points, size_t count, const Transform *t) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < count; i++) box = box3_add_point(box, transform_point(t, points[i]));
    return box;
}

static Box3 mesh_box(const Object *o, const Transform *t) {
    const MeshData *mesh = o->as.mesh;
    const Transform identity = transform_identity();
    if (mesh->single) return widened(points_box(mesh->vertices, mesh->vertex_count, t), 1e-10);
    return moved(t, points_box(mesh->vertices, mesh->vertex_count, &identity));
}

static void thicken(double *lo, double *hi) {
    if (*hi - *lo < 1e-3) *lo -= 1e-3, *hi += 1e-3;
}

static Box3 polygon_box(const Solid *s, const Transform *t) {
    Box3 box = points_box(s->as.polygon.points, s->as.polygon.count, t);
    thicken(&box.min.x, &box.max.x);
    thicken(&box.min.y, &box.max.y);
    thicken(&box.min.z, &box.max.z);
    return box;
}

/* Those whose axes are the coordinate axes' have ends where their squares have the same sign as the others or there is nothing
 * of that axis. */
static Box3 quadric_box(const Solid *s) {
    double squares[3] = {s->as.quadric.squares.x, s->as.quadric.squares.y, s->as.quadric.squares.z};
    double linear[3] = {s->as.quadric.linear.x, s->as.quadric.linear.y, s->as.quadric.linear.z};
    double rest = -s->as.quadric.constant, sign = 0, lo[3], hi[3];
    if (vec3_length_squared(s->as.quadric.mixed) > 0) return infinite();
    for (int i = 0; i < 3; i++) sign = sign == 0 ? squares[i] : sign;
    for (int i = 0; i < 3; i++) {
        if (squares[i] * sign < 0 || (squares[i] == 0 && linear[i] != 0)) return infinite();
        if (squares[i] != 0) rest += linear[i] * linear[i] / (4 * squares[i]);
    }
    for (int i = 0; i < 3; i++) {
        double half = squares[i] != 0 ? sqrt(double_max(rest / squares[i], 0)) : VTS_INFINITY;
        double middle = squares[i] != 0 ? -linear[i] / (2 * squares[i]) : 0;
        lo[i] = middle - half, hi[i] = middle + half;
    }
    return (Box3){{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

static double row_sum(const Transform *t, int row) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += fabs(vec3_get(t->linear.c[i], row));
    return sum;
}

static Box3 ball_box(const Transform *t, Vec3 center, double radius) {
    double scale = double_max(row_sum(t, 0), double_max(row_sum(t, 1), row_sum(t, 2)));
    Vec3 c = transform_point(t, center);
    return widened((Box3){c, c}, radius * scale);
}

/* Balls around the parts, as large as the largest sum of a row of their transforms makes them. */
static Box3 blob_box(const Solid *s) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < s->as.blob.count; i++) {
        const BlobPart *part = &s->as.blob.parts[i];
        Vec3 axis = vec3_sub(part->cap, part->base);
        double length = vec3_length(axis), r = fabs(part->radius);
        if (!(part->strength > 0)) continue;
        if (length == 0) {
            box = box3_union(box, ball_box(&part->transform, part->base, r));
            continue;
        }
        Transform frame = standing_frame(vec3_scale(axis, 1 / length), part->base),
                  t = transform_then(&frame, &part->transform);
        box = box3_union(box, ball_box(&t, vec3(0, 0, 0), r));
        box = box3_union(box, ball_box(&t, vec3(0, 0, length), r));
        box = box3_union(box, ball_box(&t, vec3(0, 0, length / 2), hypot(r, length / 2)));
    }
    return box;
}

static Box3 sweep_box(const Solid *s) {
    double factor = s->as.sweep.curve == CURVE_CUBIC ? 2 : 1;
    Box3 box = box3_empty();
    for (size_t i = 0; i < s->as.sweep.count; i++) {
        const SweepSphere *sphere = &s->as.sweep.spheres[i];
        box = box3_union(box, widened((Box3){sphere->center, sphere->center}, factor * fabs(sphere->radius)));
    }
    return box;
}

/* Bézier curves count with their control points. */
static Box3 lathe_box(Extent *extent, const Object *o) {
    const Solid *s = o->as.solid;
    if (s->as.turned.curve != CURVE_BEZIER) return shape_trace_bounds(extent->tracer, o);
    Box3 box = box3_empty();
    for (size_t i = 0; i < s->as.turned.count; i++) {
        Point2 p = s->as.turned.points[i];
        box = box3_add_point(box3_add_point(box, vec3(p.x, p.y, p.x)), vec3(-p.x, p.y, -p.x));
    }
    return box;
}

static Box3 prism_box(Extent *extent, const Object *o) {
    const Solid *s = o->as.solid;
    if (s->as.prism.curve != CURVE_BEZIER) return shape_trace_bounds(extent->tracer, o);
    Box3 box = box3_empty();
    for (size_t i = 0; i < s->as.prism.count; i++)
        for (int k = 0; k < 2; k++) {
            double y = k ? s->as.prism.high : s->as.prism.low, scale = s->as.prism.conic ? y : 1;
            box = box3_add_point(box,
                                 vec3(s->as.prism.points[i].x * scale, y, s->as.prism.points[i].y * scale));
        }
    return box;
}

static Box3 julia_box(const Solid *s) {
    double square = 0;
    for (int i = 0; i < 4; i++) square += s->as.julia.c[i] * s->as.julia.c[i];
    return widened((Box3){{0, 0, 0}, {0, 0, 0}}, 1 + sqrt(square));
}

/* As wide as the arc would be at its middle's height, whether it reaches there or not. */
static Box3 ovus_box(const Solid *s) {
    double a = s->as.ovus.bottom, b = s->as.ovus.top, r = double_max(a, b);
    if (b >= 2 * a) return (Box3){{-b, a - b, -b}, {b, a + b, b}};
    double arc = 2 * r, to_bottom = arc - a, to_top = arc - b;
    double height = (to_bottom * to_bottom - to_top * to_top + a * a) / (2 * a);
    r = double_max(r, arc - sqrt(double_max(to_bottom * to_bottom - height * height, 0)));
    return (Box3){{-r, -a, -r}, {r, a + b, r}};
}

static Box3 field_box(Extent *extent, const Object *o) {
    Box3 box = shape_trace_bounds(extent->tracer, o);
    box.min.y -= 1e-8;
    return box;
}

/* Every text is turned a little before all else (build_rare_kinds.c), which widens its box once more. */
static Box3 text_box(Extent *extent, const Object *o, const Transform *t) {
    const Transform first = transform_rotate(vec3_splat(SOLID_TEXT_TURN)), back = transform_inverse(&first),
                    rest = transform_then(&back, t);
    Box3 box = solid_text_extent(shape_trace_data(extent->tracer, o));
    if (box3_is_empty(box)) return infinite();
    return moved(&rest, moved(&first, box));
}

static Box3 object_box(Extent *extent, const Object *o);

static Box3 solid_box(Extent *extent, const Object *o, const Transform *t) {
    const Transform identity = transform_identity();
    const Solid *s = o->as.solid;
    switch (s->kind) {
    case SOLID_POLYNOMIAL: return infinite();
    case SOLID_QUADRIC: return moved(t, quadric_box(s));
    case SOLID_POLYGON: return polygon_box(s, t);
    case SOLID_SUPERELLIPSOID: return moved(t, widened((Box3){{0, 0, 0}, {0, 0, 0}}, 1.0001));
    case SOLID_PATCH: return moved(t, points_box(s->as.patch.points, 16, &identity));
    case SOLID_BLOB: return moved(t, blob_box(s));
    case SOLID_LATHE: return moved(t, lathe_box(extent, o));
    case SOLID_PRISM: return moved(t, prism_box(extent, o));
    case SOLID_SWEEP: return moved(t, sweep_box(s));
    case SOLID_JULIA: return moved(t, julia_box(s));
    case SOLID_TEXT: return text_box(extent, o, t);
    case SOLID_OVUS: return moved(t, ovus_box(s));
    case SOLID_HEIGHT_FIELD: return moved(t, field_box(extent, o));
    case SOLID_PARAMETRIC:
        if (!s->as.parametric.container) return moved(t, widened((Box3){{0, 0, 0}, {0, 0, 0}}, 1));
        return moved(t, object_box(extent, s->as.parametric.container));
    case SOLID_SOR:
    case SOLID_ISOSURFACE: break;
    }
    return moved(t, shape_trace_bounds(extent->tracer, o));
}

/* ---- sets ---- */

/* Half a space whose border is square to an axis. */
static bool plane_cut(const Object *o, bool flipped, Box3 *out) {
    Transform place = object_transform(o);
    Vec3 n = transform_normal(&place, o->as.plane.normal);
    Vec3 p = transform_point(&place, vec3_scale(o->as.plane.normal, o->as.plane.distance));
    n = vec3_normalize(flipped != o->inverse ? vec3_negate(n) : n);
    double c[3] = {n.x, n.y, n.z}, lo[3], hi[3];
    bool square = false;
    for (int i = 0; i < 3; i++) {
        bool along = fabs(c[i]) > 1 - 1e-9;
        lo[i] = along && c[i] < 0 ? vec3_get(p, i) : -VTS_INFINITY;
        hi[i] = along && c[i] > 0 ? vec3_get(p, i) : VTS_INFINITY;
        square |= along;
    }
    *out = (Box3){{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    return square;
}

static bool is_unmoved(const Object *o) {
    Transform place = object_transform(o);
    return transform_is_identity(&place);
}

/* A child that an intersection can lean on; false: it narrows nothing. */
static bool narrowing_box(Extent *extent, const Object *child, bool flipped, Box3 *out) {
    if (child->kind == OBJECT_PLANE) return plane_cut(child, flipped, out);
    if (flipped != child->inverse) return false;
    if (child->kind == OBJECT_SOLID && child->as.solid->kind == SOLID_QUADRIC &&
        is_unmoved(child)) {
        *out = quadric_box(child->as.solid);
        return true;
    }
    *out = object_box(extent, child);
    return is_finite(*out);
}

static Box3 common_box(Extent *extent, const Object *o) {
    Box3 box = infinite();
    for (size_t i = 0; i < o->as.group->count; i++) {
        Box3 child;
        bool flipped = o->kind == OBJECT_DIFFERENCE && i > 0;
        if (narrowing_box(extent, o->as.group->items[i], flipped, &child)) box = common(box, child);
    }
    return box3_is_empty(box) || !is_finite(box) ? infinite() : box;
}

static Box3 list_box(Extent *extent, const Object *const *items, size_t count) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < count && is_finite(box3_is_empty(box) ? (Box3){{0, 0, 0}, {0, 0, 0}} : box); i++)
        box = box3_union(box, object_box(extent, items[i]));
    return box3_is_empty(box) ? infinite() : box;
}

static Box3 shape_box(Extent *extent, const Object *o, const Transform *t) {
    switch (o->kind) {
    case OBJECT_SPHERE: return sphere_box(o, t);
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return cone_box(o, t);
    case OBJECT_DISC: return disc_box(o, t);
    case OBJECT_PLANE: return infinite();
    case OBJECT_TRIANGLES: return mesh_box(o, t);
    case OBJECT_SOLID: return solid_box(extent, o, t);
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE: return moved(t, common_box(extent, o));
    case OBJECT_UNION:
    case OBJECT_MERGE:
        if (o->as.group->light_count) return infinite();
        return moved(t, list_box(extent, o->as.group->items, o->as.group->count));
    default: return moved(t, shape_bounds(o));
    }
}

/* What bounds or clips an object counts for unions, and for what has no end of its own. */
static Box3 object_box(Extent *extent, const Object *o) {
    if (extent->budget == 0 || extent->depth > DEEPEST) return infinite();
    extent->budget--;
    extent->depth++;
    Transform place = object_transform(o);
    Box3 box = shape_box(extent, o, &place);
    const ObjectList lists[] = {object_clipped_by(o), object_bounded_by(o)};
    bool yields = object_has_group(o) && o->kind != OBJECT_INTERSECTION && o->kind != OBJECT_DIFFERENCE;
    for (size_t i = 0; i < 2; i++) {
        if (!lists[i].count || (!yields && is_finite(box))) continue;
        Box3 bound = moved(&place, list_box(extent, lists[i].items, lists[i].count));
        if (is_finite(bound)) box = bound;
    }
    extent->depth--;
    return box;
}

/* Kept as the low corner and the size, in floats. */
static void round_axis(double *lo, double *hi) {
    float low = (float)*lo, size = (float)(*hi - *lo), high = low + size;
    *lo = (double)low;
    *hi = (double)high;
}

Box3 shape_extent(ShapeTracer *tracer, const Object *object) {
    Extent extent = {.tracer = tracer, .budget = 5000000};
    Box3 box = object_box(&extent, object);
    if (box3_is_empty(box) || !is_finite(box)) return (Box3){vec3_splat(-1e10), vec3_splat(1e10)};
    round_axis(&box.min.x, &box.max.x);
    round_axis(&box.min.y, &box.max.y);
    round_axis(&box.min.z, &box.max.z);
    return box;
}
