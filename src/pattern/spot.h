/* The place where a pattern is wanted and how far that place extends. */
#ifndef VTS_PATTERN_SPOT_H
#define VTS_PATTERN_SPOT_H

#include "base/vec.h"

/* What patterns know of a surface besides the place. */
typedef struct SpotSurface {
    Vec3 direction;       /* of the ray, unit, of the scene; zero: unknown */
    double uv[2];
    double uv_axes[2][2]; /* the footprint's two axes <du, dv>, full widths */
} SpotSurface;

/* The footprint is spanned by up to three axes of full width, and blurred by `blur` more in all directions. */
typedef struct Spot {
    Vec3 p;
    Vec3 axes[3];
    double blur;
    Vec3 normal; /* untransformed, as `outer`: the slope pattern's */
    Vec3 outer;  /* the place before all transforms */
    const SpotSurface *surface; /* or NULL */
} Spot;

/* A disc across the normal, or a ball when that is zero. */
Spot spot_make(Vec3 point, Vec3 normal, double footprint);
/* The spot in the plane of u and v; at the origin where those are unknown. */
Spot spot_in_uv(const Spot *spot);
/* The same spot seen from the space that `t` maps from. */
Spot spot_back(const Spot *spot, const Transform *t);
static inline bool spot_is_point(const Spot *s) {
    return s->blur == 0 && vec3_length_squared(s->axes[0]) + vec3_length_squared(s->axes[1]) +
                                   vec3_length_squared(s->axes[2]) ==
                               0;
}
/* How much the linear function g · p varies over the spot. */
double spot_width(const Spot *spot, Vec3 g);
/* The same for a coordinate. */
double spot_width_along(const Spot *spot, int axis);
/* One number for how large the spot is. */
double spot_size(const Spot *spot);

#endif
