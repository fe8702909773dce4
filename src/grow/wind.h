/* Wind: the force that a wind_field has at a place and a time, and what it does to the vectors that stand in it.
 *
 * With d the unit direction and s = p·d − speed·t the force is
 *     F = strength·[ d·(1 + a·(2·((1 + sin(2π·s/λ))/2)^sharpness − 1)) + a_t·fbm3((p − d·speed·t)/scale) ] + function(p, t):
 * a moving periodic function and a stochastic flow that the wind carries along (Neyret 1998, section VII). Forces have no
 * unit: one of 1 bends a vector of length 1 and stiffness 1 by 45 degrees if it blows across.
 *
 * Where a cycle T is set, gusts and turbulence have it as their period in time: speed·T is a whole number of wavelengths (wind_make_cyclic),
 * and while the flow goes by, the one that came T earlier takes over from it. */
#ifndef VTS_GROW_WIND_H
#define VTS_GROW_WIND_H

#include "scene/scene.h"

/* Sets the cycle, and rounds the speed to the nearest whole number of wavelengths in it, of gusts that move at least one. Returns that number; 0:
 * nothing was to be rounded. */
double wind_make_cyclic(WindField *wind, double cycle);

/* `time` in seconds. A function that yields no finite number adds nothing there. */
Vec3 wind_force(const WindField *wind, Vec3 p, double time);

/* The height vector h in a force: |h|·normalize(h + |h|·F/stiffness), with F/stiffness of 10⁴ at most. Its foot stays, and its length; where the force takes
 * all of h away, it is left as it is. */
Vec3 wind_bend(Vec3 h, Vec3 force, double stiffness);

/* The shortest length over which the force changes in space, scene units: what a surface's cells must be finer than to show
 * it. HUGE_VAL where it is the same everywhere, or not known (a function). */
double wind_wavelength(const WindField *wind);

/* Puts the means in place of what changes over less than `shortest` scene units: of gusts that of a wave, by and by, and the whole of it from half of that
 * length down; of octaves of turbulence 0, below three quarters of it. */
void wind_smooth(WindField *wind, double shortest);

#endif
