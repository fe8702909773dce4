/* A skin's surface on its way to a SurfaceMesh: cells in scene space, not yet joined, front not yet decided. */
#ifndef VTS_SHAPE_SURFACE_DRAFT_H
#define VTS_SHAPE_SURFACE_DRAFT_H

#include "shape/surface_mesh.h"

typedef struct DraftCell {
    uint32_t vertex[4]; /* into the draft's vertices */
    uint8_t corner_count;
    bool directed; /* the winding means something: it was made from normals */
} DraftCell;

typedef struct SurfaceDraft {
    SoupVertexList
        vertices; /* all with texture coordinates; the normal is zero where the cells shall tell it */
    DraftCell *cells;
    size_t cell_count;
    double shortest_cut; /* as in SurfaceMesh */
} SurfaceDraft;

bool surface_draft_build(const Surface *surface, const SurfaceMeshOptions *options, Arena *arena,
                         SurfaceDraft *out, ShapeRefusal *refusal);

#endif
