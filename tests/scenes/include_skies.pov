#version 3.7;
#include "colors.inc"
#include "skies.inc"
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, -5> look_at 2*y right x*image_width/image_height angle 70 }
light_source { <6, 9, -8>, rgb 1 }
sky_sphere { S_Cloud2 }
plane { y, 0 pigment { rgb <0.35, 0.4, 0.25> } }
