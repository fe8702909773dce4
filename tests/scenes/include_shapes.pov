// Shapes of the include files.
#include "stage.inc"
#include "shapes.inc"
object { Floor }
object { Round_Box(<-0.6, 0, -0.5>, <0.6, 0.9, 0.5>, 0.2, off) rotate 20*y translate -1.4*x pigment { Red } }
object { Round_Cylinder(0, 1.2*y, 0.45, 0.2, off) pigment { Green } }
object { Round_Cone(0, 0.6, 1.1*y, 0.3, 0.15, off) translate 1.5*x texture { Clay } }
