/* The solids that intersect.h knows. */
#include "shape/intersect.h"
#include "shape/solid.h"

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    ShapeCrossing crossings[SHAPE_MOST_CROSSINGS];
    int count = shape_crossings(data, ray, crossings);
    for (int i = 0; i < count; i++) solid_offer(sink, crossings[i].t, (SolidTag){crossings[i].part, 0, 0});
}

static Vec3 normal(const void *data, Vec3 point, const SolidTag *tag) {
    return shape_normal_at(data, point, (uint8_t)tag->part);
}

/* A disc divides space as its plane does, and an open cylinder holds what a closed one would. On a sphere is not in it: POV-Ray. */
static bool inside(const void *data, Vec3 point) {
    const Object *object = data;
    if (object->kind == OBJECT_DISC)
        return vec3_dot(vec3_sub(point, object->as.disc.center), object->as.disc.normal) <= 0;
    if (object->kind == OBJECT_SPHERE)
        return vec3_length(vec3_sub(point, object->as.sphere.center)) < fabs(object->as.sphere.radius);
    bool open = (object->kind == OBJECT_CYLINDER || object->kind == OBJECT_CONE) && object->as.cone.open;
    if (!open) return shape_inside(object, point) != object->inverse;
    Object closed = object_copy(object);
    closed.as.cone.open = false;
    return shape_inside(&closed, point) != object->inverse;
}

static Box3 bounds(const void *data) { return shape_bounds(data); }

static TexCoord sphere_uv(const void *data, Vec3 point, const SolidTag *tag) {
    const Object *object = data;
    (void)tag;
    Vec3 p = vec3_sub(point, object->as.sphere.center);
    return (TexCoord){solid_turn(p.x, p.z), 0.5 + atan2(p.y, hypot(p.x, p.z)) / VTS_PI};
}

static TexCoord torus_uv(const void *data, Vec3 p, const SolidTag *tag) {
    const Object *object = data;
    (void)tag;
    double turn = 0.5 - solid_turn(p.x, p.z), out = hypot(p.x, p.z) - fabs(object->as.torus.major_radius);
    return (TexCoord){turn < 0 ? turn + 1 : turn, 0.5 + atan2(p.y, out) / (2 * VTS_PI)};
}

static double share(double x, double lo, double hi) { return hi > lo ? double_clamp((x - lo) / (hi - lo), 0, 1) : 0; }

/* A cross of six faces: four in a row at half height, from -x over +z and +x to -z, below and above the second the others. */
static TexCoord box_uv(const void *data, Vec3 p, const SolidTag *tag) {
    const Object *object = data;
    Vec3 lo = vec3_min(object->as.box.corner1, object->as.box.corner2), hi = vec3_max(object->as.box.corner1, object->as.box.corner2);
    double x = share(p.x, lo.x, hi.x), y = share(p.y, lo.y, hi.y), z = share(p.z, lo.z, hi.z);
    switch (tag->part) {
    case 0: return (TexCoord){z / 4, (1 + y) / 3};
    case 1: return (TexCoord){(3 - z) / 4, (1 + y) / 3};
    case 2: return (TexCoord){(1 + x) / 4, z / 3};
    case 3: return (TexCoord){(1 + x) / 4, (3 - z) / 3};
    case 4: return (TexCoord){(4 - x) / 4, (1 + y) / 3};
    default: return (TexCoord){(1 + x) / 4, (1 + y) / 3};
    }
}

#define PLAIN .cross = cross, .normal = normal, .inside = inside, .bounds = bounds
const SolidOps solid_plain_ops = {PLAIN};
const SolidOps solid_sphere_ops = {PLAIN, .uv = sphere_uv};
const SolidOps solid_box_ops = {PLAIN, .uv = box_uv};
const SolidOps solid_torus_ops = {PLAIN, .uv = torus_uv};
