// A landscape by a function, smooth, with water that cuts it.
#include "stage.inc"
height_field {
  function 40, 40 { 0.4 + 0.25*sin(9*x)*cos(8*y) + 0.1*sin(23*x + 11*y) }
  smooth water_level 0.2
  translate <-0.5, 0, -0.5> scale <4, 1.4, 4> translate 0.6*z texture { Clay }
}
plane { y, 0.3 pigment { Blue } }
