/* How much the light of pixels differs from that around them: what tells of edges between their middles. */
#ifndef VTS_RENDER_CONTRAST_H
#define VTS_RENDER_CONTRAST_H

#include "render/film.h"

/* A tile and the pixels around it, whose first samples tell what differs across its border. */
enum { CONTRAST_EDGE = FILM_TILE + 2, CONTRAST_CELLS = CONTRAST_EDGE * CONTRAST_EDGE };

/* Light that the picture can show, in rows of CONTRAST_EDGE. */
typedef struct LightPlanes {
    float channels[3][CONTRAST_CELLS];
} LightPlanes;

/* Of `count` ≤ FILM_TILE pixels of a row from `first` on, which has all neighbours: the largest second difference with those on both
 * sides, as a squared error. */
void contrast_row(const LightPlanes *light, int first, int count, float *out);
/* Of one of them. */
float contrast_at(const LightPlanes *light, int place);

/* -log4 of it, rounded down, from 0 to below CONTRAST_CLASSES. */
enum { CONTRAST_CLASSES = 8 };
int contrast_class(float contrast);

#endif
