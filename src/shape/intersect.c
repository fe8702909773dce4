#include "shape/intersect.h"

#include "shape/frame.h"
#include "shape/intersect_torus.h"

/* Every solid is met in its own frame: the ray's origin moved along the ray to where it is nearest to the solid's middle,
 * lengths in units of the solid's size. What is subtracted then is of the size of the solid, not of the way to it. */
typedef struct LocalRay {
    Vec3 origin, direction;    /* relative to the middle; direction of unit length */
    double shift, unit, scale; /* t = (shift + local t)·scale */
} LocalRay;

enum { PART_WALL, PART_BASE, PART_CAP };

static const double FAR = 1e300;

/* False where the ray, or the solid's size, makes no sense. */
static bool localize(const Ray *ray, Vec3 middle, double unit, LocalRay *local) {
    Vec3 d = ray->direction;
    double largest = double_max(fabs(d.x), double_max(fabs(d.y), fabs(d.z)));
    if (!(largest > 0) || !isfinite(largest) || !(unit > 0) || !isfinite(unit)) return false;
    d = vec3(d.x / largest, d.y / largest, d.z / largest); /* not · 1/largest, which may overflow */
    double length = vec3_length(d);
    Vec3 o = vec3_sub(ray->origin, middle);
    local->origin = vec3(o.x / unit, o.y / unit, o.z / unit);
    local->direction = vec3_scale(d, 1 / length);
    local->shift = -vec3_dot(local->origin, local->direction);
    local->origin = vec3_madd(local->origin, local->direction, local->shift);
    local->unit = unit;
    local->scale = unit / length / largest;
    return vec3_is_finite(local->origin) && isfinite(local->shift);
}

static double global_t(const LocalRay *local, double t) { return (local->shift + t) * local->scale; }

static int pair(const LocalRay *local, double in, double out, int in_part, int out_part,
                ShapeCrossing crossings[4]) {
    crossings[0] = (ShapeCrossing){global_t(local, in), (uint8_t)in_part, false};
    crossings[1] = (ShapeCrossing){global_t(local, out), (uint8_t)out_part, true};
    return 2;
}

/* ---- sphere ---- */

static int cross_sphere(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    LocalRay local;
    if (!localize(ray, object->as.sphere.center, fabs(object->as.sphere.radius), &local)) return 0;
    double b = vec3_dot(local.origin, local.direction); /* what rounding left of the shift */
    double square = 1 - vec3_length_squared(vec3_madd(local.origin, local.direction, -b));
    if (!(square >= 0)) return 0;
    double half = sqrt(square);
    return pair(&local, -b - half, -b + half, 0, 0, out);
}

static void finish_sphere(const Object *object, ShapeHit *hit) {
    double radius = fabs(object->as.sphere.radius);
    Vec3 d = vec3_sub(hit->point, object->as.sphere.center);
    hit->normal = vec3_normalize(vec3(d.x / radius, d.y / radius, d.z / radius));
    hit->point = vec3_madd(object->as.sphere.center, hit->normal, radius);
}

static void place_on_sphere(ShapeHit *hit) {
    double ring = hypot(hit->normal.x, hit->normal.z);
    hit->uv =
        (TexCoord){shape_turn_of(-hit->normal.x, hit->normal.z), 0.5 + atan2(hit->normal.y, ring) / VTS_PI};
}

/* ---- box: parts are 2·axis + (high side) ---- */

typedef struct BoxSpan {
    double in, out;
    int in_part, out_part;
} BoxSpan;

static bool clip_slab(double lo, double hi, double origin, double direction, int axis, BoxSpan *span) {
    if (direction == 0) return origin >= lo && origin <= hi;
    double t0 = (lo - origin) / direction, t1 = (hi - origin) / direction;
    bool backwards = direction < 0;
    if (backwards) {
        double swap = t0;
        t0 = t1;
        t1 = swap;
    }
    if (t0 > span->in) span->in = t0, span->in_part = 2 * axis + backwards;
    if (t1 < span->out) span->out = t1, span->out_part = 2 * axis + !backwards;
    return span->in <= span->out;
}

