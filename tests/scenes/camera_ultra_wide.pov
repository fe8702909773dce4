#include "view.inc"
camera { ultra_wide_angle location <0, 1, 0> look_at <0.5, 0.9, 3> right x*image_width/image_height angle 150 }
