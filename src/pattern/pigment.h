/* Pigments at spots: what pattern.h's functions are made of. */
#ifndef VTS_PATTERN_PIGMENT_H
#define VTS_PATTERN_PIGMENT_H

#include "pattern/spot.h"
#include "scene/scene.h"

/* The spot is in the space that the pigment's transform maps to. */
Color pigment_color_at(const Pigment *pigment, const Spot *spot);

#endif
