/* Light of the sky on what beams show of skins: whether something of a skin lies between each sample and one place of the sky. */
#ifndef VTS_RENDER_BEAM_SKY_H
#define VTS_RENDER_BEAM_SKY_H

#include "render/beam_shadow.h"

enum { SKY_PAIRS = 16 };

/* Samples that ask. Sample i looks along direction number turn[i] of SKY_PAIRS, to the side where `up` is: the same directions all over
 * the picture, each pixel beginning with another, so that neither tiles nor bands can be told. */
typedef struct SkySamples {
    Vec3 origin;           /* from which points count */
    const Vec3f *points, *up, *flat; /* flat: as long as the bias by which a point is moved to the side that looks at the sky */
    const float *distance; /* from the eye */
    const uint8_t *turn;
    uint8_t *hidden;       /* gets 1 or 0 */
    uint32_t count;
} SkySamples;

typedef struct SkyScratch {
    Vec3f *points;
    float *distance;
    uint8_t *hidden;
    uint32_t *sample;
} SkyScratch;

/* The direction that a sample with this turn asks, in the hemisphere about `up`. */
Vec3 beam_sky_direction(int turn, Vec3f up);
void sky_scratch_init(SkyScratch *scratch, uint32_t samples, Arena *arena);
void beam_sky(SkyScratch *scratch, ShadowScratch *shadow, const CompiledScene *compiled, const SkySamples *samples);

#endif
