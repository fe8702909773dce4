// Glass that is no ball: a box, a torus, a set.
#include "stage.inc"
object { Floor }
#declare Pane = material { texture { pigment { rgbf <0.85, 0.95, 0.9, 0.9> } finish { ambient 0 diffuse 0.1 reflection 0.1 } } interior { ior 1.3 } }
box { -0.5, 0.5 rotate 30*y material { Pane } translate <-1.4, 0.51, 0> }
torus { 0.45, 0.2 rotate -60*x material { Pane } translate <0.1, 0.7, -0.3> }
difference { sphere { 0, 0.7 } sphere { 0.4*y, 0.6 } material { Pane } translate <1.5, 0.71, 0> }
