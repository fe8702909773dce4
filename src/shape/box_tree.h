/* A tree over boxes: which of many things a ray or a point may meet. */
#ifndef VTS_SHAPE_BOX_TREE_H
#define VTS_SHAPE_BOX_TREE_H

#include "base/arena.h"
#include "base/vec.h"

typedef struct BoxTree BoxTree;

/* The tree and all it needs live in `arena`. Boxes may be infinite; empty ones are never met. count < 2³¹. */
const BoxTree *box_tree_build(const Box3 *boxes, size_t count, Arena *arena);
/* Calls visit(context, item) for each item whose box the ray meets within [t_min, *t_max], roughly from near to far.
 * The visitor may lower *t_max. Boxes count as slightly larger than they are, so that rounding loses nothing. */
void box_tree_ray(const BoxTree *tree, const Ray *ray, double t_min, const double *t_max,
                  void (*visit)(void *context, uint32_t item), void *context);
/* Calls visit(context, item) for items whose box holds the point until it returns true; whether it did. */
bool box_tree_point(const BoxTree *tree, Vec3 point, bool (*visit)(void *context, uint32_t item),
                    void *context);
/* The same for items whose box touches `box`. */
bool box_tree_touch(const BoxTree *tree, const Box3 *box, bool (*visit)(void *context, uint32_t item), void *context);
/* Calls visit(context, item) for the items whose box, and all boxes around it, meets(context, box) says yes to. */
void box_tree_descend(const BoxTree *tree, bool (*meets)(const void *context, const Box3 *box),
                      void (*visit)(void *context, uint32_t item), void *context);
/* Where the ray is in the box, within [*t_near, *t_far], which it narrows; false when nowhere. Generous by rounding errors. */
bool box_tree_clip(const Box3 *box, const Ray *ray, double *t_near, double *t_far);

#endif
