// bozo, spotted, bumps, dents.
#include "four.inc"
Four(
  texture { pigment { bozo color_map { Ramp } scale 0.5 } finish { Soft } }, texture { pigment { spotted color_map { Ramp } scale 0.4 } finish { Soft } },
  texture { pigment { bumps color_map { Ramp } scale 0.6 } finish { Soft } }, texture { pigment { dents color_map { Ramp } scale 0.7 } finish { Soft } })
