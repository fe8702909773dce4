// Balls set down where rays meet a surface.
#include "stage.inc"
#declare Hill = sphere { <0, -1.2, 0>, 2.4 texture { Clay } }
object { Floor }
object { Hill }
#for (I, -2, 2)
  #declare Normal = <0, 0, 0>;
  #declare Foot = trace(Hill, <0.75*I, 5, -0.4>, -y, Normal);
  cone { Foot, 0.2, Foot + 0.5*Normal, 0 pigment { Blue } }
#end
