// A box with a hole and a bitten corner; cut faces have the cutter's colour.
#include "stage.inc"
object { Floor }
difference {
  box { -0.8, 0.8 pigment { Red } }
  cylinder { -z, z, 0.45 pigment { Green } }
  sphere { <0.8, 0.8, -0.8>, 0.7 pigment { Blue } }
  rotate 25*y translate <0, 0.8, 0.2>
}
