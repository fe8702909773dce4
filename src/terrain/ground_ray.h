/* Rays against the ground between all posts. */
#ifndef VTS_TERRAIN_GROUND_RAY_H
#define VTS_TERRAIN_GROUND_RAY_H

#include "terrain/ground.h"

/* As TerrainOps.meet. Exact to rounding: the ray is cut where it may be near the ground, down to pieces within one cell. */
bool ground_meet(const Ground *ground, const Ray *ray, double t_min, double t_max, double *t);

#endif
