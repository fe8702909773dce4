// Spherical, toroidal and cubic mappings, a planar one.
#include "four.inc"
#declare Tiles = pigment { checker rgb <0.62, 0.55, 0.5>, rgb <0.5, 0.45, 0.57> scale <1/8, 1/5, 1> }
Four(
  texture { pigment { Tiles warp { spherical orientation y } } finish { Soft } },
  texture { pigment { Tiles warp { toroidal orientation y major_radius 0.5 } } finish { Soft } },
  texture { pigment { Tiles warp { planar y, 0.3 } } finish { Soft } },
  texture { pigment { checker rgb <0.62, 0.55, 0.5>, rgb <0.5, 0.45, 0.57> scale 0.3 warp { cubic } } finish { Soft } })
