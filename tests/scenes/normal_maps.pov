// normal_map, slope_map, an average, facets.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.65, 0.55, 0.45> } finish { Soft } }
Four(
  texture { Plain normal { gradient y normal_map { [0.3 bumps 0.5 scale 0.3] [0.7 ripples 0.4 scale 0.4] } scale 1.4 } },
  texture { Plain normal { gradient x 0.5 slope_map { [0 <0, 1>] [0.5 <0.5, 0>] [1 <0, -1>] } scale 0.5 } },
  texture { Plain normal { average normal_map { [1 bumps 0.6 scale 0.4] [1 gradient y 0.4 sine_wave scale 0.5] } } },
  texture { Plain normal { facets size 0.3 scale 0.3 } })
