// Types of scattering 2 to 5 with light from behind, eccentricity and extinction.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -5> look_at 0 angle 42 }
light_source { <2, 3, 8>, rgb 1 }
background { rgb <0.02, 0.02, 0.05> }
#macro Ball(X, Medium) sphere { <X, 0, 0>, 0.55 hollow pigment { rgbt 1 } interior { media { Medium samples 12 } } } #end
Ball(-1.8, scattering { 2 rgb 0.4 extinction 0.5 })
Ball(-0.6, scattering { 3 rgb 0.4 })
Ball(0.6, scattering { 4 rgb 0.4 extinction 0 })
Ball(1.8, scattering { 5 rgb 0.4 eccentricity 0.5 extinction 2 })
