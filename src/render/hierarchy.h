/* Explicit objects under one hierarchy (Embree): triangles as they are, solids by exact intersection. */
#ifndef VTS_RENDER_HIERARCHY_H
#define VTS_RENDER_HIERARCHY_H

#include "base/diag.h"
#include "render/look.h"
#include "scene/scene.h"

typedef struct Hierarchy Hierarchy;

typedef struct SurfaceHit {
    double t;
    Vec3 normal;       /* unit, turned towards the ray's origin; of smooth triangles the interpolated one */
    Vec3 flat;         /* of the surface itself: on which side of it a place lies */
    uint32_t object;   /* number of the drawn part, for telling edges */
    const Look *look;
    const Transform *space; /* object space of the texture → scene */
} SurfaceHit;

/* `tolerance`: for what has to be tessellated. NULL after a diagnostic. */
Hierarchy *hierarchy_build(const Scene *scene, Arena *arena, DiagList *diags);
void hierarchy_destroy(Hierarchy *hierarchy);
size_t hierarchy_object_count(const Hierarchy *hierarchy);
void *hierarchy_device(const Hierarchy *hierarchy);

/* A box around everything that is drawn, empty if nothing is; false when there is something endless. */
bool hierarchy_bounds(const Hierarchy *hierarchy, Box3 *box);
/* Nearest hit with t in (t_min, t_max); unit direction. */
bool hierarchy_intersect(const Hierarchy *hierarchy, const Ray *ray, double t_min, double t_max, SurfaceHit *hit);
/* Whether anything that casts shadows lies between. */
bool hierarchy_occluded(const Hierarchy *hierarchy, const Ray *ray, double t_min, double t_max);

#endif
