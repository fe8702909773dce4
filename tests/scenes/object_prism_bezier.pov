// A drop of Bezier curves, drawn out and lying.
#include "stage.inc"
object { Floor }
prism {
  bezier_spline 0, 0.5, 8, <0, 0.8>, <0.1, 0.3>, <0.6, 0.3>, <0.6, -0.1>, <0.6, -0.1>, <0.6, -0.8>, <-0.5, -0.6>, <0, 0.8>
  rotate -70*x translate <-0.5, 0.8, 0> pigment { Blue }
}
prism { quadratic_spline 0, 1, 6, <0.4, 0.1>, <0.5, -0.4>, <-0.4, -0.4>, <-0.4, 0.4>, <0.4, 0.4>, <0.5, -0.4> translate <1.2, 0, 0> texture { Clay } }
