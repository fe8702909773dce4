/* What may cast a shadow with an edge, known by boxes and planes alone: where none of it is near, light changes evenly. */
#ifndef VTS_RENDER_BLOCKERS_H
#define VTS_RENDER_BLOCKERS_H

#include "base/arena.h"
#include "render/cluster.h"

struct Medium;
typedef struct Blockers Blockers;

/* Of what the outermost cluster holds; in the arena. */
const Blockers *blockers_find(const Cluster *all, Arena *arena);

/* A convex body of light: that between a piece of a line of sight and the places that light it. */
typedef struct LightHull {
    Vec3 points[8];
    int count;
    const struct Medium *const *media; /* that the piece goes through: what they fill is told by their own pattern, and no blocker */
    int media_count;
    double fine; /* shadows so wide are not missed, unless they have an edge */
} LightHull;

/* False where nothing can block light within the hull; true where something may. */
bool blockers_touch(const Blockers *blockers, const LightHull *hull);

#endif
