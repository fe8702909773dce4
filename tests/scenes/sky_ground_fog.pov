// Fog that lies on the ground.
#include "stage.inc"
object { Floor }
fog { fog_type 2 distance 5 fog_offset 0.3 fog_alt 0.4 rgb <0.7, 0.72, 0.75> }
#for (I, 0, 4) cylinder { <-2 + I, 0, 3*I - 2>, <-2 + I, 1.6, 3*I - 2>, 0.3 texture { Clay } } #end
