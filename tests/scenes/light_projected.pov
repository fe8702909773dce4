// Lights that shine through objects: what is between these and the lamp casts no shadow.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 5, -7> look_at <0, 0.6, 0> angle 48 right 4/3*x up y }
plane { y, 0 pigment { rgb 0.8 } finish { ambient 0.05 diffuse 0.8 } }
plane { z, 3 pigment { rgb <0.6, 0.7, 0.8> } finish { ambient 0.05 diffuse 0.8 } }
#declare Window = difference {
  box { <-0.5, -0.5, -0.02>, <0.5, 0.5, 0.02> }
  box { <-0.06, -1, -1>, <0.06, 1, 1> }
  box { <-1, -0.06, -1>, <1, 0.06, 1> }
}
light_source { <-4, 5, -4> rgb <1, 0.9, 0.7> projected_through { object { Window scale 1.5 rotate <30, 45, 0> translate <-2.2, 2.8, -2.2> } } }
light_source { <3, 6, -2> rgb 0.3 projected_through { torus { 1, 0.3 translate 2*y } scale <1, 1, 0.6> } shadowless }
light_source { <5, 4, -6> rgb <0.2, 0.3, 0.6> spotlight point_at 0 radius 12 falloff 14 projected_through { sphere { 0, 0.5 } translate <1.6, 1.3, -2> } }
sphere { <-3.2, 4, -3.2>, 0.3 pigment { rgb <0.8, 0.2, 0.2> } }
sphere { <-0.6, 0.5, -0.4>, 0.5 pigment { rgb <0.9, 0.8, 0.3> } }
cylinder { <1.5, 0, 0.5>, <1.5, 1.2, 0.5>, 0.25 pigment { rgb <0.4, 0.8, 0.4> } }
