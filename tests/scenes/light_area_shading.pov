// A light with an area that shading knows as well: highlights as wide as it, and light around corners.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 3, -6> look_at <0, 0.6, 0> right x*image_width/image_height angle 45 }
light_source { <0, 2.2, -1>, rgb 0.9 area_light <4, 0, 0>, <0, 0, 2>, 9, 9 adaptive 4 area_illumination fade_distance 2 fade_power 2 }
plane { y, 0 pigment { rgb 0.7 } }
sphere { <-1, 0.7, 0>, 0.7 pigment { rgb <0.7, 0.3, 0.2> } finish { specular 0.8 roughness 0.01 } }
box { <0.4, 0, -0.5>, <1.4, 0.8, 0.5> pigment { rgb <0.3, 0.5, 0.7> } finish { phong 0.5 } }
