/* The ground as triangles, as many as are needed to be seen right and no more.
 *
 * A 4-8 mesh: right triangles, halved from the right angle to the middle of the longest side, and with them the neighbour across that
 * side, so that edges always meet whole (no cracks, no skirts). Below the posts halving goes on along the bilinear ground between them. */
#ifndef VTS_TERRAIN_GROUND_MESH_H
#define VTS_TERRAIN_GROUND_MESH_H

#include "scene/scene.h"
#include "terrain/ground_errors.h"

/* Where a triangle is, and the ground that it stands for, in the frame of the source's places. */
typedef struct GroundSpot {
    Vec3 centre;
    double radius; /* nothing of it is further away */
    double top;    /* or above this y */
} GroundSpot;

typedef struct GroundDetail {
    /* How far a triangle there may be from the ground, and how long its sides may be, in metres. */
    void (*allow)(const void *context, const GroundSpot *spot, double *error, double *side);
    const void *context;
    bool every_post;      /* all posts, and nothing between them */
    size_t most_vertices; /* 0: no limit */
} GroundDetail;

/* Builds the mesh in `arena`; its texture coordinates are x and z (uvs_from_above). Normals are slopes of the ground over as
 * much of it as the triangles reach (ground_normals.h).
 * False when there are more vertices than allowed; *out is then empty. `scratch` is reset to where it was, unless
 * it is `arena`. *needed (or NULL): how many triangles the errors ask for, those apart that are halved for a neighbour's sake alone. */
bool ground_mesh_build(const GroundSource *source, const GroundErrors *errors, const GroundDetail *detail, Arena *scratch, Arena *arena,
                       MeshData *out, size_t *needed);

#endif
