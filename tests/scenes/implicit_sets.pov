// Functions in sets: cut by a box, cutting a sphere, cut by another function.
#include "stage.inc"
#include "functions.inc"
#declare Bumps = function { sqrt(x*x + y*y + z*z) - 0.7 - 0.12*sin(8*x)*sin(8*y)*sin(8*z) }
#declare Ball = isosurface { function { Bumps(x, y, z) } contained_by { sphere { 0, 0.9 } } max_gradient 3 accuracy 0.0005 all_intersections }
object { Floor }
difference { object { Ball } box { <-1, 0.1, -1>, <1, 1, 0.1> } translate <-1.5, 0.9, 0> texture { Clay } }
difference { sphere { 0, 0.85 } object { Ball translate <0.3, 0.2, -0.6> } translate <0, 0.9, 0> pigment { Red } }
intersection {
  object { Ball }
  isosurface { function { abs(x) + abs(y) + abs(z) - 0.9 } contained_by { box { -1, 1 } } max_gradient 2 accuracy 0.0005 all_intersections }
  rotate 20*y translate <1.5, 0.9, 0> pigment { Green }
}
