/* Light that samples share with the middles of pixels around: at edges the surfaces on both sides are found again and again, and not what
 * lights them. Cells lie in rows of CONTRAST_EDGE. */
#ifndef VTS_RENDER_SHARED_LIGHT_H
#define VTS_RENDER_SHARED_LIGHT_H

#include "render/cell.h"

/* A further sample of a pixel. */
typedef struct SharedPlace {
    double x, y; /* in the pixel, in pixels */
    const Cone *cone;
    const SurfaceHit *hit; /* NULL: nothing */
} SharedPlace;

/* Its light as the middles around the cell have it; false where they do not tell. `max_error`: of the picture. */
bool shared_light(const Cell *cell, const SharedPlace *place, double max_error, Radiance *out);

/* Whether all around the middle see the same surface, in the same light but for the colour of its pattern. */
bool shared_but_pattern(const Cell *cell, double max_error);

#endif
