// The three noises, and waves of each kind.
#include "four.inc"
Four(
  texture { pigment { bozo noise_generator 1 color_map { Ramp } scale 0.5 } finish { Soft } }, texture { pigment { bozo noise_generator 3 color_map { Ramp } scale 0.5 } finish { Soft } },
  texture { pigment { wood scallop_wave color_map { Ramp } scale 0.7 } finish { Soft } }, texture { pigment { wood cubic_wave color_map { Ramp } scale 0.7 } finish { Soft } })
