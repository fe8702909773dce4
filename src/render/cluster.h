/* What is drawn together in one space: items of a union, or the triangles of a mesh; copies share it. For hierarchy.c, cluster_build.c. */
#ifndef VTS_RENDER_CLUSTER_H
#define VTS_RENDER_CLUSTER_H

#include "base/diag.h"
#include "render/look.h"
#include "shape/body.h"

#include <embree3/rtcore.h>

typedef struct Cluster Cluster;

/* One thing in a cluster: one solid, one set, a copy of another cluster, or some triangles among the cluster's own. */
typedef struct Item {
    const Object *object;        /* whose looks count */
    const Look *look;            /* its own or a flattened union's; NULL: that of the copy it is in */
    const Transform *look_place; /* of the object that has it, to the cluster; NULL: the item's */
    const Object *filled;        /* the object around it that has an interior, in the cluster; or NULL */
    const Transform *filled_place; /* of that one, to the cluster; NULL: the item's */
    const Body *body;            /* NULL for the plain solids of intersect.h and for copies */
    const Cluster *cluster;      /* what it is a copy of; or NULL */
    const Look *inside;          /* of its surface seen from within; or NULL */
    uint32_t number;             /* among all parts, from 1, in the scene's order */
    bool both_sides;             /* lights shine on both */
    bool hollow;                 /* it, or what is around it in the cluster */
    uint8_t hidden;              /* bit 1 << RayPurpose: rays that pass */
    Affine back;                 /* cluster → its own space */
    const Transform *place;      /* its own space → cluster, kept where its texture asks for it with every hit; or NULL */
} Item;

typedef struct ItemList {
    Item *items;
    size_t count, capacity;
} ItemList;

/* A triangle of an owner's mesh. */
typedef struct ClusterTriangle {
    uint32_t owner, triangle;
} ClusterTriangle;

typedef struct ClusterTriangleList {
    ClusterTriangle *items;
    size_t count, capacity;
} ClusterTriangleList;

struct Cluster {
    RTCScene scene; /* NULL where there are few items */
    const struct Embree *embree; /* whose scene that is */
    Vec3 origin;   /* Embree's floats count from here */
    Box3 bounds;   /* of what Embree knows */
    Box3 box;      /* of everything, infinite where something is endless */
    ItemList items;
    size_t loose;  /* from this one on items are tested one by one: endless ones, and giants that would cost the others their digits */
    const Box3 *few; /* boxes of the items before `loose`, slightly wider, where these are all and need no tree; or NULL */
    ItemList owners; /* of triangles; of a mesh: one, in the cluster's own space */
    ClusterTriangleList triangles; /* few ones of the owners */
    const MeshData *mesh;          /* all of a mesh instead */
    double width;  /* of the thinnest of the items (thin.h) */
    int depth;     /* clusters within each other, this one included */
    struct FilledItems {
        uint32_t *items;
        size_t count, capacity;
    } filled;      /* items that have an interior or hold what has one */
};

enum { CLUSTER_DEEPEST = 32, CLUSTER_FEW = 8 };

/* Looks by texture. */
typedef struct LookTable {
    const Look **slots;
    size_t slot_count, count;
} LookTable;

/* All clusters, the scene's last; without Embree's scenes. */
typedef struct ClusterList {
    Cluster **items;
    size_t count, capacity;
} ClusterList;

typedef struct ClusterSet {
    ClusterList clusters;
    LookTable looks;
    const Look *default_look;
    size_t part_count;
    bool blends; /* some surface may have several looks at one place */
    const ShapeTracer *shapes; /* that has prepared what rays meet */
} ClusterSet;

/* Takes all memory that Embree's callbacks will need. */
void clusters_build(const Scene *scene, Arena *arena, DiagList *diags, ClusterSet *out);
/* The look of a texture that some object has. */
const Look *look_table_find(const LookTable *table, const Texture *texture);

/* The item's box in the cluster. */
Box3 item_box(const Item *item);
/* Its own space → the cluster. */
static inline Transform item_place(const Item *item) {
    if (item->place) return *item->place;
    const Transform back = transform_of(&item->back);
    return transform_inverse(&back);
}
static inline Ray item_ray(const Item *item, const Ray *ray) {
    return (Ray){vec3_add(mat3_apply(&item->back.linear, ray->origin), item->back.offset), mat3_apply(&item->back.linear, ray->direction)};
}
/* The mesh and the triangle in it, and its corners in the cluster. */
static inline const MeshData *cluster_triangle(const Cluster *c, uint32_t number, uint32_t *triangle, const Item **owner) {
    *owner = c->mesh ? &c->owners.items[0] : &c->owners.items[c->triangles.items[number].owner];
    *triangle = c->mesh ? number : c->triangles.items[number].triangle;
    return c->mesh ? c->mesh : (*owner)->object->as.mesh;
}

#endif
