/* The source triangles of a texel, in clusters under a tree, for beams: what a beam does not meet is passed over as a whole. */
#ifndef VTS_RENDER_BEAM_TEXEL_H
#define VTS_RENDER_BEAM_TEXEL_H

#include "base/arena.h"
#include "texel/facet_normals.h"

enum { CLUSTER_TRIANGLES = 32, CLUSTER_VERTICES = 96 };

/* Vertices are coordinates within the texel's box: 0 … 1 along each axis. */
typedef struct TexelCluster {
    const float *x, *y, *z;
    const uint8_t (*triangles)[3];
    const uint16_t *layers; /* of each triangle */
    const FacetNormals *normals; /* the same, in texel space; NULL: all are flat */
    int vertex_count, triangle_count;
    float longest[3]; /* how far along each axis its edges reach at most */
} TexelCluster;

/* Inner nodes: children at `first` and `first` + 1. Leaves: cluster `first`. */
typedef struct ClusterNode {
    float min[3], max[3];
    uint32_t first;
    bool leaf;
} ClusterNode;

typedef struct BeamTexel {
    const ClusterNode *nodes; /* the root is the first */
    size_t node_count;        /* 0: nothing in it */
    const TexelCluster *clusters;
    size_t cluster_count, triangle_count, bytes;
    bool cyclic[3];
} BeamTexel;

typedef struct BeamTexelDraft BeamTexelDraft;

/* A draft and all of its triangles live in `scratch`. */
BeamTexelDraft *beam_texel_begin(Vec3f extent, unsigned cyclic, Arena *scratch);
/* Adds a layer's triangles, cut at the walls of the box; along cyclic axes what is cut off comes in on the other side. */
void beam_texel_add_layer(BeamTexelDraft *draft, const TexelMesh *mesh);
/* The clusters, in `arena`. */
const BeamTexel *beam_texel_finish(BeamTexelDraft *draft, Arena *arena);

#endif
