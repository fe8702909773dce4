// An assumed gamma of sRGB and colours named in srgb.
#version 3.7;
global_settings { assumed_gamma srgb }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <6, 9, -8>, rgb 1 }
background { rgb <0.35, 0.45, 0.6> }
plane { y, 0 pigment { rgb 0.5 } }
sphere { <-0.8, 0.8, 0>, 0.8 pigment { bozo color_map { [0 rgb <0.7, 0.4, 0.3>] [1 rgb <0.4, 0.6, 0.8>] } scale 0.5 } }
sphere { <1, 0.6, 0>, 0.6 pigment { srgb <0.7, 0.5, 0.3> } }
