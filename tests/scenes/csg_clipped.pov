// Cut open without a lid: one sees the inside; a bound does not show.
#include "stage.inc"
object { Floor }
sphere { <-1.1, 0.9, 0>, 0.9 clipped_by { plane { <0.3, 1, -0.3>, 0.9 } } pigment { Red } }
cone { <1, 0, 0>, 0.9, <1, 1.6, 0>, 0.3 open clipped_by { box { <0, -1, -0.4>, <2, 2, 2> } } bounded_by { sphere { <1, 0.8, 0>, 1.5 } } texture { Clay } }
