/* Patterns' numbers at single places of pattern space, as POV-Ray 3.7 computes them; values.c averages them. */
#ifndef VTS_PATTERN_NUMBERS_H
#define VTS_PATTERN_NUMBERS_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* fractal.c: mandel, julia, magnet. */
double fractal_number(const Pigment *pigment, Vec3 p);
/* The same at several places, to the last bit, in little more time than at one. */
enum { FRACTAL_LANES = 4 };
void fractal_numbers(const Pigment *pigment, const Vec3 p[FRACTAL_LANES], double values[FRACTAL_LANES]);
/* crackle.c */
double crackle_number(const Pigment *pigment, Vec3 p);
/* The nearest of its points. */
Vec3 crackle_point(Vec3 p, double metric);
/* water.c: ripples and waves, from 0 to 1; `wave` weighs long waves more. */
double water_number(const Pigment *pigment, Vec3 p, bool waves);
/* Where the source of this number lies, on the unit sphere. */
Vec3 water_source(int i);
/* What they add to a normal; waves shorter than the spot fade. */
Vec3 water_bump(const Pigment *pigment, const Spot *spot, bool waves);
/* quilted: the Bézier curve through the two controls, of the distance from a cell's middle. */
double quilt_curve(const Pigment *pigment, double t);
/* density.c: 0 outside of the unit cube. */
double density_number(const Pigment *pigment, Vec3 p);

#endif
