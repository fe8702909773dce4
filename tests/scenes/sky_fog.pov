// Even fog, with a little light through it from behind.
#include "stage.inc"
object { Floor }
fog { distance 8 rgbt <0.7, 0.72, 0.75, 0.1> }
#for (I, 0, 4) cylinder { <-2 + I, 0, 3*I - 2>, <-2 + I, 1.4, 3*I - 2>, 0.3 texture { Clay } } #end
