// Glass in glass, an air bubble, and total reflection.
#include "stage.inc"
object { Floor }
difference {
  sphere { 0, 0.95 }
  sphere { <0, 0.1, 0>, 0.5 }
  pigment { rgbf <0.95, 0.95, 1, 0.95> } finish { ambient 0 diffuse 0.05 reflection 0.06 } interior { ior 1.4 } translate <-0.6, 0.96, 0>
}
sphere { <-0.6, 1.06, 0>, 0.3 pigment { Red } }
merge { sphere { <1.1, 0.5, 0>, 0.5 } sphere { <1.6, 0.5, 0>, 0.5 } pigment { rgbf <0.9, 1, 0.9, 0.9> } finish { ambient 0 diffuse 0.1 } interior { ior 1.1 } }
