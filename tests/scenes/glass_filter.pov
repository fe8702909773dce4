// Filter and transmit without refraction: what is behind, and coloured shadows.
#include "stage.inc"
object { Floor }
sphere { <-1.3, 0.8, 0>, 0.7 pigment { rgbf <0.9, 0.5, 0.3, 0.8> } }
sphere { <0.3, 0.8, 0>, 0.7 pigment { rgbt <0.2, 0.5, 0.3, 0.6> } }
box { <1.2, 0, -0.5>, <2, 1.3, 0.3> pigment { rgbft <0.4, 0.5, 0.9, 0.5, 0.3> } }
