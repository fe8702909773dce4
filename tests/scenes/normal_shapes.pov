// leopard, onion, wood and crackle raise and sink the surface.
#include "four.inc"
#declare Plain = texture { pigment { rgb <0.65, 0.55, 0.45> } finish { Soft } }
Four(
  texture { Plain normal { leopard 0.4 scale 0.12 } }, texture { Plain normal { onion 0.4 sine_wave scale 0.4 } },
  texture { Plain normal { wood 0.4 sine_wave scale 0.4 } }, texture { Plain normal { spherical 0.6 translate <0.2, 0.2, -0.5> } })
