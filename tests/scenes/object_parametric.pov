// A shell by three functions of u and v.
#include "stage.inc"
object { Floor }
parametric {
  function { (1 + 0.3*cos(u))*cos(v) } function { 0.35 + 0.3*sin(u) } function { (1 + 0.3*cos(u))*sin(v) }
  <0, 0>, <2*pi, 1.5*pi>
  contained_by { box { <-1.4, -0.1, -1.4>, <1.4, 1, 1.4> } } max_gradient 2 accuracy 0.001 precompute 14 x, y, z
  rotate -50*x translate 0.8*y texture { Clay }
}
