/* Pigments at spots: what pattern.h's functions are made of. */
#ifndef VTS_PATTERN_PIGMENT_H
#define VTS_PATTERN_PIGMENT_H

#include "pattern/colormap.h"
#include "pattern/spot.h"
#include "scene/scene.h"

/* The spot is in the space that the pigment's transform maps to. */
Color pigment_color_at(const Pigment *pigment, const Spot *spot);

/* pigment_value() at a spot of pattern space. */
double pattern_number(const Pigment *pattern, const Spot *spot);

/* What the pattern makes of its entries. The spot is in pattern space, as spot_in_pattern() has it. */
void pattern_blend(const Pigment *pattern, const Spot *spot, BlendVisit *visit, void *target);

#endif
