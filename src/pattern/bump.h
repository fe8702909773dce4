/* Normals of surfaces, perturbed as POV-Ray 3.7 does it. */
#ifndef VTS_PATTERN_BUMP_H
#define VTS_PATTERN_BUMP_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* A place at which a normal is perturbed: the spot in the space where the normal's transforms begin, and what lies between that
 * space and the normal block's own. */
typedef struct BumpPlace {
    const Spot *spot;
    const Transform *outer[2]; /* applied to the pattern last and last but one; NULL: none */
} BumpPlace;

/* The normal (of any length but 0) in the spot's space, perturbed; not of unit length. Bumps finer than the spot's footprint are
 * those of the smoothed pattern, so that they fade instead of aliasing. */
Vec3 bump_normal(const Normal *normal, const BumpPlace *place, Vec3 n);

/* bump_field.c: what the forms with fields of their own add to the normal `n` of pattern space; to be multiplied by the amount, but of
 * facets and pictures. */
Vec3 bump_field(const Normal *normal, const Spot *spot, Vec3 n);

#endif
