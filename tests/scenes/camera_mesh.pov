// mesh_camera: two rays a pixel, along triangles that lie on a bent sheet.
#version 3.7;
global_settings { assumed_gamma 1 }
light_source { <6, 9, -8>, rgb 1 }
background { rgb <0.35, 0.45, 0.6> }
plane { y, 0 pigment { rgb 0.4 } finish { ambient 0.1 diffuse 0.6 } }
sphere { <-0.9, 0.8, 0.5>, 0.8 pigment { rgb <0.7, 0.3, 0.2> } }
cone { <1, 0, 0>, 0.8, <1, 1.8, 0>, 0 pigment { rgb <0.3, 0.5, 0.7> } }
#macro Sheet(Shift)
  mesh {
    #local J = 0;
    #while (J < image_height)
      #local I = 0;
      #while (I < image_width)
        #local P = <((I + 0.5 + Shift)/image_width - 0.5)*1.4, (0.5 - (J + 0.5)/image_height)*1.05 + 0.1, 0>;
        #local D = vnormalize(<P.x, P.y - 0.1, 1.1>);
        #local A = vnormalize(vcross(y, D));
        #local B = vcross(D, A);
        #local C = <0, 1, -4> + P;
        triangle { C + 0.02*(-A - B), C + 0.02*(2*B), C + 0.02*(A - B) }
        #local I = I + 1;
      #end
      #local J = J + 1;
    #end
  }
#end
camera { mesh_camera { 2 0 Sheet(-0.25) Sheet(0.25) } location <0, 0, 0.001> }
