// slope and gradient together, a density of spheres by `object`, layers of a pattern by frequency and phase.
#include "four.inc"
Four(
  texture { pigment { slope { <0.3, 1, 0>, 0, 1 } color_map { Ramp } } finish { Soft } },
  texture { pigment { slope { y, 0.3, 0.9 } color_map { Ramp } } finish { Soft } },
  texture { pigment { object { sphere { <-0.3, 0.2, -0.6>, 0.5 } rgb <0.5, 0.5, 0.65>, rgb <0.65, 0.5, 0.5> } } finish { Soft } },
  texture { pigment { gradient y color_map { Ramp } frequency 2 phase 0.3 poly_wave 2 } finish { Soft } })
