// Functions as patterns, a pigment_pattern, an average, pigments in a map.
#include "four.inc"
Four(
  texture { pigment { function { 0.5 + 0.5*sin(5*x)*cos(4*y + z) } color_map { Ramp } } finish { Soft } },
  texture { pigment { pigment_pattern { gradient y color_map { [0 rgb 0] [1 rgb 1] } scale 1.3 } color_map { Ramp } } finish { Soft } },
  texture { pigment { average pigment_map { [1 bozo color_map { Ramp } scale 0.5] [2 gradient y color_map { Ramp } scale 1.4] } } finish { Soft } },
  texture { pigment { gradient x pigment_map { [0.3 rgb <0.6, 0.4, 0.4>] [0.7 wood color_map { Ramp } scale 0.4] } scale 1.3 } finish { Soft } })
