// `uv_mapping` before a declared pigment and a declared normal.
#include "stage.inc"
object { Floor }
#declare Stripes = pigment { gradient x color_map { [0 rgb <0.8, 0.2, 0.1>] [1 rgb <0.1, 0.3, 0.7>] } }
#declare Steps = normal { gradient y 2 scale 0.25 }
sphere { 0, 0.9 pigment { uv_mapping Stripes scale 0.5 } rotate 20*y translate <-1, 0.9, 0> }
sphere { 0, 0.8 pigment { rgb 0.8 } normal { uv_mapping Steps } translate <1.1, 0.8, 0> }
