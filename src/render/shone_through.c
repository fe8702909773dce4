#include "render/shone_through.h"

#include "shape/body.h"

/* An object that a light is projected through, in the scene's space. */
typedef struct Projection {
    const Object *object;
    const Body *body; /* NULL: there is nothing that could be met */
    Transform place;
} Projection;

struct Projections {
    size_t count;
    Projection items[];
};

const Projections *projections_prepare(const Scene *scene, Arena *arena) {
    size_t most = 0;
    for (size_t i = 0; i < scene->light_count; i++) most += scene->lights[i].projected_through != NULL;
    if (most == 0) return NULL;
    Projections *out = arena_push(arena, sizeof *out + most * sizeof out->items[0]);
    ShapeTracer *shapes = shape_tracer_create(arena);
    out->count = 0;
    for (size_t i = 0; i < scene->light_count; i++) {
        const Object *object = scene->lights[i].projected_through;
        if (!object) continue;
        Projection *p = &out->items[out->count++];
        *p = (Projection){object, body_of(shapes, object), object_transform(object)};
        if (transform_is_singular(&p->place)) p->body = NULL;
    }
    return out;
}

static const Projection *find(const Projections *projections, const Object *object) {
    for (size_t i = 0; i < projections->count; i++)
        if (projections->items[i].object == object) return &projections->items[i];
    return NULL;
}

bool projections_let(const Projections *projections, const Light *light, const Ray *ray, double distance, double *opened) {
    *opened = distance;
    if (!light->projected_through || !projections) return true;
    const Projection *p = find(projections, light->projected_through);
    if (!p || !p->body || !vec3_is_finite(ray->origin)) return false;
    const Ray local = {transform_point_back(&p->place, ray->origin), transform_vector_back(&p->place, ray->direction)};
    BodyHit met;
    if (!body_meet(p->body, p->object, &local, 0, distance, &met)) return false;
    *opened = met.t;
    return true;
}
