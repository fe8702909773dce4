// boxed, cylindrical, spherical, planar.
#include "four.inc"
Four(
  texture { pigment { boxed color_map { Ramp } scale 0.9 } finish { Soft } }, texture { pigment { cylindrical color_map { Ramp } rotate 20*x scale 1.1 } finish { Soft } },
  texture { pigment { spherical color_map { Ramp } translate <0.3, 0.2, -0.4> } finish { Soft } }, texture { pigment { planar color_map { Ramp } rotate 40*z } finish { Soft } })
