/* From a point near a surface to the exact surface. */
#ifndef VTS_SHAPE_SOLID_PROJECT_H
#define VTS_SHAPE_SOLID_PROJECT_H

#include "shape/solid.h"

/* One solid or sheet with what it prepared (NULL: nothing is found). */
typedef struct ExactSurface {
    const Object *object;
    const SolidOps *ops;
    const void *data;
} ExactSurface;

/* Looks along the line p + t·direction, |t| <= reach, for the surface nearest to p, in the object's own space; isosurfaces reach
 * beyond their containers. The normal (NULL: not wanted) is a unit vector on the side of `direction`, or zero. */
bool solid_project(const ExactSurface *surface, Vec3 p, Vec3 direction, double reach, double *t, Vec3 *normal);
/* Whether the point is in the solid; of an isosurface, whatever its container holds. */
bool solid_holds(const ExactSurface *surface, Vec3 p);

#endif