static int cross_box(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    Vec3 lo = vec3_min(object->as.box.corner1, object->as.box.corner2);
    Vec3 hi = vec3_max(object->as.box.corner1, object->as.box.corner2);
    BoxSpan span = {-HUGE_VAL, HUGE_VAL, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        double o = vec3_get(ray->origin, axis), d = vec3_get(ray->direction, axis);
        if (!clip_slab(vec3_get(lo, axis), vec3_get(hi, axis), o, d, axis, &span)) return 0;
    }
    if (!isfinite(span.in) || !isfinite(span.out)) return 0;
    out[0] = (ShapeCrossing){span.in, (uint8_t)span.in_part, false};
    out[1] = (ShapeCrossing){span.out, (uint8_t)span.out_part, true};
    return 2;
}

static double share(double x, double lo, double hi) {
    return hi > lo ? double_clamp((x - lo) / (hi - lo), 0, 1) : 0;
}

static void finish_box(const Object *object, int part, bool place, ShapeHit *hit) {
    Vec3 lo = vec3_min(object->as.box.corner1, object->as.box.corner2);
    Vec3 hi = vec3_max(object->as.box.corner1, object->as.box.corner2);
    hit->point = vec3_min(vec3_max(hit->point, lo), hi);
    double p[3] = {hit->point.x, hit->point.y, hit->point.z}, normal[3] = {0, 0, 0};
    int axis = part / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    int columns = part & 1 ? first : second, rows = part & 1 ? second : first;
    p[axis] = vec3_get(part & 1 ? hi : lo, axis);
    normal[axis] = part & 1 ? 1 : -1;
    hit->point = vec3(p[0], p[1], p[2]);
    hit->normal = vec3(normal[0], normal[1], normal[2]);
    if (place) hit->uv = (TexCoord){share(p[columns], vec3_get(lo, columns), vec3_get(hi, columns)),
                         share(p[rows], vec3_get(lo, rows), vec3_get(hi, rows))};
}

/* ---- cylinder and cone ---- */

/* About the middle of the axis, in units of `unit`: |q| = radius + slope·z for |z| <= half. */
typedef struct ConeFrame {
    Vec3 axis, middle;
    double length, unit, half, radius, slope;
} ConeFrame;

static bool cone_frame(const Object *object, ConeFrame *frame) {
    Vec3 base = object->as.cone.base, axis = vec3_sub(object->as.cone.cap, base);
    double r0 = fabs(object->as.cone.base_radius), r1 = fabs(object->as.cone.cap_radius);
    frame->length = hypot(hypot(axis.x, axis.y), axis.z);
    frame->unit = double_max(frame->length, double_max(r0, r1));
    if (!(frame->length > 0) || !isfinite(frame->unit) || !(r0 + r1 > 0)) return false;
    frame->axis = vec3(axis.x / frame->length, axis.y / frame->length, axis.z / frame->length);
    frame->middle = vec3_lerp(base, object->as.cone.cap, 0.5);
    frame->half = frame->length / frame->unit / 2;
    frame->radius = (r0 + r1) / 2 / frame->unit;
    frame->slope = (r1 - r0) / frame->length;
    return true;
}

/* f(t) = a t² + 2 b t + c <= 0 inside the cone and its mirror image. */
typedef struct ConeQuadratic {
    double a, b, c, opening; /* opening: how the radius grows along the ray */
} ConeQuadratic;

static ConeQuadratic cone_quadratic(const ConeFrame *frame, const LocalRay *local) {
    double oz = vec3_dot(local->origin, frame->axis), dz = vec3_dot(local->direction, frame->axis);
    Vec3 oq = vec3_madd(local->origin, frame->axis, -oz), dq = vec3_madd(local->direction, frame->axis, -dz);
    double radius = frame->radius + frame->slope * oz, opening = frame->slope * dz, side = vec3_length(dq);
    double across = vec3_length(oq);
    /* Products of sums and differences: exact zeros for generators and for rays along the axis. */
    return (ConeQuadratic){(side - opening) * (side + opening), vec3_dot(oq, dq) - opening * radius,
                           (across - radius) * (across + radius), opening};
}

