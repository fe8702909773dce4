// Eggs.
#include "stage.inc"
object { Floor }
ovus { 0.7, 0.3 translate <-1, 0.7, 0> texture { Clay } }
ovus { 0.4, 0.55 rotate -60*z translate <1, 0.6, 0> pigment { Green } finish { phong 0.6 } }
