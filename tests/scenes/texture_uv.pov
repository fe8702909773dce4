// u and v of a sphere, a box, a torus and a cone.
#include "stage.inc"
#declare Grid = texture { uv_mapping pigment { gradient x color_map { [0 rgb <0.2, 0.3, 0.6>] [1 rgb <0.7, 0.6, 0.4>] } scale <1/3, 1, 1> } }
object { Floor }
sphere { 0, 0.6 texture { Grid } translate <-1.5, 0.7, 0.2> }
torus { 0.5, 0.25 texture { Grid } rotate -40*x translate <0, 0.8, 0> }
mesh2 {
  vertex_vectors { 4, <-0.6, 0, 0>, <0.6, 0, 0>, <0.6, 1.2, 0>, <-0.6, 1.2, 0> }
  uv_vectors { 4, <0, 0>, <1, 0>, <1, 1>, <0, 1> }
  face_indices { 2, <0, 1, 2>, <0, 2, 3> }
  texture { Grid } rotate 30*y translate <1.5, 0.1, 0>
}
