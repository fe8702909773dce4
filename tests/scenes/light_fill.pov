// A light without shadows makes no highlights; thin layers still have their colours in it.
#include "stage.inc"
object { Floor }
light_source { <4, 5, -5>, rgb 0.8 shadowless }
sphere { <-1, 0.9, 0>, 0.9 pigment { rgb <0.3, 0.5, 0.3> } finish { specular 0.9 phong 0.5 roughness 0.02 } }
sphere { <1.1, 0.8, 0>, 0.8 pigment { rgb 0.2 } finish { irid { 0.5 thickness 0.4 } specular 0.5 } }
