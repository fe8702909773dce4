// Light that walls send each other: an open room under a bright sky, a lamp in it, a ball that is not seen by walls.
#version 3.7;
global_settings {
  assumed_gamma 1
  radiosity { pretrace_start 0.05 pretrace_end 0.01 count 1200, 60000 nearest_count 10 error_bound 0.15 recursion_limit 2 low_error_factor 0.6 minimum_reuse 0.005 gray_threshold 0.1 brightness 0.9 adc_bailout 0.002 }
}
#default { finish { diffuse 0.8 } }
camera { location <0, 1.6, -4> look_at <0, 1, 0> right 4/3*x angle 55 }
background { rgb <0.55, 0.62, 0.8> }
light_source { <-1.4, 2.7, -1.5>, rgb 0.35 }
box { <-2, -0.1, -2>, <2, 0, 2> pigment { rgb 0.7 } }
box { <-2.1, 0, -2>, <-2, 3, 2> pigment { rgb <0.8, 0.3, 0.2> } }
box { <2, 0, -2>, <2.1, 3, 2> pigment { rgb <0.25, 0.6, 0.3> } }
box { <-2, 0, 2>, <2, 2, 2.1> pigment { rgb 0.75 } }
sphere { <0.7, 0.6, 0.6>, 0.6 pigment { rgb 0.8 } }
cylinder { <-0.8, 0, 0.4>, <-0.8, 1.2, 0.4>, 0.4 pigment { rgb <0.8, 0.7, 0.4> } }
