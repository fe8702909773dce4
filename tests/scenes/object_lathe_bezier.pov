// A goblet of Bezier curves, and a surface of revolution as POV-Ray calls it.
#include "stage.inc"
object { Floor }
lathe {
  bezier_spline 8, <0.6, 0.02>, <0.6, 0.2>, <0.1, 0.1>, <0.1, 0.5>, <0.1, 0.5>, <0.1, 0.9>, <0.7, 0.8>, <0.6, 1.5>
  translate -0.8*x texture { Clay }
}
sor { 6, <0.3, -0.2>, <0.5, 0>, <0.6, 0.4>, <0.3, 0.9>, <0.4, 1.2>, <0.5, 1.4> open translate 1*x pigment { Blue } }
