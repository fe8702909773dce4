/* Rays that Embree meets by as many at once as the machine takes: those that lie beside each other go the same ways. */
#ifndef VTS_RENDER_RAY_BUNDLE_H
#define VTS_RENDER_RAY_BUNDLE_H

#include "base/vec.h"
#include "render/embree_module.h"

#include <stdbool.h>
#include <stdint.h>

enum { MOST_LANES = 8 };
/* Rays that begin farther than this from 0 along an axis are left out. */
static const float BUNDLE_FARTHEST = 1e10f;

/* The fields of RTCHitN: arrays of N, one after the other, as Embree's filters get them, too. Its accessors are C++. */
enum { HIT_U = 3, HIT_V = 4, HIT_TRIANGLE = 5, HIT_GEOMETRY = 6, HIT_COPY = 7, HIT_FIELDS };
/* Those of RTCRayHitN, which end with RTCHitN. RTCRayHit is the same for N = 1. */
enum { RAY_ORIGIN = 0, RAY_NEAR = 3, RAY_DIRECTION = 4, RAY_FAR = 8, RAY_MASK = 9, RAY_FIELDS = 12 };

typedef union RayCell {
    float real;
    unsigned number;
} RayCell;

typedef struct RayBundle {
    _Alignas(64) int valid[MOST_LANES];
    _Alignas(64) RayCell cells[(RAY_FIELDS + HIT_FIELDS) * MOST_LANES];
    uint32_t sample[MOST_LANES]; /* what each ray is for */
    int count, lanes;
} RayBundle;

/* Rays that the machine takes at once: MOST_LANES or 1. */
int bundle_lanes(const Embree *embree);
/* An empty one. */
RayBundle bundle_for(int lanes);
void bundle_clear(RayBundle *bundle);
/* There must be room: count < lanes. Left out are rays that Embree cannot take. */
void bundle_add(RayBundle *bundle, Vec3f origin, Vec3f direction, float near, float far, uint32_t sample);
/* Until the next bundle_clear(): RAY_FAR and the hit of each ray; RAY_FAR below 0 where something was met. */
void bundle_intersect(RayBundle *bundle, const EmbreeShim *rtc, RTCScene scene);
void bundle_occlude(RayBundle *bundle, const EmbreeShim *rtc, RTCScene scene);

static inline RayCell *bundle_cell(RayBundle *bundle, int field, int ray) { return &bundle->cells[field * bundle->lanes + ray]; }
static inline RayCell *bundle_hit(RayBundle *bundle, int field, int ray) { return bundle_cell(bundle, RAY_FIELDS + field, ray); }

#endif
