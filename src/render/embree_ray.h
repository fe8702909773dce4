/* Which rays Embree may be asked about. */
#ifndef VTS_RENDER_EMBREE_RAY_H
#define VTS_RENDER_EMBREE_RAY_H

#include <embree3/rtcore.h>
#include <math.h>
#include <stdbool.h>

/* False for a ray from beyond 1e18 or with a number that is none: a build of Embree with its assertions, as Debian's is, ends the
 * program then. Such a ray meets nothing. */
static inline bool embree_takes(const struct RTCRay *ray) {
    static const float MOST = 1e18f;
    return fabsf(ray->org_x) < MOST && fabsf(ray->org_y) < MOST && fabsf(ray->org_z) < MOST && fabsf(ray->dir_x) < MOST &&
           fabsf(ray->dir_y) < MOST && fabsf(ray->dir_z) < MOST && !isnan(ray->tnear) && !isnan(ray->tfar);
}

#endif
