// Colours taken from a pigment, and heights from a function.
#include "stage.inc"
#include "functions.inc"
object { Floor }
#declare Paint = pigment { bozo color_map { [0 rgb <0.7, 0.3, 0.2>] [1 rgb <0.2, 0.4, 0.7>] } scale 0.8 }
#declare Paint_Of = function { pigment { Paint } }
#for (I, 0, 6)
  #for (K, 0, 4)
    #declare C = Paint_Of(I/2, 0, K/2);
    box { 0, <0.4, 0.2 + 0.8*C.red, 0.4> translate <-1.6 + 0.5*I, 0, -1 + 0.5*K> pigment { rgb C } }
  #end
#end
