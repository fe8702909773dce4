// Half of a shell in a shell in a shell, each with its own colour where it is cut.
#include "stage.inc"
object { Floor }
difference {
  union {
    difference { sphere { 0, 1 } sphere { 0, 0.85 } pigment { Red } }
    difference { sphere { 0, 0.65 } sphere { 0, 0.5 } pigment { Green } }
    sphere { 0, 0.3 pigment { Blue } }
  }
  box { <-1.1, -0.1, -1.1>, <1.1, 1.1, 0> }
  cutaway_textures rotate -20*y translate y
}
