/* Pavements: the x-z plane laid with pieces of one shape, each made of a few triangles, squares or hexagons. */
#ifndef VTS_PATTERN_PAVEMENT_H
#define VTS_PATTERN_PAVEMENT_H

#include "base/vec.h"
#include "scene/scene.h"

/* POV-Ray's number: 1 at the border of a piece, falling to 0 within it over half a square's side or a third of a triangle's height. Settings
 * must be in range (pavement_count()); 0.5 where p is not finite or further than 1e12. */
double pavement_number(const PavementSettings *settings, Vec3 p);

#endif
