// Lamps that fade with the distance, each a colour.
#include "stage.inc"
object { Floor }
light_source { <-1.5, 1.6, -0.5>, rgb <1, 0.4, 0.2> fade_distance 1 fade_power 2 }
light_source { <1.5, 1, -0.8>, rgb <0.2, 0.5, 1> fade_distance 0.7 fade_power 1 shadowless }
sphere { <0, 0.6, 0.3>, 0.6 texture { Clay } }
