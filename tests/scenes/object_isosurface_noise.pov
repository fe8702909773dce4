// Hills of POV-Ray's own noise.
#include "stage.inc"
#include "functions.inc"
isosurface {
  function { y - 0.7*f_noise3d(1.5*x, 0, 1.5*z) }
  contained_by { box { <-2.5, -0.1, -2>, <2.5, 1, 3> } } max_gradient 2.5 accuracy 0.0005
  texture { Clay }
}
