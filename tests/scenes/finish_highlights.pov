// phong and specular, of each size, coloured by metallic.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.6, 0.35, 0.2> } }
Four(
  texture { Plain finish { phong 0.6 phong_size 12 } }, texture { Plain finish { specular 0.7 roughness 0.1 } },
  texture { Plain finish { specular 0.6 roughness 0.05 metallic } }, texture { Plain finish { phong 0.7 phong_size 5 metallic 0.5 } })