/* Where the line is inside the half of the cone that the solid is part of; false for nowhere. */
static bool cone_wall_span(const ConeQuadratic *q, double *in, double *out) {
    *in = -FAR, *out = FAR;
    if (q->a == 0 && q->b == 0) return q->c <= 0;
    if (q->a == 0) {
        *(q->b > 0 ? out : in) = -q->c / (2 * q->b);
        return true;
    }
    double discriminant = q->b * q->b - q->a * q->c;
    if (q->a > 0 && !(discriminant >= 0)) return false;
    /* a < 0: the line passes through both halves; a negative discriminant is rounding at the apex. */
    double root = sqrt(double_max(discriminant, 0)), sum = -(q->b + copysign(root, q->b));
    double t0 = sum / q->a, t1 = sum != 0 ? q->c / sum : t0;
    double first = double_min(t0, t1), second = double_max(t0, t1);
    if (q->a > 0)
        *in = first, *out = second;
    else if (q->opening > 0)
        *in = second;
    else
        *out = first;
    return true;
}

/* Where the line is between the two ends. */
static bool cone_slab_span(const ConeFrame *frame, const LocalRay *local, double *in, double *out,
                           bool *upwards) {
    double oz = vec3_dot(local->origin, frame->axis), dz = vec3_dot(local->direction, frame->axis);
    *in = -FAR, *out = FAR;
    *upwards = dz > 0;
    if (dz == 0) return fabs(oz) <= frame->half;
    double t0 = (-frame->half - oz) / dz, t1 = (frame->half - oz) / dz;
    *in = double_min(t0, t1);
    *out = double_max(t0, t1);
    return true;
}

static int cross_cone(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    ConeFrame frame;
    LocalRay local;
    double wall_in, wall_out, slab_in, slab_out;
    bool upwards;
    if (!cone_frame(object, &frame) || !localize(ray, frame.middle, frame.unit, &local)) return 0;
    ConeQuadratic quadratic = cone_quadratic(&frame, &local);
    if (!cone_wall_span(&quadratic, &wall_in, &wall_out)) return 0;
    if (!cone_slab_span(&frame, &local, &slab_in, &slab_out, &upwards)) return 0;
    double in = double_max(wall_in, slab_in), leave = double_min(wall_out, slab_out);
    if (!(in <= leave) || in <= -FAR || leave >= FAR) return 0;
    int in_part = wall_in >= slab_in ? PART_WALL : upwards ? PART_BASE : PART_CAP;
    int out_part = wall_out <= slab_out ? PART_WALL : upwards ? PART_CAP : PART_BASE;
    int count = pair(&local, in, leave, in_part, out_part, out);
    if (!object->as.cone.open) return count;
    /* Of an open one only the wall is there, seen from both sides. */
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (out[i].part != PART_WALL) continue;
        out[kept] = out[i];
        out[kept++].leaving = false;
    }
    return kept;
}

static void finish_cone(const Object *object, int part, bool place, ShapeHit *hit) {
    ConeFrame frame;
    Vec3 side = {0, 0, 0}, other = {0, 0, 0};
    if (!cone_frame(object, &frame)) return;
    if (place) shape_axis_frame(frame.axis, &side, &other);
    Vec3 from_middle = vec3_sub(hit->point, frame.middle);
    double z = vec3_dot(from_middle, frame.axis), half = frame.length / 2;
    Vec3 q = vec3_madd(from_middle, frame.axis, -z);
    q = vec3_madd(q, frame.axis, -vec3_dot(q, frame.axis));
    double r0 = fabs(object->as.cone.base_radius), r1 = fabs(object->as.cone.cap_radius),
           across = vec3_length(q);
    if (part != PART_WALL) {
        double sign = part == PART_CAP ? 1 : -1, radius = part == PART_CAP ? r1 : r0;
        Vec3 center = part == PART_CAP ? object->as.cone.cap : object->as.cone.base;
        hit->normal = vec3_scale(frame.axis, sign);
        hit->point = vec3_madd(center, q, across > radius ? radius / across : 1);
        hit->uv = (TexCoord){0.5 + 0.5 * (radius > 0 ? vec3_dot(q, side) / radius : 0),
                             0.5 + 0.5 * (radius > 0 ? vec3_dot(q, other) / radius : 0)};
        return;
    }
    z = double_clamp(z, -half, half);
    double along = z / frame.length + 0.5, radius = r0 + (r1 - r0) * along;
    Vec3 radial = across > 0 ? vec3_scale(q, 1 / across)
                             : vec3_splat(0); /* zero: the apex, which looks along the axis */
    hit->normal = vec3_normalize(vec3_madd(radial, frame.axis, -frame.slope));
    hit->point = vec3_madd(vec3_madd(frame.middle, frame.axis, z), radial, radius);
    if (place) hit->uv = (TexCoord){shape_turn_of(vec3_dot(q, side), vec3_dot(q, other)), along};
}

