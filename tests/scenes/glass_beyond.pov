// Filters that make contrast, brighten and invert: transmit beyond 0 and 1; with shadows.
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { orthographic location <0, 10, 0> look_at 0 right 8*x up 6*z sky z }
light_source { <20, 100, 30>, 0.8 }
plane { y, -1 pigment { checker rgb <0.1, 0.4, 0.8> rgb <0.8, 0.6, 0.2> scale 0.7 } finish { ambient 0.1 diffuse 0.7 } }
#macro Disc(X, Z, C) disc { <X, 0, Z>, y, 1.1 pigment { color C } finish { ambient 1 diffuse 0 } } #end
Disc(-2.4, 1.5, rgb 0 transmit 0.5)
Disc(0, 1.5, rgb 0 transmit 2)
Disc(2.4, 1.5, rgb 0.5 transmit -1)
Disc(-2.4, -1.5, rgb <0.5, 0.4, 0.3> transmit 2)
Disc(0, -1.5, rgb <1, 0.3, 0.2> filter -0.8)
Disc(2.4, -1.5, rgb 0.5 transmit 3)
