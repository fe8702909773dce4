// Hills by a function, coloured by height and slope, under a sky.
#version 3.7;
#include "functions.inc"
global_settings { assumed_gamma 1.0 }
camera { location <0, 1.4, -4> look_at <0, 0.4, 0> right x*image_width/image_height angle 50 }
light_source { <-60, 50, -30>, rgb <1, 0.95, 0.9> }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.75, 0.8, 0.9>] [0.6 rgb <0.25, 0.4, 0.75>] } } }
height_field {
  function 60, 60 { 0.3 + 0.5*f_noise3d(4*x, 4*y, 0) }
  smooth translate <-0.5, 0, -0.5> scale <7, 1.4, 7> translate <0, -0.3, 1>
  texture { pigment { gradient y color_map { [0.2 rgb <0.3, 0.4, 0.2>] [0.7 rgb <0.5, 0.45, 0.35>] [1 rgb 0.8] } scale 1.2 translate -0.2*y } finish { ambient 0.1 diffuse 0.7 } }
}
