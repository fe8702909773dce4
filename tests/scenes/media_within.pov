// The camera within an object with media, among others.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

sphere { <0, 0, -4>, 4 hollow pigment { rgbt 1 } interior { media { emission <0.02, 0.03, 0.06> absorption rgb 0.05 samples 8 } } }
sphere { <0.6, 0, 0>, 0.8 hollow pigment { rgbt 1 } interior { media { absorption <0.2, 0.8, 1> samples 8 } } }
box { <-1.6, -0.8, -0.6>, <-0.6, 0.4, 0.5> pigment { rgb <0.7, 0.3, 0.2> } }
