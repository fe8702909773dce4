/* Branches of L-systems as tubes. */
#ifndef VTS_SHAPE_TESSELLATE_BRANCHES_H
#define VTS_SHAPE_TESSELLATE_BRANCHES_H

#include "scene/scene.h"
#include "shape/soup.h"

/* Appends the branches of an OBJECT_BRANCHES, in its own space: closed tubes whose polygon has the circle's perimeter, mitred where they
 * bend, from each place to the next; places that `tolerance` does not need are left out. Texture coordinates: u turns about the axis, v
 * nodes along the branch. */
void tessellate_branches(const Object *object, double tolerance, Arena *arena, TriangleSoup *out);

#endif
