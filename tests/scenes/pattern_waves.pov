// waves, ripples, gradient by a sine wave, radial.
#include "four.inc"
Four(
  texture { pigment { waves color_map { Ramp } scale 0.6 } finish { Soft } }, texture { pigment { ripples color_map { Ramp } scale 0.8 } finish { Soft } },
  texture { pigment { gradient <1, 1, 0> color_map { Ramp } sine_wave scale 0.8 } finish { Soft } }, texture { pigment { radial color_map { Ramp } frequency 3 triangle_wave rotate 20*x } finish { Soft } })
