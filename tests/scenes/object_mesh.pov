// A wavy sheet as a mesh of smooth triangles, and a faceted one.
#include "stage.inc"
#declare Height = function(x, z) { 0.25*sin(3*x)*cos(3*z) }
#macro Point(I, K, Lift) <-1 + I/4, Height(-1 + I/4, -1 + K/4) + Lift, -1 + K/4> #end
#macro Slope(I, K)
  vnormalize(<-0.75*cos(3*(-1 + I/4))*cos(3*(-1 + K/4)), 1, 0.75*sin(3*(-1 + I/4))*sin(3*(-1 + K/4))>)
#end
object { Floor }
mesh {
  #for (I, 0, 7)
    #for (K, 0, 7)
      smooth_triangle { Point(I, K, 0), Slope(I, K), Point(I + 1, K, 0), Slope(I + 1, K), Point(I, K + 1, 0), Slope(I, K + 1) }
      smooth_triangle { Point(I + 1, K + 1, 0), Slope(I + 1, K + 1), Point(I + 1, K, 0), Slope(I + 1, K), Point(I, K + 1, 0), Slope(I, K + 1) }
    #end
  #end
  translate <-1, 0.5, 0> texture { Clay finish { phong 0.4 } }
}
mesh {
  triangle { <1, 0, 0>, <1.5, 1.2, 0.2>, <1.4, 0, -0.6> }
  triangle { <1.5, 1.2, 0.2>, <1.4, 0, -0.6>, <2, 0, 0> }
  pigment { Green }
}
