// Types of scattering 2 to 5 with light from behind, eccentricity and extinction.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <2, 3, 8>, rgb 1 }
background { rgb <0.02, 0.02, 0.05> }
#declare Ball = sphere { 0, 0.55 hollow pigment { rgbt 1 } }
object { Ball interior { media { scattering { 2, rgb 0.4 extinction 0.5 } samples 12 } } translate -1.8*x }
object { Ball interior { media { scattering { 3, rgb 0.4 } samples 12 } } translate -0.6*x }
object { Ball interior { media { scattering { 4, rgb 0.4 extinction 0 } samples 12 } } translate 0.6*x }
object { Ball interior { media { scattering { 5, rgb 0.4 eccentricity 0.5 extinction 2 } samples 12 } } translate 1.8*x }
