// Soft shadows of a square lamp.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <3, 5, -3>, rgb 0.9 area_light 5*x, 5*z, 17, 17 }
plane { y, 0 pigment { rgb 0.6 } }
sphere { <-0.4, 0.8, 0>, 0.6 pigment { rgb <0.7, 0.4, 0.3> } }
box { <0.9, 0, -0.3>, <1.4, 1.2, 0.3> pigment { rgb <0.3, 0.5, 0.6> } }
