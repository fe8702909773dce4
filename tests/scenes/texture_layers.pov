// Layers: clear parts let the texture below through.
#include "four.inc"
#declare Below = texture { pigment { rgb <0.6, 0.5, 0.35> } finish { ambient 0.1 diffuse 0.6 } }
Four(
  texture { Below } texture { pigment { gradient y color_map { [0 rgbt <0.3, 0.3, 0.7, 0>] [1 rgbt <0.3, 0.3, 0.7, 1>] } scale 1.5 translate -0.75*y } },
  texture { Below } texture { pigment { checker rgbt <1, 1, 1, 1>, rgbf <0.5, 0.7, 0.5, 0.5> scale 0.62 translate 0.01 } finish { phong 0.5 } },
  texture { Below } texture { pigment { rgbf <0.8, 0.4, 0.4, 0.8> } finish { specular 0.4 roughness 0.05 } },
  texture { Below } texture { pigment { bozo color_map { [0.3 rgbt 1] [0.6 rgbt <0.2, 0.4, 0.3, 0.3>] } scale 0.5 } })
