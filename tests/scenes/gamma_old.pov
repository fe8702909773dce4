// An assumed gamma of 2.2: colours are meant as codes.
#version 3.7;
global_settings { assumed_gamma 2.2 }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <6, 9, -8>, rgb 1 }
background { rgb <0.35, 0.45, 0.6> }
plane { y, 0 pigment { checker rgb 0.5, rgb 0.6 } }
sphere { <-0.8, 0.8, 0>, 0.8 pigment { gradient y color_map { [0 rgb <0.7, 0.3, 0.3>] [1 rgb <0.4, 0.6, 0.8>] } scale 1.6 } }
sphere { <1, 0.6, 0>, 0.6 pigment { srgb <0.7, 0.5, 0.3> } }
