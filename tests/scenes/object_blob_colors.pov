// Parts of a blob with textures of their own, which flow into one another.
#include "stage.inc"
object { Floor }
blob {
  threshold 0.4
  sphere { <-0.7, 0.9, 0>, 1.1, 1 pigment { Red } }
  sphere { <0.4, 0.7, 0>, 1.1, 1 pigment { Green } }
  sphere { <1.2, 1.1, 0.2>, 0.9, 1 pigment { Blue } scale <1, 1.2, 1> }
}
