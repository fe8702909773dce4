// Mirrors: grey, coloured, metallic, by the angle.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.5, 0.4, 0.3> } }
Four(
  texture { Plain finish { diffuse 0.3 reflection 0.4 } }, texture { Plain finish { diffuse 0.4 reflection rgb <0.2, 0.3, 0.5> } },
  texture { Plain finish { diffuse 0.3 reflection { 0.5 metallic } } }, texture { Plain finish { diffuse 0.4 reflection { 0.05, 0.7 falloff 2 } } })
