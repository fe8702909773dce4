// Single scattering in a box: lamps are dimmed on their way through it.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <5, 8, -5>, rgb 1 }
plane { y, -1.2 pigment { rgb <0.5, 0.45, 0.4> } }

box { -0.8, 0.8 hollow pigment { rgbt 1 } interior { media { scattering { 1, <0.9, 0.6, 0.4> } samples 40 } } rotate y*35 }
