// Mandelbrot and Julia sets, a magnet, exterior and interior types.
#include "four.inc"
#declare Fan = color_map { [0 rgb <0.3, 0.35, 0.5>] [0.3 rgb <0.5, 0.5, 0.4>] [1 rgb <0.7, 0.65, 0.5>] }
Four(
  texture { pigment { mandel 12 color_map { Fan } scale 0.45 translate <0.2, 0, 0> } finish { Soft } },
  texture { pigment { julia <0.35, 0.3>, 8 interior 1, 1 color_map { Fan } scale 0.45 } finish { Soft } },
  texture { pigment { mandel 10 exterior 2, 0.4 color_map { Fan } scale 0.4 } finish { Soft } },
  texture { pigment { magnet 1 mandel 10 color_map { Fan } scale 0.3 translate -0.3*x } finish { Soft } })
