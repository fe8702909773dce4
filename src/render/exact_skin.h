/* Rays of no width through skins, against the geometry that their texels were made of: what voxels are measured by.
 *
 * The ray is cut where it passes through the walls of each cell that it meets. Within a cell its way through texture space is
 * a curve, which is cut into cubics (curve.h) until they are within a few thousandths of a tile of it; each cubic is shot against the
 * copies of the texels around it (exact_texel.h), and what it comes near is looked at on the curve itself, where the hit is settled. */
#ifndef VTS_RENDER_EXACT_SKIN_H
#define VTS_RENDER_EXACT_SKIN_H

#include "render/skin.h"
#include "render/skin_march.h"

typedef struct SkinHit {
    double t;
    Vec3 normal;      /* unit, scene space, of what the triangle stands for; zero where the mapping is singular. Which side is the front is not told */
    Vec3 flat;        /* the same of the triangle itself, on the same side */
    double clearance; /* how far along `flat` other matter may be told from this: scene units */
    Vec3 up;          /* unit, across the layer from its foot; zero where the mapping is singular */
    const Look *look; /* the layer's own or the skin's */
    Vec3f tint;
    Vec3 place;       /* where to look up the pigment of `look`: the texel's bounds, or the scene */
    Vec3 place_normal; /* the normal there, unit or zero */
} SkinHit;

struct Embree;
/* The cells of all skins, whose texels were compiled as exact, under one hierarchy. The skins must stay. NULL when memory is out. */
ExactSkins *exact_skins_build(const CompiledSkin *skins, size_t count, const struct Embree *embree);
/* Also of NULL. */
void exact_skins_destroy(ExactSkins *exact);

/* The nearest matter with t in (t_min, t_max); unit direction. Cubics are counted as steps. `exact` NULL: no skins. */
bool exact_skins_intersect(const ExactSkins *exact, const Ray *ray, double t_min, double t_max, TraceCounters *counters, SkinHit *hit);
/* Whether there is any. */
bool exact_skins_occluded(const ExactSkins *exact, const Ray *ray, double t_min, double t_max, TraceCounters *counters);

#endif
