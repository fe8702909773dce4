// Surfaces of functions: a soft box, and a ball with bumps; one held by a sphere.
#include "stage.inc"
#include "functions.inc"
object { Floor }
isosurface {
  function { pow(abs(x), 4) + pow(abs(y), 4) + pow(abs(z), 4) - 0.2 }
  contained_by { box { -0.8, 0.8 } } max_gradient 4 accuracy 0.0005
  rotate 25*y translate <-1.2, 0.7, 0> pigment { Red }
}
isosurface {
  function { sqrt(x*x + y*y + z*z) - 0.7 + 0.06*sin(9*x)*sin(9*y)*sin(9*z) }
  contained_by { sphere { 0, 0.9 } } max_gradient 2 accuracy 0.0005
  translate <0.9, 0.8, 0> texture { Clay }
}
