// Prisms: straight, with a hole, by a cubic curve, and running to a point.
#include "stage.inc"
object { Floor }
prism {
  linear_spline 0, 0.6, 10, <-0.6, -0.5>, <0.6, -0.5>, <0.6, 0.5>, <-0.6, 0.5>, <-0.6, -0.5>,
  <-0.3, -0.2>, <0.3, -0.2>, <0.3, 0.2>, <-0.3, 0.2>, <-0.3, -0.2>
  rotate -20*y translate <-1.3, 0, -0.2> pigment { Red }
}
prism {
  cubic_spline 0, 0.5, 8, <-0.5, -0.1>, <0, -0.5>, <0.5, 0>, <0.1, 0.6>, <-0.4, 0.4>, <-0.5, -0.1>, <0, -0.5>, <0.5, 0>
  translate <0.2, 0, 0> pigment { Green }
}
prism {
  conic_sweep linear_spline 0.2, 1, 4, <-0.6, -0.5>, <0.6, -0.5>, <0, 0.6>, <-0.6, -0.5>
  rotate 180*x translate <1.6, 1.2, 0> texture { Clay }
}
