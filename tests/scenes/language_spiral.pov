// Loops, splines, random numbers of a seed.
#include "stage.inc"
object { Floor }
#declare Way = spline { cubic_spline -0.2, <-2, 0.2, 0>, 0, <-1.6, 0.3, 0>, 0.4, <-0.6, 1.5, -0.4>, 0.7, <0.8, 0.3, 0.4>, 1, <1.7, 1.2, 0>, 1.2, <2, 1.5, 0> }
#declare Dice = seed(42);
#declare T = 0;
#while (T <= 1.001)
  sphere { Way(T), 0.12 + 0.1*rand(Dice) pigment { rgb <0.3 + 0.5*rand(Dice), 0.5, 0.3 + 0.5*rand(Dice)> } }
  #declare T = T + 0.05;
#end
