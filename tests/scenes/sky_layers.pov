// Clear layers of the sky over each other, and how bright they are.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, 0> look_at <0, 2, 4> right x*image_width/image_height angle 70 }
background { rgb <0.1, 0.3, 0.2> }
sky_sphere {
  pigment { gradient y color_map { [0 rgb <0.9, 0.6, 0.3>] [0.6 rgbt <0.1, 0.2, 0.6, 0.4>] } }
  pigment { bozo color_map { [0 rgbf <0.8, 0.8, 0.7, 0.2>] [0.7 rgbf <0.9, 0.9, 1, 0.9>] } scale <0.4, 0.1, 0.4> }
  pigment { gradient x color_map { [0 rgbft <0.9, 0.4, 0.4, 0.6, 0.3>] [1 rgbft <0.4, 0.9, 0.4, 0.3, 0.6>] } }
  emission <1, 0.9, 0.8>
}
plane { y, 0 pigment { rgb 0.4 } finish { ambient 1 diffuse 0 } }
