// A room with a window, a lamp and pictures on the wall.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1.6, -3.8> look_at <0, 1.2, 0> right x*image_width/image_height angle 65 }
light_source { <-9, 7, -1>, rgb <0.9, 0.85, 0.7> }
light_source { <0.8, 2.4, -1>, rgb 0.4 fade_distance 2 fade_power 2 }
difference {
  box { <-3.2, -0.1, -5>, <3.2, 3.2, 3.2> }
  box { <-3, 0, -4.8>, <3, 3, 3> }
  box { <-4, 1, -2>, <-2, 2.4, 0.8> }
  pigment { rgb <0.65, 0.6, 0.5> } finish { ambient 0.15 diffuse 0.7 }
}
box { <-0.9, 0, 0>, <0.9, 0.8, 1> pigment { rgb <0.4, 0.25, 0.15> } }
sphere { <0.3, 1.1, 0.5>, 0.3 pigment { rgb <0.3, 0.5, 0.6> } finish { phong 0.5 } }
box { <-1.2, 1.2, 2.9>, <0.6, 2.3, 2.99> pigment { agate color_map { [0 rgb <0.3, 0.4, 0.5>] [1 rgb <0.6, 0.5, 0.4>] } scale 2 } }
