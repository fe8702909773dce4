// A quartic (a torus by its polynomial), a cubic and a polynomial of the sixth degree, held by boxes.
#include "stage.inc"
object { Floor }
quartic {
  < 1, 0, 0, 0, 2, 0, 0, 2, 0, -2*(0.64 + 0.0625),
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    1, 0, 0, 2, 0, 2*(0.64 - 0.0625), 0, 0, 0, 0,
    1, 0, -2*(0.64 + 0.0625), 0, (0.64 - 0.0625)*(0.64 - 0.0625) >
  rotate 60*x translate <-1.2, 0.9, 0> pigment { Red }
}
intersection {
  cubic { <0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, -0.5, 0> }
  sphere { 0, 0.8 }
  translate <0.7, 0.8, 0> texture { Clay }
}
