// Mirrors that see each other, to a depth of five.
#include "stage.inc"
global_settings { max_trace_level 5 }
object { Floor }
sphere { <-0.9, 0.8, 0>, 0.8 pigment { rgb 0.1 } finish { ambient 0.05 diffuse 0.3 reflection 0.6 } }
sphere { <0.9, 0.8, 0>, 0.8 pigment { rgb <0.1, 0.1, 0> } finish { ambient 0.05 diffuse 0.3 reflection rgb <0.7, 0.6, 0.4> } }
box { <-2, 0, 1.2>, <2, 1.8, 1.3> pigment { rgb 0.3 } finish { reflection 0.3 } }
