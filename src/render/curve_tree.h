/* A tree over boxes for curves that are nearly straight: which things a curve may meet, from near to far. */
#ifndef VTS_RENDER_CURVE_TREE_H
#define VTS_RENDER_CURVE_TREE_H

#include "base/arena.h"
#include "render/curve.h"

typedef struct CurveTree CurveTree;

/* Finite boxes only; they are kept as floats that hold them. `order` gets the numbers of the boxes in the order that visits
 * call places: neighbours in space are neighbours there. count < 2³¹. The tree lives in `arena`; `scratch` is
 * left with pieces that nobody needs. */
const CurveTree *curve_tree_build(const Box3 *boxes, size_t count, uint32_t *order, Arena *arena, Arena *scratch);

/* Calls visit(context, first, count), with places in `order`, for what may be nearer than `margin` to the curve at an s between s0 and
 * *s1, which the visitor may lower; ends when it returns true. The curve's coordinates must be such as floats can hold. */
void curve_tree_walk(const CurveTree *tree, const Curve *curve, double margin, double s0, const double *s1,
                     bool (*visit)(void *context, uint32_t first, uint32_t count), void *context);

#endif
