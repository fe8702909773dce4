// What is outside of a function: cut out of a box by `inverse`, by the other sign, and a ball that is clipped, hollow.
#include "stage.inc"
#include "functions.inc"
#declare Bumps = function { sqrt(x*x + y*y + z*z) - 0.7 - 0.12*sin(8*x)*sin(8*y)*sin(8*z) }
object { Floor }
intersection {
  box { -0.6, 0.6 }
  isosurface { function { Bumps(x, y, z) } contained_by { sphere { 0, 1.1 } } max_gradient 3 accuracy 0.0005 all_intersections inverse }
  rotate 30*y translate <-1.5, 0.9, 0> texture { Clay }
}
isosurface {
  function { -Bumps(x, y, z) } contained_by { box { -0.62, 0.62 } } max_gradient 3 accuracy 0.0005 all_intersections
  rotate 30*y translate <0, 0.9, 0> pigment { Red }
}
isosurface {
  function { Bumps(x, y, z) } contained_by { sphere { 0, 0.9 } } max_gradient 3 accuracy 0.0005 all_intersections
  clipped_by { plane { z, 0 inverse rotate 30*y } } translate <1.5, 0.9, 0> pigment { Blue }
}
