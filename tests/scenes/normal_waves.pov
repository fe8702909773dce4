// ripples, waves, quilted, and bumps by a gradient.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.65, 0.55, 0.45> } finish { Soft } }
Four(
  texture { Plain normal { ripples 0.4 scale 0.4 } }, texture { Plain normal { waves 0.5 scale 0.4 } },
  texture { Plain normal { quilted 0.5 control0 0.3 control1 0.6 scale 0.5 } }, texture { Plain normal { gradient x 0.5 sine_wave scale 0.5 } })
