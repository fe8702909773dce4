#include "stage.inc"
#include "glass.inc"
object { Floor }
sphere { <-1.2, 0.8, 0>, 0.7 material { texture { pigment { Col_Glass_Bluish } finish { F_Glass10 } } interior { I_Glass1 } } }
sphere { <0.8, 0.8, 0>, 0.7 material { texture { T_Glass3 } interior { I_Glass } } }
