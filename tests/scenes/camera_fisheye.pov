#include "view.inc"
camera { fisheye location <0, 1, -0.5> look_at <0, 0.9, 3> right x*image_width/image_height angle 190 }
