/* Any object of the language, prepared for rays and points: sets, copies, clips and all. What is prepared is shared by all objects of
 * the same shape and never changed again, so that any number of threads may ask. */
#ifndef VTS_SHAPE_BODY_H
#define VTS_SHAPE_BODY_H

#include "shape/solid.h"
#include "shape/soup.h"
#include "shape/trace.h"

typedef struct Body Body;

/* The nearest crossing of a ray with a body. */
typedef struct BodyHit {
    double t;             /* in lengths of the ray's direction */
    Vec3 normal;          /* unit, as POV-Ray directs it; zero where the surface has none */
    Vec3 flat;            /* of the surface itself: differs from `normal` on smooth triangles and fields */
    const Object *leaf;   /* whose surface it is */
    const void *data;     /* what its kind prepared */
    Vec3 place;           /* the point in the leaf's own space */
    SolidTag tag;
    Transform leaf_place; /* of blobs whose parts have textures: from the leaf's own space to the space of the ray; of others unset */
    const Object *looked; /* the innermost object around it that has a texture; NULL: none */
    Transform looked_place; /* from that one's space to the space of the ray */
    const Object *filled; /* the innermost that has an interior; NULL: none */
    Transform filled_place; /* from that one's space to the space of the ray; unset without media in it */
    bool hollow;          /* the leaf or something around it */
    const Body *cut;        /* of the outermost object around it with `cutaway`, where nothing on the way has a texture; or NULL */
    const Object *cut_object;
    Transform cut_place;    /* from that one's space to the space of the ray; unset without it */
} BodyHit;

/* NULL for sets within sets without end. `object` must live as long as the tracer. */
const Body *body_of(ShapeTracer *tracer, const Object *object);

/* A box around its surface, in the object's own space; empty where there is none, infinite where there is no end. */
Box3 body_bounds(const Body *body);
/* What its kind prepared; NULL for sets and where there is nothing to meet. */
const void *body_data(const Body *body);

/* The nearest crossing with t_min < t < t_max, in the object's own space (its place is the caller's to apply). `object` may be any one
 * of this shape: its looks and those within it are what the hit names. Of *hit all but `t` is left as it is when there is none. */
bool body_meet(const Body *body, const Object *object, const Ray *ray, double t_min, double t_max, BodyHit *hit);
/* Whether there is one. */
bool body_crosses(const Body *body, const Object *object, const Ray *ray, double t_min, double t_max);
/* The same for bundles of rays: surfaces may leave out what is finer. */
bool body_meet_wide(const Body *body, const Object *object, const Ray *ray, RayWidth width, double t_min, double t_max, BodyHit *hit);
bool body_crosses_wide(const Body *body, const Object *object, const Ray *ray, RayWidth width, double t_min, double t_max);
/* A texture of something that holds a place, and the space it stands in. */
typedef struct BodyTexture {
    const Texture *texture;
    Transform place; /* to the space of the body that was asked */
} BodyTexture;

/* The textures of all parts that hold a point of the body's own space, as POV-Ray's `cutaway_textures` gathers them (measured):
 * what a difference takes away does not count. At most `most`; returns how many. */
size_t body_textures(const Body *body, const Object *object, Vec3 point, BodyTexture *out, size_t most);
/* Whether the point of the object's own space is inside. */
bool body_inside(const Body *body, Vec3 point);

#endif
