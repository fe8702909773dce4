// The sky in a ball.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, -5> look_at 0.9*y right x*image_width/image_height angle 40 }
light_source { <6, 9, -8>, rgb 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.8, 0.6, 0.4>] [1 rgb <0.1, 0.25, 0.6>] } scale 2 translate -1 } emission 0.9 }
sphere { 0.9*y, 0.9 pigment { rgb 0.2 } finish { diffuse 0.3 reflection 0.7 } }
plane { y, -0.2 pigment { rgb 0.4 } finish { reflection 0.2 } }
