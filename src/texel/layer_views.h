/* What a layer's triangles show along the directions that its coarse voxels are compared along: kept until all layers of a texel are built, which hide
 * each other. */
#ifndef VTS_TEXEL_LAYER_VIEWS_H
#define VTS_TEXEL_LAYER_VIEWS_H

#include "texel/voxel_pairs.h"
#include "texel/voxel_trim.h"

enum {
    TRIM_DIRECTIONS = TRIM_NODES * TRIM_NODES,
    TRIM_EVEN_SIDE = (TRIM_NODES + 1) / 2, /* every other of them each way */
    TRIM_EVEN = TRIM_EVEN_SIDE * TRIM_EVEN_SIDE,
    VIEWS_KEPT = PAIR_NODES + SPOT_VIEWS
};

struct LayerViews {
    bool known;        /* all of it */
    size_t triangles;
    Vec3f low, high;   /* the least and the most coordinates of the triangles */
    int levels;        /* that are trimmed */
    uint64_t hidden[TRIM_EVEN][VIEW_PLACES / 64]; /* along even nodes, a bit for each place */
    PairView views[VIEWS_KEPT];                   /* along the nodes of pairs, then beside some of them; NULL: not known */
    float tops[VIEWS_KEPT][VIEW_PLACES];
    ViewNormal normals[VIEWS_KEPT][VIEW_PLACES];
};

#endif
