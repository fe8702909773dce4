// Heights of 16 bits from Fractint's pairs of bytes; and what takes the default texture has it where it lies in the scene.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 1.6, -1.9> look_at <0.5, 0.15, 0.3> angle 42 right 4/3*x up y }
light_source { <-3, 4, -2> rgb 1 }
#default { texture { pigment { gradient x triangle_wave color_map { [0 rgb <0.6, 0.5, 0.35>] [1 rgb <0.35, 0.42, 0.5>] } scale 0.8 rotate 30*y } finish { ambient 0.2 diffuse 0.8 } } }
height_field { pot "ridge.pot" scale <1, 0.3, 0.8> }
height_field { pot "ridge.pot" smooth scale <0.6, 0.2, 0.5> rotate -50*y translate <1.1, 0, -0.6> }
union { box { 0, 0.3 } sphere { <0.6, 0.15, 0>, 0.15 } rotate 40*y translate <-0.4, 0, -0.2> }
plane { y, 0 rotate 5*y }
