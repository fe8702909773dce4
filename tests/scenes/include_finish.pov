#include "four.inc"
#include "finish.inc"
#declare Plain = pigment { rgb <0.6, 0.45, 0.3> }
Four(texture { pigment { Plain } finish { Dull } }, texture { pigment { Plain } finish { Shiny } }, texture { pigment { Plain } finish { Phong_Dull } }, texture { pigment { Plain } finish { Glossy } })
