// Letters, lit from the side.
#include "stage.inc"
object { Floor }
text { ttf "timrom.ttf" "Vts" 0.4, 0 scale 1.9 rotate 15*y translate <-1.7, 0.1, -0.2> texture { Clay } }
