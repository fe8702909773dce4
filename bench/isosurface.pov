// Equation 17 of Gamito & Maddock 2007 with POV-Ray's noise, all white before black, for both programs: bench/isosurface.sh.
#version 3.7;
#include "functions.inc"
global_settings { assumed_gamma 1 noise_generator 2 }
#ifndef (Gradient) #declare Gradient = 16; #end
#ifndef (Accuracy) #declare Accuracy = 0.0001; #end
#declare N = function(x, y, z) { 2*f_noise3d(x, y, z) - 1 }
camera { location <0, -5, 0> direction <0, 1, 0> right <0.88, 0, 0> up <0, 0, 0.66> }
isosurface {
  function { sqrt(x*x + y*y + z*z) - 1 + 0.6*(N(4*x, 4*y, 4*z) + pow(2, -0.8)*N(8*x, 8*y, 8*z)
             + pow(2, -1.6)*N(16*x, 16*y, 16*z) + pow(2, -2.4)*N(32*x, 32*y, 32*z)) }
  contained_by { sphere { 0, 2.26 } }
  max_gradient Gradient
  accuracy Accuracy
  pigment { rgb 1 }
  finish { ambient 1 diffuse 0 }
}
