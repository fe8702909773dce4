#include "view.inc"
camera { cylinder 1 location <0, 1.2, 0> look_at <0, 1, 3> right x*image_width/image_height angle 200 }
