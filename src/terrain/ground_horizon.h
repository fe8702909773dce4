/* What of the ground is hidden behind nearer ground from an eye over it.
 *
 * The ground is a graph over the plane y = 0: a line of sight that passes below a place of the ground has met it before. So each direction
 * has a horizon, the steepest line to the ground so far, which only rises with the distance. */
#ifndef VTS_TERRAIN_GROUND_HORIZON_H
#define VTS_TERRAIN_GROUND_HORIZON_H

#include "terrain/ground.h"

typedef struct GroundHorizon GroundHorizon;

/* For an eye in the ground's frame; NULL where there is no ground below it. Of a direction nothing is known till it is asked for; `arena`
 * must live as long as questions are asked. Not for two threads at once. */
GroundHorizon *ground_horizon_create(const Ground *ground, Vec3 eye, Arena *arena);

/* Whether nothing of an upright cylinder, of the radius `reach` about `centre` and not above y = `top`, is seen from the eye, nor would be if
 * the ground were lower by `slack` times the distance. Never true of what is seen, true of nearly all that is hidden by far; beyond holes
 * and the map's border nothing is. */
bool ground_horizon_hides(GroundHorizon *horizon, Vec3 centre, double reach, double top, double slack);

#endif
