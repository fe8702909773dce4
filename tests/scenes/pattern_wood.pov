// wood, with and without turbulence, leopard, onion.
#include "four.inc"
Four(
  texture { pigment { wood color_map { Ramp } scale 0.6 } finish { Soft } }, texture { pigment { wood turbulence 0.15 octaves 3 color_map { Ramp } rotate 70*x scale 0.7 } finish { Soft } },
  texture { pigment { leopard color_map { Ramp } scale 0.12 } finish { Soft } }, texture { pigment { onion color_map { Ramp } scale 0.5 } finish { Soft } })
