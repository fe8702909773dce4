/* Which side of a surface is its front. */
#ifndef VTS_SHAPE_SURFACE_FRONT_H
#define VTS_SHAPE_SURFACE_FRONT_H

#include "shape/surface_draft.h"
#include "shape/weld.h"

/* Cells with shared vertices, joined but not yet turned. */
typedef struct JoinedCells {
    const SurfaceDraft *draft;
    const uint32_t *place;             /* of the draft's vertices */
    SurfaceNeighbour (*neighbours)[4]; /* numbered by the draft's windings */
    bool (*same_way)[4]; /* the neighbour runs along the edge in the same direction: one must be turned */
} JoinedCells;

/* Sets turned[cell] for cells whose winding is to be reversed, and cuts neighbours that no choice makes consistent. */
void surface_front_choose(const JoinedCells *joined, Arena *scratch, bool *turned);

#endif
