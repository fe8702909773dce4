// Shapes of functions.inc.
#include "stage.inc"
#include "functions.inc"
object { Floor }
isosurface { function { f_rounded_box(x, y, z, 0.2, 0.6, 0.5, 0.5) } contained_by { box { -0.7, 0.7 } } max_gradient 1.5 accuracy 0.0005 rotate 30*y translate <-1.2, 0.6, 0> pigment { Red } }
isosurface { function { f_sphere(x, y, z, 0.6) + f_ridged_mf(2*x, 2*y, 2*z, 1, 2, 3, 1, 2, 1)*0.08 } contained_by { sphere { 0, 0.8 } } max_gradient 2 accuracy 0.0005 translate <0.9, 0.75, 0> texture { Clay } }
