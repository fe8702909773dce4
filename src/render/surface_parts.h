/* What a surface looks like at a place, where several looks may blend. */
#ifndef VTS_RENDER_SURFACE_PARTS_H
#define VTS_RENDER_SURFACE_PARTS_H

#include "pattern/pattern.h"
#include "render/hierarchy.h"

/* Of each look of a hit at most so many parts are seen. */
enum { SURFACE_LOOK_PARTS = 4, SURFACE_PARTS = SURFACE_LOOK_PARTS * (1 + LOOK_SHARES) };

typedef struct SurfaceParts {
    SurfacePlace places[1 + LOOK_SHARES]; /* what the parts point to; the first is the caller's to set */
    TexturePart parts[SURFACE_PARTS];
    size_t count;
} SurfaceParts;

/* Whether the place makes a difference: else out->places[0] need not be set. */
static inline bool surface_parts_ask_place(const SurfaceHit *hit) { return hit->share_count > 0 || !hit->look->even; }

/* texture_parts() of all looks of the hit, with weights that add up to 1; only `count` and what it counts is set. `hit` must outlive `out`,
 * which must not move. */
void surface_parts_find(const SurfaceHit *hit, SurfaceParts *out);

#endif
