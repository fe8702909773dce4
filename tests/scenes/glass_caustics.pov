// Ripples of light below water; the water's lower side, which mirrors all, and the more the nearer.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 6, -15> look_at <0, 4.5, 0> right x*image_width/image_height angle 65 }
light_source { <0, 50, 0> rgb 1 }
plane { y, 0 pigment { gradient x color_map { [0 rgb <0.7, 0.4, 0.3>] [1 rgb 0.6] } scale 40 translate -20*x } finish { ambient 0.1 diffuse 0.7 } }
plane { y, 10 hollow on
  pigment { rgb <0.7, 0.7, 1> filter 0.9 }
  finish { reflection 0.5 }
  interior { ior 1.1 caustics 1 fade_distance 20 fade_power 2 }
  normal { bumps 0.3 scale 4 }
}
