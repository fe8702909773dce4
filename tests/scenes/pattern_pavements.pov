// Pavements.
#include "four.inc"
#declare Steps = color_map { [0 rgb <0.45, 0.45, 0.6>] [0.5 rgb <0.6, 0.5, 0.45>] [1 rgb <0.5, 0.62, 0.5>] }
Four(
  texture { pigment { pavement number_of_sides 3 number_of_tiles 4 pattern 2 color_map { Steps } scale 0.4 rotate 90*x } finish { Soft } },
  texture { pigment { pavement number_of_sides 4 number_of_tiles 5 pattern 7 interior 2 exterior 1 color_map { Steps } scale 0.3 rotate 80*x } finish { Soft } },
  texture { pigment { pavement number_of_sides 6 number_of_tiles 2 pattern 1 color_map { Steps } scale 0.5 rotate 90*x } finish { Soft } },
  texture { pigment { pavement number_of_sides 4 number_of_tiles 3 pattern 2 color_map { Steps } scale 0.35 rotate 80*x } finish { Soft } })
