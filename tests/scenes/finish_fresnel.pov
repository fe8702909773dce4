// Reflection by Fresnel's law, conserving energy; exponents.
#include "stage.inc"
object { Floor }
sphere { <-1.2, 0.8, 0>, 0.8 pigment { rgb <0.3, 0.3, 0.4> } finish { diffuse 0.6 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }
sphere { <0.6, 0.6, -0.4>, 0.6 pigment { rgb <0.5, 0.3, 0.2> } finish { diffuse 0.5 reflection { 0.4 exponent 0.7 } } }
sphere { <1.8, 0.5, 0.4>, 0.5 pigment { Green } }
