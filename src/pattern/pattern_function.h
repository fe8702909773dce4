/* Pigments and patterns as externals of tapes: function { pigment { … } } and function { pattern { … } }. */
#ifndef VTS_PATTERN_PATTERN_FUNCTION_H
#define VTS_PATTERN_PATTERN_FUNCTION_H

#include "scene/scene.h"
#include "tape/tape.h"

/* 3 inputs, the place; 5 outputs: red, green, blue, filter, transmit. The pigment must outlive the external. */
TapeExternal pigment_external(const Pigment *pigment);
/* 3 inputs, the place; 1 output: the pattern's value (see pigment_value()). */
TapeExternal pattern_external(const Pigment *pattern);

#endif
