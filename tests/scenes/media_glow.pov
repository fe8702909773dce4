// Emission with a map of colours, in an object that is scaled and turned; the medium moves with it.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

sphere {
  0, 1 hollow pigment { rgbt 1 }
  interior { media { emission <0.5, 0.4, 0.3> samples 60 density { spherical color_map { [0 rgb 0] [0.5 rgb <1, 0.2, 0>] [1 rgb 2] } } } }
  scale <1.8, 0.8, 1> rotate z*25
}
