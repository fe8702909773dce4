// Waves in the lens.
#include "view.inc"
camera { location <0, 2.2, -8> look_at <0, 0.8, 0> right x*image_width/image_height angle 50 normal { bumps 0.15 scale 0.3 } }
