// spiral1, spiral2, quilted, triangular.
#include "four.inc"
Four(
  texture { pigment { spiral1 3 color_map { Ramp } scale 0.7 } finish { Soft } }, texture { pigment { spiral2 2 color_map { Ramp } scale 0.9 } finish { Soft } },
  texture { pigment { quilted control0 1 control1 0.4 color_map { Ramp } scale 0.7 } finish { Soft } },
  texture { pigment { triangular rgb <0.6, 0.5, 0.5>, rgb <0.5, 0.6, 0.5>, rgb <0.5, 0.5, 0.6>, rgb 0.5, rgb 0.55, rgb 0.6 scale 0.6 rotate 80*x } finish { Soft } })
