/* A tile of the picture, drawn by beams: what is near enough as exact geometry, at some samples a pixel, what is farther as
 * voxels, one cone for all samples that see the same.
 *
 * Each skin has a distance at which voxels take over (CompiledSkin.exact_to). The samples of a pixel go over at slightly different
 * distances, so that one fades into the other: sample i of n at exact_to · 2^((i + 1/2)/n − 1/2), an octave from first to last. Those that see
 * voxels before what they see are shaded apart from those that do not, along the mean of their own lines. */
#ifndef VTS_RENDER_BEAM_TILE_H
#define VTS_RENDER_BEAM_TILE_H

#include "render/beam_allot.h"
#include "render/beam_shadow.h"
#include "render/integrate.h"

enum { BEAM_TILE = FILM_TILE, MOST_BEAM_SAMPLES = 1024 };

typedef struct BeamTracer BeamTracer;

typedef struct BeamPlan {
    AllotPlan samples; /* a pixel; at least 1, at most MOST_BEAM_SAMPLES */
    const atomic_bool *interrupted; /* may be NULL; tiles may be anything once it is true */
} BeamPlan;

/* Samples of a pixel that are drawn together, at most. */
int beam_most_in_pass(const CompiledScene *compiled);
/* Of one worker. All memory comes from the arena, now. */
BeamTracer *beam_tracer_create(const CompiledScene *compiled, const BeamPlan *plan, uint64_t seed, Arena *arena);
/* What the pixels of [x0, x1) × [y0, y1), at most BEAM_TILE each way, see; rows of `out` are x1 − x0 long; and so those of `aovs`, unless NULL, to
 * which what they see is added. */
void beam_tile(BeamTracer *tracer, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs);
/* The expected square of the error of what was drawn, summed over *pixels pixels: of noise, and where compiled->voxel_error is known of voxels. */
double beam_tracer_error(const BeamTracer *tracer, uint64_t *pixels);
/* The same of noise alone. */
double beam_tracer_noise(const BeamTracer *tracer);
/* Of the last tile, for each of its pixels. */
double beam_tile_noise(const BeamTracer *tracer);
/* What has been done so far, in counts that hang on nothing but the scene and the picture. */
typedef struct BeamWork {
    uint64_t triangles, nodes; /* mapped and drawn, and boxes around some */
    uint64_t rays, samples, steps;
    uint64_t sights; /* samples of a pixel that see the same, shaded once */
} BeamWork;
BeamWork beam_tracer_work(const BeamTracer *tracer);
void beam_tracer_count(const BeamTracer *tracer, TraceCounters *sum);

#endif
