// A bubble and a cube of glass: thin layers colour what is mirrored, outside and where glass mirrors all.
#include "stage.inc"
object { Floor }
plane { -z, -4 pigment { gradient x triangle_wave color_map { [0 rgb 0.9] [1 rgb <0.3, 0.4, 0.6>] } scale 2 } }
sphere { <-1, 0.9, 0>, 0.9 hollow pigment { rgbt 1 } finish { irid { 0.35 thickness 0.5 } reflection 0.5 } }
box { -0.55, 0.55 rotate <0, 30, 20> translate <1.1, 0.9, 0> pigment { rgbt 1 }
  finish { irid { 0.5 thickness 0.4 } reflection { 0.1, 0.8 fresnel } conserve_energy } interior { ior 1.6 } }
