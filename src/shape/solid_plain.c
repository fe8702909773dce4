/* The solids that intersect.h knows. */
#include "shape/intersect.h"
#include "shape/solid.h"

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    ShapeCrossing crossings[SHAPE_MOST_CROSSINGS];
    int count = shape_crossings(data, ray, crossings);
    for (int i = 0; i < count; i++) solid_offer(sink, crossings[i].t, (SolidTag){crossings[i].part, 0, 0});
}

static Vec3 normal(const void *data, Vec3 point, const SolidTag *tag) {
    const Ray here = {point, vec3_splat(0)};
    const ShapeCrossing crossing = {0, (uint8_t)tag->part, false};
    return shape_hit_at(data, &here, &crossing).normal;
}

/* A disc divides space as its plane does, and an open cylinder holds what a closed one would. On a sphere is not in it: POV-Ray. */
static bool inside(const void *data, Vec3 point) {
    Object object = object_copy(data);
    if (object.kind == OBJECT_DISC)
        return vec3_dot(vec3_sub(point, object.as.disc.center), object.as.disc.normal) <= 0;
    if (object.kind == OBJECT_SPHERE)
        return vec3_length(vec3_sub(point, object.as.sphere.center)) < fabs(object.as.sphere.radius);
    if (object.kind == OBJECT_CYLINDER || object.kind == OBJECT_CONE) object.as.cone.open = false;
    return shape_inside(&object, point) != object.inverse;
}

static Box3 bounds(const void *data) { return shape_bounds(data); }

const SolidOps solid_plain_ops = {.cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
