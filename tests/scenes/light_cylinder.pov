// A beam of light, and parallel light.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <-3, 5, -2>, rgb 0.9 cylinder point_at <-0.8, 0, 0> radius 0.7 falloff 1.3 tightness 1 }
light_source { <10, 7, -5>, rgb <0.3, 0.3, 0.4> parallel point_at 0 }
plane { y, 0 pigment { rgb 0.6 } }
box { <0.4, 0, -0.4>, <1.2, 0.9, 0.4> pigment { rgb <0.7, 0.4, 0.3> } }
