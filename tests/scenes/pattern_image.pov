// A picture made of a pigment, bilinear; a pattern from a picture.
#include "four.inc"
#declare Painted = pigment { bozo color_map { Ramp } scale 0.2 }
Four(
  texture { pigment { image_map { function 32, 32 { pigment { Painted } } interpolate 2 map_type 1 } } finish { Soft } },
  texture { pigment { image_map { function 24, 24 { pigment { Painted } } interpolate 2 } translate -0.5 scale 1.3 } finish { Soft } },
  texture { pigment { image_pattern { function 24, 24 { 0.5 + 0.5*sin(20*x*y) } interpolate 2 } color_map { Ramp } translate -0.5 scale 1.5 } finish { Soft } },
  texture { pigment { image_map { function 16, 16 { pigment { Painted } } interpolate 4 once } translate -0.5 } finish { Soft } })
