// Bumpy balls of a function in boxes that cut them: closed, open, and one at a threshold with `evaluate`.
#include "stage.inc"
#include "functions.inc"
#declare Bumps = function { sqrt(x*x + y*y + z*z) - 0.7 - 0.12*sin(8*x)*sin(8*y)*sin(8*z) }
object { Floor }
isosurface {
  function { Bumps(x, y, z) } contained_by { box { -0.55, 0.55 } } max_gradient 3 accuracy 0.0005 all_intersections
  rotate <20, 40, 0> scale <1.1, 0.9, 1> translate <-1.5, 0.9, 0> texture { Clay }
}
isosurface {
  function { Bumps(x, y, z) } contained_by { box { -0.6, 0.6 } } open max_gradient 3 accuracy 0.0005 all_intersections
  rotate 30*y translate <0, 0.9, 0> pigment { Red }
}
isosurface {
  function { x*x + y*y*y*y + z*z } threshold 0.4 contained_by { box { -0.8, <0.55, 0.8, 0.8> } } evaluate 1, 1.2, 0.9 accuracy 0.0005
  all_intersections rotate -20*y translate <1.5, 0.9, 0> pigment { Blue }
}
