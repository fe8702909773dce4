// A ball of glass: refraction, reflection by Fresnel's law.
#include "stage.inc"
object { Floor }
sphere { <-0.5, 0.9, 0>, 0.9 pigment { rgbf <0.95, 0.97, 1, 0.9> } finish { ambient 0 diffuse 0.1 reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }
sphere { <1.4, 0.5, 0.8>, 0.5 pigment { Red } }
