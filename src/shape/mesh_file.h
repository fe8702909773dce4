/* Meshes from files: Wavefront OBJ, PLY, glTF, STL, OFF. */
#ifndef VTS_SHAPE_MESH_FILE_H
#define VTS_SHAPE_MESH_FILE_H

#include "scene/scene.h"

typedef struct MeshFilePart {
    const MeshData *mesh; /* without textures of its own */
    bool colored;         /* the file's material has a colour */
    Color color;
} MeshFilePart;

typedef struct MeshFile {
    const MeshFilePart *parts;
    size_t part_count;
} MeshFile;

typedef struct MeshFileOptions {
    uint64_t most_vertices; /* and triangles; 0: no limit */
    bool by_color;          /* one part for each colour in the file; else one for all */
    bool smooth;            /* parts without normals get those of their vertices: the mean of the triangles around, by angle */
} MeshFileOptions;

/* Reads the file into `arena`. Coordinates are taken as they are. Positions, normals and texture coordinates that are equal are one
 * vertex each; triangles without area are left out. A program of its own, vts_mesh, does the reading: it may take as much memory again
 * as the arena's budget allows, and what it finds is checked here. False, with a line in `error`, for a file that is refused. */
bool mesh_file_read(const char *path, const MeshFileOptions *options, Arena *arena, MeshFile *out, StrBuf *error);

#endif
