// Fog that colours what it lets through.
#include "stage.inc"
object { Floor }
fog { distance 6 rgbft <0.5, 0.6, 0.8, 0.6, 0.1> }
sphere { <-1, 0.6, 0>, 0.6 pigment { rgb <0.8, 0.5, 0.4> } }
sphere { <1.5, 0.6, 4>, 0.6 pigment { rgb <0.8, 0.5, 0.4> } }
