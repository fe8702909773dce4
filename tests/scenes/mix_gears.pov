// A gear of copies in a set, and its shadow.
#include "stage.inc"
object { Floor }
difference {
  union {
    cylinder { -0.2*z, 0.2*z, 0.8 }
    #for (I, 0, 11) box { <-0.12, 0.7, -0.2>, <0.12, 1.05, 0.2> rotate 30*I*z } #end
  }
  cylinder { -z, z, 0.25 }
  #for (I, 0, 4) cylinder { <0, 0.5, -1>, <0, 0.5, 1>, 0.14 rotate 72*I*z } #end
  rotate <10, 30, 0> translate 1.1*y texture { Clay finish { specular 0.3 roughness 0.1 metallic } }
}
