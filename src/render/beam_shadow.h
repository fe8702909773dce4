/* Exact shadows of skins on points: beams towards a light. */
#ifndef VTS_RENDER_BEAM_SHADOW_H
#define VTS_RENDER_BEAM_SHADOW_H

#include "render/beam_bins.h"
#include "render/beam_skin.h"

/* Points to be tested; `hidden` is set, never cleared, for those that matter of skins keeps from the light. */
typedef struct ShadowPoints {
    Vec3 origin;           /* from which the points count */
    const Vec3f *points;
    const float *distance; /* of each from the eye: skins that are voxels there are left out */
    uint8_t *hidden;
    uint32_t count;
} ShadowPoints;

enum { MOST_BINS_ACROSS = 128 };

typedef struct ShadowScratch {
    BeamDraft draft;       /* with room for cells; of facets nothing is kept */
    Vec3f *seen;           /* the points as the light sees them */
    uint32_t *order;       /* those that are looked at, the points of one beam side by side */
    BeamBins bins;         /* of one beam; whoever draws no shadows may use them meanwhile */
    uint64_t rays;         /* counted up */
} ShadowScratch;

/* All but the draft. */
void shadow_scratch_init(ShadowScratch *scratch, uint32_t points, Arena *arena);
void beam_shadow(ShadowScratch *scratch, const CompiledScene *compiled, const Light *light, const ShadowPoints *points);

#endif
