// Spots: soft rims, tightness; one that throws a round shadow.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2.4, -6> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }
light_source { <-3, 4, -3>, rgb 0.9 spotlight point_at <-0.9, 0, 0> radius 12 falloff 24 tightness 1 }
light_source { <3, 4, -3>, rgb <0.8, 0.8, 0.4> spotlight point_at <1, 0, 0> radius 5 falloff 20 tightness 5 }
plane { y, 0 pigment { rgb 0.6 } }
sphere { <-0.5, 0.5, 0>, 0.5 pigment { rgb <0.7, 0.4, 0.3> } }
