// crackle: form, metric, solid, offset.
#include "four.inc"
Four(
  texture { pigment { crackle color_map { Ramp } scale 0.6 } finish { Soft } }, texture { pigment { crackle form <1, 0, 0> color_map { Ramp } scale 0.7 } finish { Soft } },
  texture { pigment { crackle solid color_map { Ramp } scale 0.6 } finish { Soft } }, texture { pigment { crackle metric 1 form <-1, 1, 0> offset 0.1 color_map { Ramp } scale 0.7 } finish { Soft } })
