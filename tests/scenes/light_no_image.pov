// Seen in mirrors only, seen but not mirrored, lit but unseen.
#include "stage.inc"
object { Floor }
box { <-2.2, 0, 1>, <2.2, 2, 1.1> pigment { rgb 0.2 } finish { reflection 0.6 } }
sphere { <-1.3, 0.5, 0>, 0.5 pigment { Red } no_image }
sphere { <0, 0.5, 0>, 0.5 pigment { Green } no_reflection }
sphere { <1.3, 0.5, 0>, 0.5 pigment { Blue } double_illuminate }
