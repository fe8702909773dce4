// A function as density, in the material of an object that is placed afterwards.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

#declare Fog = material {
  texture { pigment { rgbt 1 } }
  interior { media { scattering { 1, rgb 1.2 extinction 0.7 } samples 40 density { function { max(0, 1 - x*x - z*z)*max(0, 1 - y) } } } }
}
box { -1, 1 hollow material { Fog } scale <0.9, 0.9, 1.2> translate <0.3, -0.2, 0> }
