// Tori: lying, standing, one through the other.
#include "stage.inc"
object { Floor }
torus { 0.8, 0.25 translate <-0.7, 0.25, 0> texture { Clay } }
torus { 0.7, 0.15 rotate 90*x rotate 20*y translate <0.5, 0.9, 0> pigment { Blue } finish { specular 0.6 roughness 0.05 } }
torus { 0.3, 0.28 translate <1.7, 0.3, -0.5> pigment { Green } }
