// Colours by their names.
#include "stage.inc"
#include "colors.inc"
object { Floor }
#declare Names = array[6] { rgb Coral, rgb SteelBlue, rgb DarkOliveGreen, rgb Thistle, rgb Gold, rgb Sienna }
#for (I, 0, 5) sphere { <-2 + 0.8*I, 0.35 + 0.5*mod(I, 2), 0>, 0.38 pigment { Names[I] } } #end