/* ---- plane and disc ---- */

/* t of the plane p · normal = distance through `on`; false for a ray along it. */
static bool meet_plane(const Ray *ray, Vec3 on, Vec3 normal, double *t) {
    double approach = vec3_dot(ray->direction, normal);
    *t = vec3_dot(vec3_sub(on, ray->origin), normal) / approach;
    return approach != 0 && isfinite(*t);
}

static int cross_plane(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    double t;
    Vec3 normal = object->as.plane.normal;
    if (!meet_plane(ray, vec3_scale(normal, object->as.plane.distance), normal, &t)) return 0;
    out[0] = (ShapeCrossing){t, 0, vec3_dot(ray->direction, normal) > 0};
    return 1;
}

static void finish_plane(const Object *object, bool place, ShapeHit *hit) {
    Vec3 side, other, normal = object->as.plane.normal;
    hit->point = vec3_madd(hit->point, normal, object->as.plane.distance - vec3_dot(hit->point, normal));
    hit->normal = normal;
    if (!place) return;
    shape_axis_frame(normal, &side, &other);
    hit->uv = (TexCoord){vec3_dot(hit->point, side), vec3_dot(hit->point, other)};
}

static int cross_disc(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    double t;
    Vec3 normal = vec3_normalize(object->as.disc.normal);
    if (!meet_plane(ray, object->as.disc.center, normal, &t)) return 0;
    Vec3 q = vec3_sub(vec3_madd(ray->origin, ray->direction, t), object->as.disc.center);
    double across = vec3_length(vec3_madd(q, normal, -vec3_dot(q, normal)));
    if (across > fabs(object->as.disc.radius) || across < fabs(object->as.disc.hole_radius)) return 0;
    out[0] = (ShapeCrossing){t, 0, false};
    return 1;
}

static void finish_disc(const Object *object, bool place, ShapeHit *hit) {
    Vec3 side, other, normal = vec3_normalize(object->as.disc.normal);
    Vec3 q = vec3_sub(hit->point, object->as.disc.center);
    q = vec3_madd(q, normal, -vec3_dot(q, normal));
    hit->point = vec3_add(object->as.disc.center, q);
    hit->normal = normal;
    if (!place) return;
    shape_axis_frame(normal, &side, &other);
    double radius = fabs(object->as.disc.radius);
    hit->uv = radius > 0 ? (TexCoord){0.5 + 0.5 * vec3_dot(q, side) / radius,
                                      0.5 + 0.5 * vec3_dot(q, other) / radius}
                         : (TexCoord){0.5, 0.5};
}

/* ---- torus ---- */

static int cross_torus(const Object *object, const Ray *ray, ShapeCrossing out[4]) {
    double major = fabs(object->as.torus.major_radius), minor = fabs(object->as.torus.minor_radius), t[4];
    LocalRay local;
    if (!(minor > 0) || !localize(ray, vec3_splat(0), major + minor, &local)) return 0;
    int count = intersect_torus(local.origin, local.direction, major / local.unit, minor / local.unit, t);
    for (int i = 0; i < count; i++) out[i] = (ShapeCrossing){global_t(&local, t[i]), 0, i % 2 == 1};
    return count;
}

