/* Lights that shine through an object: what `projected_through` leaves of them. */
#ifndef VTS_RENDER_SHONE_THROUGH_H
#define VTS_RENDER_SHONE_THROUGH_H

#include "base/arena.h"
#include "render/lighting.h"

/* The objects that the lights of a scene are projected through, prepared. */
typedef struct Projections Projections;

/* NULL when there are none. Lives in the arena, as long as which the scene must live. */
const Projections *projections_prepare(const Scene *scene, Arena *arena);

/* Whether the light comes to the origin of the ray, which goes towards it and meets it at `distance` (VTS_INFINITY: parallel light): only where the ray meets the
 * object before that. Then *opened is where; what lies beyond casts no shadow (measured with POV-Ray). Of lights that are not projected it is true, and
 * *opened `distance`. */
bool projections_let(const Projections *projections, const Light *light, const Ray *ray, double distance, double *opened);

#endif
