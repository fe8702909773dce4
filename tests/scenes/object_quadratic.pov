// Sphere, box, cylinder and cone, each turned.
#include "stage.inc"
object { Floor }
sphere { <-1.5, 0.6, 0.4>, 0.6 pigment { Red } finish { phong 0.5 phong_size 20 } }
box { <-0.4, 0, -0.4>, <0.4, 0.8, 0.4> rotate 30*y translate <-0.3, 0, -0.3> pigment { Green } }
cylinder { <0.5, 0.3, 0>, <1, 1.6, 0.6>, 0.25 pigment { Blue } }
cone { <1.7, 0, 0>, 0.5, <1.7, 1.2, 0>, 0.1 texture { Clay } }
