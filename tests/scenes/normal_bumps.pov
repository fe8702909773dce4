// bumps, dents, wrinkles, granite.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.65, 0.55, 0.45> } finish { Soft } }
Four(
  texture { Plain normal { bumps 0.6 scale 0.4 } }, texture { Plain normal { dents 0.8 scale 0.6 } },
  texture { Plain normal { wrinkles 0.5 scale 0.7 } }, texture { Plain normal { granite 0.2 scale 2 } })
