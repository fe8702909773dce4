// Quadrics that are no cones: hyperboloid, paraboloid, saddle.
#include "stage.inc"
object { Floor }
intersection {
  quadric { <1, -0.4, 1>, 0, 0, -0.15 }
  box { <-2, -0.8, -2>, <2, 0.8, 2> }
  translate <-1.4, 0.8, 0> pigment { Red }
}
intersection {
  quadric { <1, 0, 1>, 0, <0, -0.6, 0>, 0 }
  plane { y, 1.2 }
  translate 0.2*x pigment { Green }
}
intersection {
  quadric { <1, 0, -1>, 0, <0, 1, 0>, 0 }
  box { <-0.6, -0.7, -0.6>, <0.6, 0.7, 0.6> }
  translate <1.7, 0.9, 0> pigment { Blue }
}
