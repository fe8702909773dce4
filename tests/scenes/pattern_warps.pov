// Warps: repeat with flips, a black hole, turbulence with its own numbers, a cylindrical mapping.
#include "four.inc"
Four(
  texture { pigment { gradient x color_map { Ramp } warp { repeat 0.5*x flip x } } finish { Soft } },
  texture { pigment { gradient y color_map { Ramp } warp { black_hole <0.1, 0.2, -0.6>, 0.6 strength 1.5 falloff 2 } } finish { Soft } },
  texture { pigment { gradient y color_map { Ramp } warp { turbulence <0.4, 0.2, 0.3> octaves 2 omega 0.4 lambda 2.2 } } finish { Soft } },
  texture { pigment { checker rgb <0.6, 0.55, 0.5>, rgb <0.5, 0.45, 0.55> scale <1/6, 0.3, 1> warp { cylindrical orientation z dist_exp 0 } } finish { Soft } })
