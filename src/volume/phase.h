/* Phase functions: how scattered light is turned aside. */
#ifndef VTS_VOLUME_PHASE_H
#define VTS_VOLUME_PHASE_H

#include "scene/volumes.h"

/* Light scattered by an angle of this cosine, for each unit of solid angle: the integral over the sphere is 1. */
double phase_value(const Phase *phase, double mu);
/* The cosine of an angle, drawn from it: which[0, 1) chooses a lobe, u[0, 1) the angle. */
double phase_draw(const Phase *phase, double which, double u);

enum { PHASE_MOMENTS = 4 };
/* Means of Legendre's polynomials P0 = 1, P1 = mu, P2, P3: what the phase function leaves of spherical harmonics of these degrees. */
void phase_moments(const Phase *phase, double out[PHASE_MOMENTS]);

/* Takes a forward peak off: the phase function is about peak·(light that goes on) + (1 - peak)·rest, the same in its moments up to degree 2, and in degree 3 for what is
 * without: delta-M, Wiscombe 1977. Returns the peak's share, 0 where there is none and rest is the phase function itself. */
double phase_without_peak(const Phase *phase, Phase *rest);

/* The direction at this angle from a unit one, turned about it by turn[0, 1) of a full turn. */
Vec3 phase_turn(Vec3 direction, double mu, double turn);

#endif
