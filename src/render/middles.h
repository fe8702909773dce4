/* What the middles of pixels see, tile by tile: the samplers of a picture share them, since each tile looks at the pixels around it. */
#ifndef VTS_RENDER_MIDDLES_H
#define VTS_RENDER_MIDDLES_H

#include "render/film.h"
#include "render/integrate.h"

/* The first sample of a pixel. */
typedef struct Middle {
    Radiance seen;
    Vec3f normal;    /* of the surface, */
    uint32_t object; /* and its number, from 1; 0: none */
    bool calm;       /* it is even, mirrors nothing and lets nothing through; or matter of skins is before it */
    bool refinable;  /* the pixel's error can be that of edges */
    bool single;     /* beside it there may be anything: it tells nothing of others */
    float hidden;    /* the share of it that skins' matter hides */
    SurfaceTint tint; /* how its light depends on its colour, if it does */
    float doubt;     /* of light that was guessed: squared error to be expected */
} Middle;

/* The light of a middle, if the surface there had another colour. */
static inline Vec3f middle_as(Vec3f seen, const SurfaceTint *tint, const SurfaceTint *other) {
    return tint->texture ? vec3f_add(seen, vec3f_mul(vec3f_sub(other->color, tint->color), tint->lit)) : seen;
}

typedef struct Middles Middles;

/* Tiles by number, [x0, x1) × [y0, y1). */
typedef struct TileRange {
    int x0, y0, x1, y1;
} TileRange;

/* For those who draw some tiles and may ask for `asked`, which holds these. NULL when memory is short. */
Middles *middles_create(TileRange drawn, TileRange asked);
void middles_destroy(Middles *middles);

/* Rows of FILM_TILE middles of a tile, as far as the picture goes; NULL for tiles that are not among those, and when memory is short.
 * Who asks first makes them with see(context, x, y, rows), others wait for it; asked for without `wait` they may be NULL for that. */
const Middle *middles_ask(Middles *middles, int x, int y, bool wait,
                          void (*see)(void *context, int x, int y, Middle *rows), void *context);
/* The tile is finished: what no other needs any more is released. Each tile once, after all that it asked for. */
void middles_leave(Middles *middles, int x, int y);

#endif
