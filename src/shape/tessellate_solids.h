/* Triangles of single solids and discs, in object space. */
#ifndef VTS_SHAPE_TESSELLATE_SOLIDS_H
#define VTS_SHAPE_TESSELLATE_SOLIDS_H

#include "scene/scene.h"
#include "shape/soup.h"

/* Each appends one object; `tolerance` in object space, `parts` as in TessellateOptions. Texture coordinates in [0, 1]²:
 * sphere: turns about y from -x towards z, and from the lower pole to the upper one; cylinder and cone: turns about the
 * axis, and from base to cap; torus: turns about y, and round the tube from its inside upwards; box: each face for
 * itself; discs and the ends of cylinders: the square around. */
void tessellate_sphere(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out);
void tessellate_box(const Object *object, int parts, Arena *arena, TriangleSoup *out);
void tessellate_cone(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out);
void tessellate_disc(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out);
/* As much of a plane as the box needs, as a square that reaches a little beyond it. */
void tessellate_plane(const Object *object, const Box3 *region, Arena *arena, TriangleSoup *out);
void tessellate_torus(const Object *object, double tolerance, int parts, Arena *arena, TriangleSoup *out);

/* Sides of a regular polygon that has the perimeter or the area of a circle of this radius and stays within tolerance of
 * it; odd, as
 * the width of such a polygon varies four times less over directions than that of the next even one. */
int tessellate_sides(double radius, double tolerance);
/* Its circumradius over the circle's. */
double tessellate_perimeter_factor(int sides);
/* cos and sin of i/n turns; the same for i = 0 and i = n, exact on the axes. */
void tessellate_turn(int i, int n, double *cosine, double *sine);

#endif
