// Lamps that can be seen: looks_like; an object that throws no shadow.
#include "stage.inc"
object { Floor }
light_source { <-0.8, 1.2, -0.3>, rgb <0.6, 0.5, 0.3> looks_like { sphere { 0, 0.25 pigment { rgb 1 } finish { ambient 1 diffuse 0 } } } fade_distance 2 fade_power 2 }
box { <0.6, 0, -0.3>, <1.2, 1.2, 0.3> texture { Clay } no_shadow }
