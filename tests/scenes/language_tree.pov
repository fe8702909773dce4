// A tree by recursion.
#include "stage.inc"
object { Floor }
#macro Branch(Depth)
  #if (Depth > 0)
    cone { 0, 0.08*Depth/5, y, 0.064*Depth/5 }
    union { Branch(Depth - 1) scale 0.72 rotate <25, 40, 20> translate y }
    union { Branch(Depth - 1) scale 0.68 rotate <-28, 130, -22> translate y }
  #else
    sphere { 0, 0.35 pigment { Green } }
  #end
#end
union { Branch(5) scale 0.75 texture { Clay } }
