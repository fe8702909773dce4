// Light with media_attenuation is dimmed by the fog on its way.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -8> look_at <0, 1, 0> right x*image_width/image_height }
fog { color rgb <.2, .3, .4> distance 12 }
light_source { <4, 9, -3> color rgb 2 media_attenuation on }
plane { y, 0 hollow pigment { rgb <.8, .7, .6> } }
sphere { <-1, 1, 0>, 1 pigment { rgb <.9, .3, .2> } }
