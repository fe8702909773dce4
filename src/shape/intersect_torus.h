/* A line and a torus. */
#ifndef VTS_SHAPE_INTERSECT_TORUS_H
#define VTS_SHAPE_INTERSECT_TORUS_H

#include "base/vec.h"

/* Where origin + t·direction (a unit vector; origin within a few radii of the middle) crosses the torus about y, ascending:
 * 0, 2 or 4 values. Radii positive. The lemon inside a spindle torus (minor > major) is not part of its surface. */
int intersect_torus(Vec3 origin, Vec3 direction, double major, double minor, double t[4]);

#endif
