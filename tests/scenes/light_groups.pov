// Lights that shine on their group alone.
#include "stage.inc"
object { Floor }
light_group {
  light_source { <-5, 3, -4>, rgb <0.2, 0.6, 0.9> }
  sphere { <-0.9, 0.8, 0>, 0.8 pigment { rgb 0.7 } }
  global_lights off
}
light_group {
  light_source { <-5, 3, -4>, rgb <0.5, 0.2, 0.1> }
  sphere { <1, 0.7, 0>, 0.7 pigment { rgb 0.7 } }
  global_lights on
}
