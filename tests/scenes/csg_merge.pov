// Unions and merges look the same as long as nothing is transparent; a nested set.
#include "stage.inc"
object { Floor }
merge { sphere { <-0.4, 0.5, 0>, 0.5 } sphere { <0.2, 0.6, 0>, 0.5 } translate -x texture { Clay } }
difference {
  union { sphere { 0, 0.7 } box { <-0.9, -0.3, -0.3>, <0.9, 0.3, 0.3> } }
  merge { cylinder { -1.1*x, 1.1*x, 0.15 } cylinder { -y, y, 0.3 } }
  rotate -30*y translate <1.1, 0.7, 0> pigment { Green }
}