static void finish_torus(const Object *object, bool place, ShapeHit *hit) {
    double major = fabs(object->as.torus.major_radius), minor = fabs(object->as.torus.minor_radius);
    Vec3 p = hit->point;
    double ring = hypot(p.x, p.z), c = ring > 0 ? p.x / ring : 1, s = ring > 0 ? p.z / ring : 0;
    double out = ring - major, length = hypot(out, p.y);
    double nr = length > 0 ? out / length : 1, ny = length > 0 ? p.y / length : 0;
    hit->normal = vec3(c * nr, ny, s * nr);
    hit->point = vec3(c * (major + minor * nr), minor * ny, s * (major + minor * nr));
    if (place) hit->uv = (TexCoord){shape_turn_of(-c, s), shape_turn_of(-nr, ny)};
}

/* ---- all ---- */

int shape_crossings(const Object *object, const Ray *ray, ShapeCrossing out[SHAPE_MOST_CROSSINGS]) {
    switch (object->kind) {
    case OBJECT_SPHERE: return cross_sphere(object, ray, out);
    case OBJECT_BOX: return cross_box(object, ray, out);
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return cross_cone(object, ray, out);
    case OBJECT_PLANE: return cross_plane(object, ray, out);
    case OBJECT_DISC: return cross_disc(object, ray, out);
    case OBJECT_TORUS: return cross_torus(object, ray, out);
    case OBJECT_TRIANGLES:
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
    case OBJECT_PARTICLES:
    case OBJECT_BRANCHES:
    case OBJECT_SURFACE:
    case OBJECT_TEXEL:
    case OBJECT_VOLUME:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
    return 0;
}

/* All that follows from point and part; `place`: also u and v, which cost more than the rest. */
static void finish(const Object *object, bool place, ShapeHit *hit) {
    switch (object->kind) {
    case OBJECT_SPHERE:
        finish_sphere(object, hit);
        if (place) place_on_sphere(hit);
        break;
    case OBJECT_BOX: finish_box(object, hit->part, place, hit); break;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: finish_cone(object, hit->part, place, hit); break;
    case OBJECT_PLANE: finish_plane(object, place, hit); break;
    case OBJECT_DISC: finish_disc(object, place, hit); break;
    case OBJECT_TORUS: finish_torus(object, place, hit); break;
    default: break;
    }
}

static ShapeHit crossing_hit(const Ray *ray, const ShapeCrossing *crossing) {
    return (ShapeHit){.t = crossing->t,
                      .point = vec3_madd(ray->origin, ray->direction, crossing->t),
                      .leaving = crossing->leaving,
                      .part = crossing->part};
}

ShapeHit shape_hit_at(const Object *object, const Ray *ray, const ShapeCrossing *crossing) {
    ShapeHit hit = crossing_hit(ray, crossing);
    finish(object, true, &hit);
    return hit;
}

Vec3 shape_normal_at(const Object *object, Vec3 point, uint8_t part) {
    ShapeHit hit = {.point = point, .part = part};
    finish(object, false, &hit);
    return hit.normal;
}

bool shape_meet(const Object *object, const Ray *ray, double t_min, double t_max, ShapeHit *hit) {
    ShapeCrossing crossings[SHAPE_MOST_CROSSINGS];
    int count = shape_crossings(object, ray, crossings);
    for (int i = 0; i < count; i++) {
        if (!(crossings[i].t > t_min && crossings[i].t < t_max)) continue;
        *hit = crossing_hit(ray, &crossings[i]);
        finish(object, false, hit);
        return true;
    }
    return false;
}

bool shape_crosses(const Object *object, const Ray *ray, double t_min, double t_max) {
    ShapeCrossing crossings[SHAPE_MOST_CROSSINGS];
    int count = shape_crossings(object, ray, crossings);
    for (int i = 0; i < count; i++)
        if (crossings[i].t > t_min && crossings[i].t < t_max) return true;
    return false;
}

bool shape_intersect(const Object *object, const Ray *ray, double t_min, double t_max, ShapeHit *hit) {
    if (!shape_meet(object, ray, t_min, t_max, hit)) return false;
    hit->point = vec3_madd(ray->origin, ray->direction, hit->t); /* where finish() begins */
    finish(object, true, hit);
    return true;
}
