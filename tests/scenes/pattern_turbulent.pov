// agate, granite, marble with turbulence, wrinkles.
#include "four.inc"
Four(
  texture { pigment { agate agate_turb 0.6 color_map { Ramp } scale 1.4 } finish { Soft } }, texture { pigment { granite color_map { Ramp } scale 3 } finish { Soft } },
  texture { pigment { marble turbulence 0.6 octaves 3 color_map { Ramp } scale 0.8 } finish { Soft } }, texture { pigment { wrinkles color_map { Ramp } scale 1.2 } finish { Soft } })
