// A pool: waves in the surface, the ground below seen through them.
#include "stage.inc"
plane { y, -0.8 pigment { checker rgb <0.5, 0.45, 0.4>, rgb <0.4, 0.4, 0.4> } }
plane { y, 0.1 pigment { rgbf <0.8, 0.9, 0.95, 0.8> } finish { ambient 0 diffuse 0.1 reflection { 0.02, 0.6 } } interior { ior 1.33 } }
sphere { <0, 0.3, 0.5>, 0.8 texture { Clay } }
