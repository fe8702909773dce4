/* Pixels through which one edge goes between two lights, as the middles around show it. Where it goes is looked for by further samples, each
 * where the edge is thought to be, so that each takes away half of what is not known: as many samples laid by lot tell how many are on each
 * side, which is far less. (Filters of finished pictures find edges so, without samples: Reshetov, Morphological antialiasing, 2009.) */
#ifndef VTS_RENDER_PIXEL_EDGE_H
#define VTS_RENDER_PIXEL_EDGE_H

#include "render/cell.h"
#include "render/edge_fit.h"

typedef struct PixelEdge {
    const Cell *cell, *other; /* a middle beyond the edge */
    float apart;              /* what their lights differ, squared */
    EdgePoints points;
    Radiance sums[2]; /* of the light on this side, and beyond, */
    int counts[2];    /* so many */
    EdgeFit fit;
} PixelEdge;

/* As the middles around have it; false where they show more than two lights, a pattern's colours, or no straight edge. Cells lie in rows of
 * CONTRAST_EDGE. */
bool pixel_edge_begin(const Cell *cell, PixelEdge *edge);
/* A sample at (x, y) of the pixel, from its middle in pixels. False where it shows a third light, or that the edge is not straight. */
bool pixel_edge_add(PixelEdge *edge, float x, float y, const Radiance *seen);
/* The pixel's light, and the squared error to be expected of it. */
Radiance pixel_edge_light(const PixelEdge *edge);
float pixel_edge_error(const PixelEdge *edge);

#endif
