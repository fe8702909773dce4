// Media in the air: a shaft of light past a ball, with a lamp that does not count beside it.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <2, 4, 1.5>, rgb 4 spotlight point_at <0, -1, 0> radius 14 falloff 20 }
light_source { <-5, 5, -5>, rgb 0.3 media_interaction off }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

plane { -z, -4 pigment { rgb 0.3 } }
sphere { <0.7, 1, 0.5>, 0.35 pigment { rgb <0.8, 0.4, 0.3> } }
media { scattering { 1, rgb 0.05 } intervals 4 samples 60 }
