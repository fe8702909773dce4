/* Boxes of the parts of a set, in its space; each side may be infinite. */
#ifndef VTS_SHAPE_SET_BOUNDS_H
#define VTS_SHAPE_SET_BOUNDS_H

#include "shape/set_tree.h"

/* Holds what is inside the leaf, and what is seen of it if it is a sheet. */
Box3 set_leaf_bounds(const SetLeaf *leaf);
/* Of a group, from its children; half spaces of an intersection together may enclose a region that none of them does alone. */
Box3 set_group_bounds(const SetTree *tree, const SetNode *node);
/* Holds all that the node holds, `inverse` and clips regarded. */
Box3 set_outer_bounds(const SetTree *tree, const SetNode *node);

Box3 set_box_common(Box3 a, Box3 b);
bool set_box_is_finite(Box3 box);

#endif
