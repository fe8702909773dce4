// A pyramid of planes, and a room that is the inverse of a box.
#include "stage.inc"
intersection {
  plane { -y, 0 } plane { <1, 0.7, 0>, 0.6 } plane { <-1, 0.7, 0>, 0.6 } plane { <0, 0.7, 1>, 0.6 } plane { <0, 0.7, -1>, 0.6 }
  rotate 30*y translate -0.6*x texture { Clay }
}
box { <-12, 0, -14>, <12, 11, 5> inverse pigment { rgb <0.5, 0.5, 0.4> } }
sphere { <1.2, 0.5, -0.4>, 0.5 pigment { Blue } }
