// Densities of noise with turbulence and a map of densities.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

#declare Thick = density { bozo scale 0.5 turbulence 0.3 octaves 3 color_map { [0.3 rgb 0] [0.8 rgb 2] } }
box {
  <-1.8, -0.8, -0.6>, <1.8, 0.8, 0.6> hollow pigment { rgbt 1 }
  interior { media { emission <0.05, 0.1, 0.2> absorption <0.8, 0.5, 0.3> samples 60 density { gradient x density_map { [0 Thick] [1 rgb 0.3] } scale 3.6 translate -1.8*x } } }
}
