// A blob of balls and a bar, one of its parts taken away.
#include "stage.inc"
object { Floor }
blob {
  threshold 0.5
  sphere { <-0.8, 0.8, 0>, 1, 1 }
  sphere { <0.3, 1, 0.2>, 1, 1 }
  cylinder { <0.4, 0.6, 0>, <1.6, 1.2, 0>, 0.6, 1 }
  sphere { <0, 0.9, -0.8>, 0.7, -1 }
  texture { Clay finish { specular 0.4 roughness 0.03 } }
}
