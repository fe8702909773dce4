// A picture as relief, and functions.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.65, 0.55, 0.45> } finish { Soft } }
Four(
  texture { Plain normal { bump_map { function 32, 32 { 0.5 + 0.5*sin(12*x)*sin(9*y) } interpolate 2 bump_size 3 map_type 1 } } },
  texture { Plain normal { bump_map { function 32, 32 { 0.5 + 0.5*cos(9*x + 7*y) } interpolate 2 bump_size 3 } scale 1.2 translate -0.6 } },
  texture { Plain normal { function { 0.2*sin(9*x)*sin(9*y) } 1 } }, texture { Plain normal { marble 0.4 sine_wave turbulence 0.3 octaves 2 scale 0.5 } })
