/* Samples of the pixels of a tile where no skins are drawn by beams: one in the middle of each, and more where the picture's error is. */
#ifndef VTS_RENDER_SAMPLER_H
#define VTS_RENDER_SAMPLER_H

#include "render/middles.h"

typedef struct SamplePlan {
    int fixed;        /* samples of every pixel; 0: by the error */
    int most;         /* of a pixel, otherwise, */
    int most_mean;    /* and on the mean of a tile */
    double max_error; /* that is accepted: RMSE over a tile, of light clamped to [0, 1] */
    uint64_t seed;
    const atomic_bool *interrupted; /* may be NULL */
} SamplePlan;

typedef struct Sampler Sampler; /* of one worker */

Sampler *sampler_create(const CompiledScene *compiled, const SamplePlan *plan, Arena *arena);
/* Whether middles, or the matter of skins in them, may be guessed by others of their tile (guess.h). */
bool sampler_guesses(const Sampler *sampler);
/* Before the first tile: what the samplers of all workers share, where nothing is added to `aovs`. NULL: each tile looks for itself. */
void sampler_share(Sampler *sampler, Middles *middles);
/* A whole tile, [x0, x1) × [y0, y1), at most FILM_TILE each way: rows of x1 − x0 in `out`, and what is seen
 * there added to `aovs`, unless NULL. What it gives depends on the tile alone. */
void sampler_tile(Sampler *sampler, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs);

/* Sums over all tiles so far: of the squared errors to be expected, of pixels, and of those that took more than one sample. */
typedef struct SamplerTally {
    double squared_error;
    uint64_t pixels, refined;
} SamplerTally;
void sampler_count(const Sampler *sampler, TraceCounters *counters, SamplerTally *tally);

#endif
