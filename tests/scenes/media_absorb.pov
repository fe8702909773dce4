// Absorption: a coloured ball and its coloured shadow.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

sphere { 0, 1 hollow pigment { rgbt 1 } interior { media { absorption <0.4, 0.9, 1.6> samples 4 } } }
