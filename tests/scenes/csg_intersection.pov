// Lenses and a rounded cube.
#include "stage.inc"
object { Floor }
intersection { sphere { -0.5*x, 0.9 } sphere { 0.5*x, 0.9 } rotate 40*y translate <-1.2, 0.8, 0> pigment { Red } }
intersection { box { -0.6, 0.6 } sphere { 0, 0.8 } cylinder { -y, y, 0.7 inverse } rotate 20*y translate <1, 0.6, 0> texture { Clay } }
