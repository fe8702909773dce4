// A bent sheet with sixteen control points.
#include "stage.inc"
object { Floor }
bicubic_patch {
  type 1 flatness 0 u_steps 5 v_steps 5
  <-1.5, 0.1, -1>, <-0.5, 0.9, -1.1>, <0.5, 0.1, -1.1>, <1.5, 0.7, -1>,
  <-1.5, 0.9, -0.3>, <-0.5, 1.6, -0.3>, <0.5, 0.6, -0.3>, <1.5, 0.9, -0.3>,
  <-1.5, 0.3, 0.3>, <-0.5, 1.6, 0.3>, <0.5, 2.4, 0.3>, <1.5, 0.3, 0.3>,
  <-1.5, 1, 1>, <-0.5, 1.2, 1>, <0.5, 1, 1>, <1.5, 1.6, 1>
  texture { Clay }
}
