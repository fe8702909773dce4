/* Cutting a triangle into the pieces that lie in the cells of a unit grid. */
#ifndef VTS_TEXEL_VOXEL_CLIP_H
#define VTS_TEXEL_VOXEL_CLIP_H

#include "base/common.h"

enum { CLIP_VERTICES = 12 };

/* A convex planar polygon in grid coordinates. */
typedef struct ClipPolygon {
    int count;
    double at[CLIP_VERTICES][3];
} ClipPolygon;

/* Called for each cell of [0, size)³ that the polygon meets, with the piece in it. */
typedef void ClipPiece(void *context, const int cell[3], const ClipPolygon *piece);
void clip_to_cells(const ClipPolygon *polygon, const int size[3], ClipPiece *piece, void *context);

/* Twice the area of the polygon projected along `axis`, signed. */
double clip_projected_area(const ClipPolygon *polygon, int axis);

#endif
