#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, -6> look_at <0, 2.2, 0> right x*image_width/image_height angle 80 }
light_source { <3, 8, -12>, rgb 1 }
background { rgb <0.3, 0.4, 0.5> }
rainbow {
  angle 40 width 12 distance 100 direction <0, -0.2, 1>
  color_map { [0 rgbt <0.5, 0.2, 0.8, 1>] [0.2 rgbt <0.4, 0.2, 0.9, 0.6>] [0.5 rgbt <0.2, 0.9, 0.3, 0.6>] [0.8 rgbt <0.9, 0.3, 0.1, 0.6>] [1 rgbt <0.9, 0.1, 0.1, 1>] }
}
plane { y, 0 pigment { rgb <0.3, 0.35, 0.2> } }
