// A round lamp that turns to what it lights.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <-2, 4, -3>, rgb 0.9 area_light 5*x, 5*y, 17, 17 circular orient }
plane { y, 0 pigment { rgb 0.6 } }
cylinder { <0.2, 0, 0>, <0.2, 1.2, 0>, 0.4 pigment { rgb <0.7, 0.4, 0.3> } }
