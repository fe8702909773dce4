// Disc with a hole, polygon with a hole, triangles.
#include "stage.inc"
object { Floor }
disc { <-1.3, 0.9, 0>, <0.3, 0.2, -1>, 0.8, 0.3 pigment { Red } }
polygon {
  10, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1>, <-0.4, -0.4>, <0.4, -0.4>, <0.4, 0.4>, <-0.4, 0.4>, <-0.4, -0.4>
  scale 0.6 rotate <20, -30, 0> translate <0.5, 0.9, 0.5> pigment { Green }
}
triangle { <1, 0.1, -1>, <2, 0.1, 0>, <1.6, 1.5, 0> pigment { Blue } }
triangle { <-2, 0.1, -1>, <-1, 0.1, -1.4>, <-1.6, 0.7, -1> texture { Clay } }
