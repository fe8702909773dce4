// A gradient and clouds, one over the other, on a sphere far away.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1, -5> look_at 1.6*y right x*image_width/image_height angle 75 }
light_source { <6, 9, -8>, rgb 1 }
sky_sphere {
  pigment { gradient y color_map { [0 rgb <0.6, 0.7, 0.85>] [0.5 rgb <0.2, 0.35, 0.7>] } }
  pigment { bozo turbulence 0.5 octaves 3 color_map { [0.4 rgbt 1] [0.7 rgbt <0.9, 0.9, 0.9, 0.2>] } scale <0.5, 0.2, 0.5> }
  rotate 10*x
}
plane { y, 0 pigment { rgb <0.35, 0.4, 0.25> } }
sphere { 0.8*y, 0.8 pigment { rgb 0.3 } finish { diffuse 0.4 } }
