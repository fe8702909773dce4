/* The mean of pictures of moments, tile by tile, and which tiles ask for more of them: for vts_shutter.c. */
#ifndef VTS_VTS_MOMENTS_H
#define VTS_VTS_MOMENTS_H

#include "base/arena.h"
#include "image/image.h"

/* The mean over time by the trapezoidal rule, whose intervals are halved until the moments between tell nothing new: in each tile for itself. What the
 * moments between differ by from the mean so far is about twice the error of both together. */
typedef struct MomentMean {
    Image mean, between;  /* so far; and the sum over the moments between, as parts of their mean. Pixels from (x0, y0) on */
    int width, height;    /* of the images */
    int x0, y0, tile;     /* tiles lie at multiples of their size, from where that of (x0, y0) begins */
    int block;            /* the size of what may be off by more than the whole tile */
    int channels;         /* that are light */
    int tiles_x, tiles_y;
    bool *open, *moving;  /* of tiles: not finished; of these, those that the last moments changed */
    float *noise, *noise_between; /* of tiles: the mean squares of the noise that is expected in the means, 0 where none is known */
} MomentMean;

/* The moments of a picture come in a fixed order: both ends, the middle, and then the middles of ever more intervals. */
typedef struct MomentPlace {
    int intervals; /* whose middles are drawn; 0: the ends */
    int index;     /* of the middle, or end */
    double moment; /* 0 to 1 */
} MomentPlace;
MomentPlace moment_place(int number);
static inline bool moment_is_last(MomentPlace place) { return place.intervals > 0 && place.index == place.intervals - 1; }

/* Tiles over `width` × `height` pixels, all of them open; arrays in `arena`. */
void moment_mean_lay(MomentMean *m, int width, int height, Arena *arena);
/* Takes over a picture of the moment at `place`, with the noise of tiles of `tile_noise`, `side` of which lie along each of theirs; those of one
 * number of intervals follow each other. */
void moment_mean_add(MomentMean *m, MomentPlace place, Image *picture, const float *tile_noise, int side);
/* After the last of so many intervals: the mean is over all of them, and `moving` says where they still change it by more than `accepted`, an RMSE, and
 * by more than their noise. */
void moment_mean_finish(MomentMean *m, double accepted);
/* Which tiles stay open, now that there are so many intervals: those that move, and those that `scout`, whose tiles are the same parts of the whole
 * picture, sees something move in or near to, so far as it may go between two moments. `scout` may be `m`, or NULL: none; `first_x`, `first_y`: the tile of the scout
 * that is the first one here. Whether any does. */
bool moment_mean_close(MomentMean *m, const MomentMean *scout, int first_x, int first_y, int intervals);
void moment_mean_free(MomentMean *m);

#endif
