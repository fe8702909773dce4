/* Frames and turns that hits and tessellations share, so that their texture coordinates agree. */
#ifndef VTS_SHAPE_FRAME_H
#define VTS_SHAPE_FRAME_H

#include "base/vec.h"

/* Two unit vectors with a × b = axis (a unit vector). */
static inline void shape_axis_frame(Vec3 axis, Vec3 *a, Vec3 *b) {
    vec3_frame(axis, a, b);
    if (vec3_dot(vec3_cross(*a, *b), axis) < 0) *b = vec3_negate(*b);
}

/* The angle of (x, y) in turns, in [0, 1]. */
static inline double shape_turn_of(double x, double y) {
    double turn = atan2(y, x) / (2 * VTS_PI);
    return turn < 0 ? turn + 1 : turn;
}

#endif
