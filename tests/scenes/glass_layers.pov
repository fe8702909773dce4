// Panes behind one another, each a colour.
#include "stage.inc"
object { Floor }
#for (I, 0, 3)
  box { <-1.6 + 0.7*I, 0, -0.6 + 0.4*I>, <-0.4 + 0.7*I, 1.4, -0.58 + 0.4*I> pigment { rgbf <0.9, 0.4 + 0.15*I, 1 - 0.25*I, 0.7> } finish { ambient 0 diffuse 0.2 } }
#end
