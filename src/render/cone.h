/* Cones: a ray with a width. One cone stands for the light that one pixel (or a part of one) gathers. */
#ifndef VTS_RENDER_CONE_H
#define VTS_RENDER_CONE_H

#include "base/vec.h"

typedef struct Cone {
    Vec3 origin;
    Vec3 direction; /* unit length: t is a distance in scene units */
    double width;   /* diameter at the origin, scene units */
    double spread;  /* growth of the diameter per unit length */
} Cone;

static inline Vec3 cone_point(const Cone *cone, double t) { return vec3_madd(cone->origin, cone->direction, t); }
static inline RayWidth cone_width(const Cone *cone) { return (RayWidth){cone->width, cone->spread}; }
static inline double cone_diameter(const Cone *cone, double t) { return cone->width + cone->spread * t; }

#endif
