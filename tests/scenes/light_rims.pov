// Rims of spotlights and cylinders: without a radius, with one beyond the falloff; and light that is taken away.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { orthographic location -10*z look_at 0 right 8*x up 6*y }
plane { z, 0 pigment { rgb 1 } finish { ambient 0.2 diffuse 1 } }
light_source { <-2.6, 1.5, -5> rgb 0.5 spotlight point_at <-2.6, 1.5, 0> radius 0 falloff 14 }
light_source { <0, 1.5, -5> rgb 0.5 spotlight point_at <0, 1.5, 0> radius 14 falloff 5 }
light_source { <2.6, 1.5, -5> rgb 0.5 spotlight point_at <2.6, 1.5, 0> radius 8 falloff 16 }
light_source { <2.6, 1.5, -5> rgb -0.3 spotlight point_at <2.6, 1.5, 0> radius 2 falloff 8 }
light_source { <-2.4, -1.5, -5> rgb 0.5 cylinder point_at <-2.4, -1.5, 0> radius 0 falloff 1 }
light_source { <0, -1.5, -5> rgb 0.5 cylinder point_at <0, -1.5, 0> falloff 1 }
light_source { <2.4, -1.5, -5> rgb <0.5, 0.5, -0.2> cylinder point_at <2.4, -1.5, 0> radius 2 falloff 1 }
