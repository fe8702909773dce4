// A picture's indices choose among textures.
#include "stage.inc"
object { Floor }
box {
  0, 1
  texture {
    material_map { pgm "indices.pgm" texture { pigment { Red } } texture { pigment { Green } finish { phong 0.5 } } texture { pigment { Blue } } }
  }
  translate -0.5 scale <2.6, 1.6, 0.6> rotate <0, 20, 0> translate 0.9*y
}
