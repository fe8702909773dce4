/* The function of an isosurface, container or not. */
#ifndef VTS_SHAPE_SOLID_FIELD_H
#define VTS_SHAPE_SOLID_FIELD_H

#include "scene/scene.h"

/* Negative inside; what is not a number is infinite, outside. */
double solid_isosurface_value(const Solid *solid, Vec3 p);
/* The same for points along a row: point + i·step, i in [0, count). `in` has room for 3·count numbers, `out` for count. */
void solid_isosurface_row(const Solid *solid, Vec3 point, Vec3 step, size_t count, double *in, double *out);

#endif
