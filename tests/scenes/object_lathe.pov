// Curves turned about y: linear, quadratic and cubic.
#include "stage.inc"
object { Floor }
lathe { linear_spline 5, <0, 0>, <0.5, 0>, <0.3, 0.6>, <0.6, 1>, <0.5, 1.2> translate <-1.5, 0, 0> pigment { Red } }
lathe { quadratic_spline 6, <0.2, -0.3>, <0.4, 0>, <0.6, 0.5>, <0.2, 0.9>, <0.3, 1.2>, <0.1, 1.4> pigment { Green } }
lathe { cubic_spline 6, <0, -0.2>, <0.4, 0.05>, <0.6, 0.5>, <0.25, 0.9>, <0.35, 1.2>, <0.3, 1.4> translate <1.5, 0, 0> texture { Clay } }
