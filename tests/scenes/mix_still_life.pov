// A table with fruit: wood below, soft light.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 3, -6> look_at <0, 0.5, 0> right x*image_width/image_height angle 36 }
light_source { <4, 7, -4>, rgb <0.9, 0.85, 0.8> area_light 1.5*x, 1.5*z, 7, 7 }
light_source { <-8, 5, -6>, rgb <0.15, 0.18, 0.25> shadowless }
cylinder { <0, -0.2, 0>, <0, 0, 0>, 2.4 pigment { wood turbulence 0.08 octaves 3 color_map { [0 rgb <0.45, 0.3, 0.2>] [1 rgb <0.55, 0.38, 0.25>] } rotate 88*x scale 0.4 } }
sphere { <-0.7, 0.5, 0>, 0.5 pigment { bozo color_map { [0.2 rgb <0.75, 0.2, 0.1>] [0.8 rgb <0.8, 0.6, 0.2>] } scale 0.5 } finish { phong 0.4 } }
sphere { <0.2, 0.45, -0.5>, 0.45 pigment { rgb <0.8, 0.5, 0.1> } finish { specular 0.2 roughness 0.1 } }
lathe { cubic_spline 6, <0, -0.1>, <0.35, 0.02>, <0.5, 0.5>, <0.2, 1>, <0.28, 1.3>, <0.3, 1.4> translate <0.9, 0, 0.5> pigment { rgb <0.4, 0.45, 0.6> } }
