// A coarse landscape, its facets seen.
#include "stage.inc"
object { Floor }
height_field {
  function 8, 8 { 0.5 + 0.3*sin(7*x + 2)*cos(9*y) }
  translate <-0.5, 0, -0.5> scale <3.4, 1.2, 3.4> rotate 30*y texture { Clay }
}
