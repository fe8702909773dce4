/* From what pixels see to a picture: tiles over the workers, exposure, progress, interruption. */
#ifndef VTS_RENDER_FILM_H
#define VTS_RENDER_FILM_H

#include "base/pool.h"
#include "base/progress.h"
#include "base/vec.h"
#include "image/image.h"
#include "image/tile_file.h"
#include "render/aov.h"

#include <stdatomic.h>

typedef struct Radiance {
    Vec3f color;   /* multiplied by alpha */
    float alpha;   /* 1 - what of the background shows */
} Radiance;

typedef struct RenderOptions {
    Pool *pool;
    const Progress *progress;
    const atomic_bool *interrupted; /* may be NULL; pixels after it became true stay black */
    int region[4];   /* x0, y0, x1, y1 in pixels, x1 and y1 exclusive */
    int samples;     /* cones per pixel side where one is not enough; 0: by max_error. Of the reference: rays a pixel */
    uint64_t seed;   /* of what is sampled */
    double noise;    /* so many times as noisy as else may be what random samples draw, 1 or more; 0: 1. The same for all that is not random */
    TileFile *kept;    /* tiles of another run, which are taken as they are, and those of this one; or NULL */
    const bool *tiles; /* those of the region that are wanted, rows from the top; the others stay black. NULL: all */
    float *tile_noise; /* of each of these tiles: the mean square of the noise that beams expect to be in its pixels, 0 where none is known; or NULL */
    double exposure; /* EV */
    bool alpha;      /* keep the background transparent */
    const AovPlan *aovs; /* further channels; or NULL */
    struct Preview *preview; /* is shown the tiles as they are done; or NULL */
    const char *name;        /* of the picture, there */
} RenderOptions;

enum { FILM_TILE = 32, FILM_MOST_CHANNELS = 4 + AOV_MOST_CHANNELS };

/* How many tiles a region touches, across and down. */
static inline int film_tiles_x(const int region[4]) { return (region[2] - 1) / FILM_TILE - region[0] / FILM_TILE + 1; }
static inline int film_tiles_y(const int region[4]) { return (region[3] - 1) / FILM_TILE - region[1] / FILM_TILE + 1; }

/* The names of a picture's channels: R G B, A if wanted, and the further ones (NULL: none). Returns how many. */
int film_channels(bool alpha, const AovPlan *aovs, const char *names[FILM_MOST_CHANNELS]);

/* What the pixels of [x0, x1) × [y0, y1), at most FILM_TILE each way, see: rows of x1 − x0 in `out`, and in `aovs` (NULL: not
 * wanted; comes as zeros). Called by worker `worker` of the pool; must not depend on it. */
typedef void FilmTile(void *context, int worker, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs);

/* Exposes the region (R G B, or R G B A with alpha, then the further channels; `out` is initialised here). What pixels see are numbers of
 * this gamma (base/gamma.h). False when cancelled or out of memory (text
 * in `error`, which may be NULL); `out` then holds nothing. */
bool film_expose(const RenderOptions *options, double gamma, const char *stage, FilmTile *tile, void *context, MemoryBudget *memory, Image *out,
                 StrBuf *error);

#endif
