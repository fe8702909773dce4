// Textures by the value of a pattern: finishes change with the colours.
#include "four.inc"
#declare Dull = texture { pigment { rgb <0.6, 0.4, 0.3> } finish { ambient 0.1 diffuse 0.7 } }
#declare Shiny = texture { pigment { rgb <0.3, 0.35, 0.6> } finish { ambient 0.2 diffuse 0.5 specular 0.5 roughness 0.05 } }
Four(
  texture { gradient y texture_map { [0.2 Dull] [0.8 Shiny] } scale 1.4 translate -0.7*y }, texture { checker texture { Dull }, texture { Shiny } scale 0.62 translate 0.01 },
  texture { bozo texture_map { [0.4 Dull] [0.6 Shiny] } scale 0.6 }, texture { average texture_map { [1 Dull] [1 Shiny] } })
