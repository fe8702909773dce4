// A difference, a merge of two balls with a union's interior, and an object with media behind refracting glass.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

difference { box { -0.8, 0.8 } cylinder { -z, z, 0.6 } hollow pigment { rgbt 1 } interior { media { absorption <1.2, 0.5, 0.2> samples 8 } } rotate y*30 translate <-1.1, 0, 0> }
merge { sphere { <0.8, 0, 0>, 0.6 } sphere { <1.5, 0.3, 0>, 0.6 } hollow pigment { rgbt 1 } interior { media { absorption <0.2, 0.6, 1.2> samples 8 } } }
sphere { <0.4, 0.1, -1.5>, 0.4 hollow pigment { rgbt 1 } interior { ior 1.4 media { emission <0.3, 0.3, 0> samples 8 } } }
