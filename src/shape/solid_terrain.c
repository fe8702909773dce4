/* Terrains as what rays meet: the ground between all posts, whatever a view would make of it. */
#include "shape/solid.h"

/* Crossings of one ray that are told; a ray that meets more grazes a rough plain. */
enum { MOST_CROSSINGS = 256 };

static const void *prepare(const Object *object, Arena *arena) {
    (void)arena;
    return transform_is_singular(&object->as.surface->transform) ? NULL : object->as.surface;
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Surface *s = data;
    const Ray local = {transform_point_back(&s->transform, ray->origin), transform_vector_back(&s->transform, ray->direction)};
    double from = sink->t_min, t;
    for (int i = 0; i < MOST_CROSSINGS && s->terrain->ops->meet(s->terrain->ground, &local, from, sink->t_max, &t); i++) {
        solid_offer(sink, t, (SolidTag){0});
        from = fmax(t, nextafter(t, VTS_INFINITY)) + 1e-9 * (1 + fabs(t));
    }
}

static Vec3 normal(const void *data, Vec3 point, const SolidTag *tag) {
    (void)tag;
    const Surface *s = data;
    Vec3 n = s->terrain->ops->normal(s->terrain->ground, transform_point_back(&s->transform, point));
    return vec3_normalize(transform_normal(&s->transform, n));
}

static Box3 bounds(const void *data) {
    const Surface *s = data;
    return box3_is_empty(s->terrain->bounds) ? s->terrain->bounds : box3_transform(&s->transform, s->terrain->bounds);
}

const SolidOps solid_terrain_ops = {.prepare = prepare, .cross = cross, .normal = normal, .bounds = bounds};
