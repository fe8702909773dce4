// Sharp at one distance.
#include "view.inc"
camera { location <0, 2, -8> look_at <0, 0.8, 0> right x*image_width/image_height angle 50 aperture 1.2 focal_point <0, 0.8, -3.6> blur_samples 200 variance 0 }
