// mesh2: textures of vertices, normals of its own.
#include "stage.inc"
object { Floor }
mesh2 {
  vertex_vectors { 5, <-1, 0, -1>, <1, 0, -1>, <1, 0, 1>, <-1, 0, 1>, <0, 1.4, 0> }
  texture_list { 3, texture { pigment { Red } }, texture { pigment { Green } }, texture { pigment { Blue } } }
  face_indices { 4, <0, 1, 4>, 0, <1, 2, 4>, 1, <2, 3, 4>, 2, <3, 0, 4>, 0 }
  rotate 35*y translate <-1, 0, 0.2>
}
mesh2 {
  vertex_vectors { 6, <1, 0, 0>, <0, 1, 0>, <0, 0, 1>, <-1, 0, 0>, <0, -1, 0>, <0, 0, -1> }
  normal_vectors { 6, x, y, z, -x, -y, -z }
  face_indices { 8, <0, 1, 2>, <1, 3, 2>, <3, 4, 2>, <4, 0, 2>, <1, 0, 5>, <3, 1, 5>, <4, 3, 5>, <0, 4, 5> }
  scale 0.8 rotate 20*y translate <1.2, 0.9, 0> texture { Clay }
}
