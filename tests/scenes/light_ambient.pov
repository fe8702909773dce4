// No lamp at all but the ambient light, coloured.
#version 3.7;
global_settings { assumed_gamma 1.0 ambient_light rgb <1, 0.8, 0.6> }
camera { location <0, 2, -5> look_at 0.5*y right x*image_width/image_height angle 40 }
plane { y, 0 pigment { rgb 0.6 } finish { ambient 0.4 } }
sphere { <-0.6, 0.7, 0>, 0.7 pigment { gradient y color_map { [0 rgb <0.2, 0.3, 0.8>] [1 rgb 0.9] } scale 1.4 } finish { ambient 0.8 } }
sphere { <0.9, 0.5, 0>, 0.5 pigment { rgb <0.7, 0.5, 0.3> } finish { ambient rgb <0.2, 0.6, 0.9> } }
