// A film of oil.
#include "stage.inc"
object { Floor }
sphere { <-0.9, 0.9, 0>, 0.9 pigment { rgb 0.3 } finish { irid { 0.4 thickness 0.6 turbulence 0 } } }
sphere { <1.1, 0.8, 0>, 0.8 pigment { rgb 0.4 } finish { diffuse 0.5 specular 0.3 roughness 0.1 irid { 0.3 thickness 0.9 turbulence 0.3 } } }
