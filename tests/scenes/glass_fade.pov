// Glass that swallows light on its way through.
#include "stage.inc"
object { Floor }
#declare Thick = material { texture { pigment { rgbf 1 } finish { diffuse 0 ambient 0 reflection 0.05 } } interior { ior 1.2 fade_distance 0.5 fade_power 1001 fade_color <0.3, 0.7, 0.4> } }
sphere { <-0.9, 0.8, 0>, 0.8 material { Thick } }
box { <0.4, 0.01, -0.4>, <1.6, 1, 0.4> rotate 10*y material { Thick } }
