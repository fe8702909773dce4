/* What the program vts_mesh, which reads files of meshes, writes for us: a header, then either a line of text that says why the file
 * is refused, or parts, each with its arrays behind it. In the byte order of the machine. */
#ifndef VTS_SHAPE_MESH_STREAM_H
#define VTS_SHAPE_MESH_STREAM_H

#include <stdint.h>

#define MESH_STREAM_MAGIC 0x3148534d53545600u /* changes with the format */

typedef enum MeshStreamStatus {
    MESH_STREAM_READ,
    MESH_STREAM_REFUSED,  /* the text follows */
    MESH_STREAM_TOO_LARGE /* `count` vertices or triangles: more than was allowed */
} MeshStreamStatus;

typedef struct MeshStreamHeader {
    uint64_t magic;
    uint32_t status;
    uint32_t part_count;
    uint64_t count; /* bytes that follow */
} MeshStreamHeader;

enum { MESH_STREAM_NORMALS = 1, MESH_STREAM_UVS = 2, MESH_STREAM_COLOR = 4 };

/* Followed by vertex_count positions of 3 floats, as many normals of 3 and texture coordinates of 2 where the flags say so, and
 * triangle_count triangles of 3 indices. */
typedef struct MeshStreamPart {
    uint32_t vertex_count, triangle_count, flags, zero;
    double color[4]; /* red, green, blue, opacity */
} MeshStreamPart;

#endif
