// Tilings: regular tiles of two kinds and more, bricks, bevels.
#include "four.inc"
#declare Steps = color_map { [0 rgb <0.45, 0.45, 0.6>] [0.5 rgb <0.6, 0.5, 0.45>] [1 rgb <0.5, 0.62, 0.5>] }
Four(
  texture { pigment { tiling 5 color_map { Steps } scale 0.4 rotate 90*x } finish { Soft } }, texture { pigment { tiling 21 color_map { Steps } scale 0.4 rotate 80*x } finish { Soft } },
  texture { pigment { tiling 14 color_map { Steps } scale 0.3 rotate 90*x } finish { Soft } }, texture { pigment { tiling 22 color_map { Steps } scale 0.4 rotate 80*x } finish { Soft } })
