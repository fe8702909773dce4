// A torus cut by a box, a blob cut by a plane, a lathe cut in half.
#include "stage.inc"
object { Floor }
difference { torus { 0.7, 0.3 } box { <0, -1, -2>, <2, 1, 0> } translate <-1.2, 0.3, 0> texture { Clay } }
intersection { blob { threshold 0.5 sphere { 0, 0.9, 1 } sphere { 0.6*x, 0.8, 1 } } plane { <0, 0.3, -1>, 0.1 } translate <0.3, 0.9, 0.5> pigment { Green } }
difference { lathe { linear_spline 5, <0, 0>, <0.6, 0>, <0.3, 0.6>, <0.5, 1.2>, <0, 1.2> } box { <-1, 0.2, -1>, <1, 2, -0.1> pigment { Blue } } translate 1.5*x pigment { Red } }
