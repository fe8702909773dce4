// Several media in one interior, several densities in one medium, overlapping objects, and one that is not hollow.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

sphere {
  <-0.7, 0, 0>, 1 hollow pigment { rgbt 1 }
  interior { media { emission <0, 0.2, 0.4> samples 40 density { planar } density { cylindrical scale 1.4 } } media { absorption rgb 0.4 samples 40 } }
}
sphere { <0.5, 0, 0>, 1 hollow pigment { rgbt 1 } interior { media { absorption <1, 0.3, 0.3> samples 8 } } }
sphere { <1.6, -0.5, -1>, 0.5 pigment { rgbt 1 } interior { media { absorption rgb 5 } } }
