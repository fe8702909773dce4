// Columns in fog: sets, copies, a sky.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1.6, -8> look_at <0, 1.4, 0> right x*image_width/image_height angle 45 }
light_source { <-8, 12, -9>, rgb <1, 0.95, 0.85> }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.7, 0.7, 0.7>] [0.5 rgb <0.3, 0.4, 0.6>] } } }
fog { distance 30 rgb <0.65, 0.68, 0.7> }
plane { y, 0 pigment { checker rgb <0.45, 0.4, 0.35>, rgb <0.5, 0.46, 0.4> scale 1.5 } }
#declare Column = union {
  box { <-0.4, 0, -0.4>, <0.4, 0.2, 0.4> }
  difference { cylinder { 0.2*y, 2.6*y, 0.3 } #for (I, 0, 7) cylinder { <0.31, 0, 0>, <0.31, 3, 0>, 0.07 rotate 45*I*y } #end }
  box { <-0.4, 2.6, -0.4>, <0.4, 2.8, 0.4> }
  pigment { rgb <0.75, 0.7, 0.6> }
}
#for (I, 0, 4) object { Column translate <-1.6, 0, 3*I - 3> } object { Column translate <1.6, 0, 3*I - 3> } #end
