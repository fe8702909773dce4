#include "shape/solid_project.h"

#include "shape/solid_field.h"

static bool is_kind(const Object *object, SolidKind kind) {
    return object->kind == OBJECT_SOLID && object->as.solid->kind == kind;
}

bool solid_holds(const ExactSurface *surface, Vec3 p) {
    if (!surface->data || !surface->ops->inside) return false;
    if (is_kind(surface->object, SOLID_ISOSURFACE)) return solid_isosurface_value(surface->object->as.solid, p) < 0;
    return surface->ops->inside(surface->data, p);
}

/* What has no quick answer for rays is asked for its inside. */
static bool is_asked_inside(const Object *object) {
    return is_kind(object, SOLID_ISOSURFACE) || is_kind(object, SOLID_JULIA) || is_kind(object, SOLID_SUPERELLIPSOID);
}

static bool holds_at(const ExactSurface *surface, Vec3 p, Vec3 direction, double t) {
    return solid_holds(surface, vec3_madd(p, direction, t));
}

/* Steps outwards from p, doubled each time, on both sides, until the inside changes; then halves. */
static bool bisected(const ExactSurface *surface, Vec3 p, Vec3 direction, double reach, double *t) {
    bool here = holds_at(surface, p, direction, 0);
    double to = 0;
    for (double step = reach / 16; to == 0 && step <= reach; step *= 2)
        for (int side = 0; side < 2 && to == 0; side++) {
            double at = (side == 0) == here ? step : -step; /* the inside's border is first looked for outwards */
            if (holds_at(surface, p, direction, at) != here) to = at;
        }
    if (to == 0) return false;
    double lo = copysign(fabs(to) > reach / 16 ? fabs(to) / 2 : 0, to), hi = to;
    for (int i = 0; i < 26 && fabs(hi - lo) > 1e-3 * reach; i++) {
        double middle = (lo + hi) / 2;
        if (holds_at(surface, p, direction, middle) == here)
            lo = middle;
        else
            hi = middle;
    }
    *t = (lo + hi) / 2;
    return true;
}

typedef struct NearestSink {
    SolidSink base;
    double t;
    SolidTag tag;
} NearestSink;

static void take_nearest(SolidSink *base, double t, const SolidTag *tag) {
    NearestSink *sink = (NearestSink *)(void *)base;
    if (fabs(t) >= fabs(sink->t)) return;
    sink->t = t;
    sink->tag = *tag;
}

bool solid_project(const ExactSurface *surface, Vec3 p, Vec3 direction, double reach, double *t, Vec3 *normal) {
    NearestSink sink = {.base = {.t_min = -reach, .t_max = reach, .take = take_nearest}, .t = VTS_INFINITY};
    const Ray ray = {p, direction};
    if (!surface->data || !surface->ops->cross || !(vec3_length_squared(direction) > 0) || !vec3_is_finite(p)) return false;
    if (is_asked_inside(surface->object)) {
        if (!bisected(surface, p, direction, reach, t)) return false;
    } else {
        surface->ops->cross(surface->data, &ray, &sink.base);
        if (!isfinite(sink.t)) return false;
        *t = sink.t;
    }
    if (!normal) return true;
    *normal = surface->ops->normal(surface->data, vec3_madd(p, direction, *t), &sink.tag);
    if (vec3_dot(*normal, direction) < 0) *normal = vec3_negate(*normal);
    return true;
}
