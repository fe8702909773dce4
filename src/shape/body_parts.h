/* What bodies consist of: for body_build.c and body.c alone. */
#ifndef VTS_SHAPE_BODY_PARTS_H
#define VTS_SHAPE_BODY_PARTS_H

#include "shape/body.h"
#include "shape/box_tree.h"

/* A place of a body: a child, or what clips. */
typedef struct BodyPlace {
    Transform transform;
    bool identity, singular;
    uint32_t index; /* in the list of the text */
    const Body *body;
} BodyPlace;

typedef struct BodyPlaceList {
    const BodyPlace *items;
    size_t count;
} BodyPlaceList;

/* What is prepared for a shape, in its own space. */
struct Body {
    Hash128 hash; /* object_shape_hash() */
    const Object *object;
    const SolidOps *ops;
    const void *data;
    Box3 whole;   /* of the surface, clips not regarded */
    Box3 bounds;  /* of the surface */
    Box3 reach;   /* of the inside: infinite for what is inside out */
    BodyPlaceList children, clips, guards; /* of a set; clipped_by; bounded_by */
    const BoxTree *tree; /* over the children from `tree_first` on, of large sets; or NULL */
    uint32_t tree_first;
    bool tree_holds;     /* what is inside one of these children is inside its box */
    int depth;
};

#endif
