/* Normals of the ground at the vertices of a mesh: slopes over as many posts as the triangles there are long, but never less than one to
 * each side, so that what is drawn coarser is only smoother, and the bilinear ground has no creases. */
#ifndef VTS_TERRAIN_GROUND_NORMALS_H
#define VTS_TERRAIN_GROUND_NORMALS_H

#include "terrain/ground_source.h"
#include "base/arena.h"

typedef struct GroundAxes GroundAxes;

/* Made once for many normals. Not for two threads at once. */
GroundAxes *ground_axes_create(const GroundSource *source, Arena *arena);
/* Unit and upwards; zero where there is no slope (single posts among missing ones). `step` in posts. */
Vec3 ground_normal(GroundAxes *axes, double column, double row, double step);

#endif
