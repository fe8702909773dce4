// Absorption in the air, which a ball that is not hollow keeps out; a lamp that air weakens.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1.5 media_attenuation on }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

plane { -z, -6 pigment { rgb 0.7 } }
sphere { <-1, 0, 0>, 1 pigment { rgbt 1 } }
sphere { <1, 0, 0>, 1 hollow pigment { rgbt 1 } interior { media { emission <0, 0.1, 0.2> } } }
media { absorption <0.06, 0.09, 0.14> }
