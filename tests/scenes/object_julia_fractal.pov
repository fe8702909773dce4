// A quaternion fractal.
#include "stage.inc"
object { Floor }
julia_fractal {
  <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 6 precision 50
  scale 0.9 rotate 30*y translate 1.1*y texture { Clay }
}
