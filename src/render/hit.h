/* What a ray has met in clusters, and all that follows from it. For hierarchy.c. */
#ifndef VTS_RENDER_HIT_H
#define VTS_RENDER_HIT_H

#include "render/cluster.h"
#include "render/hierarchy.h"

/* The nearest so far. What is said of places and normals holds in the innermost cluster. */
typedef struct Found {
    double t;
    const Item *path[CLUSTER_DEEPEST + 2]; /* copies from the outside in, and the item at last */
    int depth;
    Vec3 normal, flat;
    const Cluster *cluster; /* of triangles; NULL for solids */
    uint32_t triangle;
    double u, v;
    BodyHit body;           /* of solids */
} Found;

/* `places`: with space and uv even where the look is the same everywhere. */
void hit_finish(const ClusterSet *set, Found *found, const Ray *ray, bool places, SurfaceHit *out);

/* What SurfaceHit.object is of an item of the outermost cluster, not a set, copy or triangles. */
uint32_t hit_object_of(const Item *item);

/* Where the inside of what has an interior is looked for: a cluster, seen through copies. */
typedef struct InsideSearch {
    const Cluster *cluster;
    Vec3 point;           /* in the cluster */
    Affine to_cluster;    /* scene → the cluster */
    uint64_t path;        /* number of the copies around it */
    const Object *filled; /* the innermost of them that has an interior, its number, and scene → its space */
    uint64_t number;
    Affine to_filled;
    bool hollow;          /* one of them is */
} InsideSearch;

/* Adds to the `count` that are in `out`; returns how many there are then. */
size_t inside_gather(const InsideSearch *search, Filling *out, size_t count, size_t most);

#endif
