// From a cushion to a star.
#include "stage.inc"
object { Floor }
superellipsoid { <0.3, 0.3> scale 0.55 rotate 25*y translate <-1.5, 0.6, 0> pigment { Red } }
superellipsoid { <1, 0.2> scale 0.6 rotate 90*x translate <0, 0.6, 0> pigment { Green } }
superellipsoid { <1.7, 1.7> scale 0.8 rotate 15*y translate <1.5, 0.8, 0> texture { Clay } }
