// Media in a mirror, and a lamp's shadow through two of them.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }

plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } finish { reflection 0.3 } }
sphere { <-0.6, 0, 0>, 0.9 hollow pigment { rgbt 1 } interior { media { scattering { 4, <0.2, 0.5, 1> } samples 30 density { spherical scale 0.9 translate -0.6*x } } } }
cylinder { <1, -1, -0.6>, <1, 1, -0.6>, 0.4 hollow pigment { rgbt 1 } interior { media { absorption <0.3, 1, 0.6> samples 8 } } }
