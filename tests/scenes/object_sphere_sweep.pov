// Balls drawn along straight lines, along B-splines and cubic splines.
#include "stage.inc"
object { Floor }
sphere_sweep { linear_spline 3, <-1.8, 0.3, 0>, 0.3, <-1.3, 1.3, 0>, 0.15, <-0.8, 0.3, 0.3>, 0.25 pigment { Red } }
sphere_sweep { b_spline 6, <-0.8, 0, 0>, 0.2, <-0.5, 0.2, -0.4>, 0.2, <0.2, 1, 0>, 0.3, <0.6, 1.4, 0.4>, 0.15, <0.9, 0.4, 0>, 0.2, <1, 0, 0>, 0.2 pigment { Green } }
sphere_sweep { cubic_spline 6, <1, 0, 0>, 0.2, <1.2, 0.3, 0>, 0.2, <1.5, 0.9, 0>, 0.15, <1.9, 0.9, 0>, 0.25, <2, 0.3, -0.3>, 0.2, <2, 0, 0>, 0.2 texture { Clay } }
