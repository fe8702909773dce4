/* Rays of no width through a skin, against the geometry that its texels were made of: what voxels are measured by.
 *
 * The ray is cut at the walls of each cell that it meets. Within a cell its way through texture space is a curve, which is cut
 * into chords until they are within a ten-thousandth of a tile of it; each chord is shot against the copies of the texels
 * around it (exact_texel.h), and the hit is then moved onto the curve itself. */
#ifndef VTS_RENDER_EXACT_SKIN_H
#define VTS_RENDER_EXACT_SKIN_H

#include "render/skin.h"
#include "render/skin_march.h"

typedef struct SkinHit {
    double t;
    Vec3 normal;      /* unit, scene space; zero where the mapping is singular. Which side is the front is not told */
    double clearance; /* how far along the normal other matter may be told from this: scene units */
    const Look *look; /* the layer's own or the skin's */
    Vec3f tint;
    Vec3 place;       /* where to look up the pigment of `look`: the texel's bounds, or the scene */
    Vec3 place_normal; /* the normal there, unit or zero */
} SkinHit;

/* For a skin whose texels were compiled as exact. NULL when Embree is out of memory. */
ExactSkin *exact_skin_build(CompiledSkin *skin, void *embree_device);
void exact_skin_destroy(ExactSkin *exact);

/* The nearest matter with t in (t_min, t_max); unit direction. Chords are counted as steps. */
bool exact_skin_intersect(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, TraceCounters *counters, SkinHit *hit);
/* Whether there is any. */
bool exact_skin_occluded(const CompiledSkin *skin, const Ray *ray, double t_min, double t_max, TraceCounters *counters);

#endif
