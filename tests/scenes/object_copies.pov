// One object many times, turned, scaled and sheared.
#include "stage.inc"
object { Floor }
#declare Bolt = union { cylinder { 0, 0.8*y, 0.15 } cylinder { 0.8*y, y, 0.3 } texture { Clay } }
object { Bolt translate -1.8*x }
object { Bolt rotate -40*z translate <-1, 0.1, 0> }
object { Bolt scale <0.6, 1.6, 1.4> translate 0.4*x }
object { Bolt matrix <1, 0, 0, 0.5, 1, 0, 0, 0, 1, 1.2, 0, -0.5> pigment { Blue } }
