// checker, brick, hexagon, square.
#include "four.inc"
Four(
  texture { pigment { checker rgb <0.6, 0.55, 0.5>, rgb <0.5, 0.45, 0.55> scale 0.45 } finish { Soft } },
  texture { pigment { brick rgb 0.65, rgb <0.6, 0.4, 0.35> brick_size <0.6, 0.3, 0.5> mortar 0.06 translate 0.1 } finish { Soft } },
  texture { pigment { hexagon rgb <0.6, 0.5, 0.5>, rgb <0.5, 0.6, 0.5>, rgb <0.5, 0.5, 0.6> scale 0.4 rotate 80*x } finish { Soft } },
  texture { pigment { square rgb <0.6, 0.5, 0.5>, rgb <0.5, 0.6, 0.5>, rgb <0.5, 0.5, 0.6>, rgb 0.55 scale 0.4 rotate 80*x } finish { Soft } })
