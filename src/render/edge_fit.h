/* The straight edge that parts the samples in and around a pixel: where a pixel shows two lights and an edge between them, where the samples lie
 * tells more than how many lie on each side. */
#ifndef VTS_RENDER_EDGE_FIT_H
#define VTS_RENDER_EDGE_FIT_H

#include "base/common.h"

/* Of all points that are fitted at once. */
enum { EDGE_POINTS = 48 };

/* Places in pixels from the middle of the pixel, on this side of the edge or beyond it. */
typedef struct EdgePoints {
    float x[EDGE_POINTS], y[EDGE_POINTS];
    bool beyond[EDGE_POINTS];
    int count;
} EdgePoints;

typedef struct EdgeFit {
    float beyond;      /* the share of the pixel that lies beyond the edge */
    float variance;    /* squared error to be expected of that */
    float x, y, along; /* the mean of the edges: those places whose product with the unit direction is `along` */
} EdgeFit;

/* The mean over all straight lines that part the points, which are as likely by their measure (direction and distance). False where none of
 * the directions that are tried parts them, and where all lie on one side. */
bool edge_fit(const EdgePoints *points, EdgeFit *out);
/* A place of the pixel near its edge, where another point tells most: the `number`-th of them lies aside of those before. */
void edge_place(const EdgeFit *fit, int number, float *x, float *y);

#endif
