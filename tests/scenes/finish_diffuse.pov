// ambient, emission, brilliance, albedo.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.6, 0.45, 0.3> } }
Four(
  texture { Plain finish { ambient rgb <0.1, 0.2, 0.4> diffuse 0.5 } }, texture { Plain finish { emission 0.3 ambient 0 diffuse 0.4 } },
  texture { Plain finish { brilliance 3 diffuse 0.8 ambient 0.1 } }, texture { Plain finish { diffuse albedo 0.7 specular albedo 0.3 roughness 0.1 } })
