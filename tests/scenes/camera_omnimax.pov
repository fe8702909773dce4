#include "view.inc"
camera { omnimax location <0, 1, -0.5> look_at <0, 1.4, 3> right x*image_width/image_height angle 170 }
