// Numbers of a palette: textures, heights, bumps, and what single entries let through.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 4, -6> look_at <0, 0.3, 0> right x*image_width/image_height angle 40 }
light_source { <-5, 9, -6> rgb 0.9 }
#declare Square = box { <0, 0, -0.05>, <1, 1, 0> translate <-0.5, -0.5, 0> };
#macro Put(X, Y) rotate 40*x scale 1.2 translate <X, Y, 0> #end
plane { y, -1.5 pigment { rgb <0.3, 0.5, 0.7> } }
box { <0, 0, -0.05>, <1, 1, 0>
  texture { material_map { png "palette.png"
    texture { pigment { rgb <0.9, 0.8, 0.2> } } texture { pigment { rgb <0.8, 0.2, 0.2> } finish { ambient 0.3 } } texture { pigment { rgb <0.2, 0.8, 0.2> } }
    texture { pigment { rgb <0.2, 0.2, 0.8> } } texture { pigment { rgb 0.5 } } } }
  translate <-0.5, -0.5, 0> Put(-1.5, 0.7) }
box { <0, 0, -0.05>, <1, 1, 0> pigment { image_map { png "palette.png" filter 60, 0.6 transmit 77, 0.8 transmit 255, 0.5 } } finish { ambient 0.4 } translate <-0.5, -0.5, 0> Put(0, 0.7) }
box { <0, 0, -0.05>, <1, 1, 0> pigment { rgb 0.8 } normal { bump_map { png "palette.png" use_index interpolate 2 bump_size 0.01 } } translate <-0.5, -0.5, 0> Put(1.5, 0.7) }
height_field { png "palette.png" pigment { rgb <0.8, 0.6, 0.4> } translate <-0.5, 0, -0.5> scale <2.4, 0.8, 1.6> translate <0, -1.2, -0.6> }
