/* Triangles that are given: meshes, and the surfaces of skins drawn themselves. */
#ifndef VTS_SHAPE_TESSELLATE_MESH_H
#define VTS_SHAPE_TESSELLATE_MESH_H

#include "shape/tessellate.h"

/* Appends a mesh in object space, each triangle cut into parts² (0, 1: as it is). Winding agrees with the given normals,
 * is otherwise as written. Parts that are closed (every edge, found by place, has an even number of triangles) are solid.
 * False with *reason when an index or a coordinate makes no sense. */
bool tessellate_mesh(const MeshData *mesh, int parts, Arena *arena, TriangleSoup *out, const char **reason);
/* Appends a skin's surface, after its transform; patches are cut until they are flat within tolerance. */
bool tessellate_surface(const Surface *surface, double tolerance, Arena *arena, TriangleSoup *out,
                        ShapeRefusal *refusal);

#endif
