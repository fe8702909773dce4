/* How much of a light comes through skins: to a place anywhere, and to the matter of a skin itself. */
#ifndef VTS_RENDER_SKIN_LIGHT_H
#define VTS_RENDER_SKIN_LIGHT_H

#include "render/skin_front.h"

/* What one worker needs. */
typedef struct SkinLight {
    const CompiledScene *compiled;
    SkinMarches marches;
    SkinMet *met;       /* the skins that a cone meets */
    TraceCounters *counters;
} SkinLight;

void skin_light_init(SkinLight *light, const CompiledScene *compiled, TraceCounters *counters, Arena *arena);

/* The share of light that passes all skins but `but` (-1: none) along the cone from t = 0 to t_max, which begins at a place that is seen from
 * the direction `to_eye`. In [0, 1]. */
float skin_light_through(SkinLight *light, const Cone *cone, double t_max, int but, Vec3 to_eye);

/* The same of those skins that are not drawn as exact geometry at the distance `seen_from` from the eye. */
float skin_light_through_voxels(SkinLight *light, const Cone *cone, double t_max, double seen_from, Vec3 to_eye);

/* The share of light that comes to matter of skin `own` at the start of the cone, which lies at `at` in it and is seen from the direction `to_eye`; what
 * other skins take away is left out. `tolerance` (scene units) is that of finding places in the skin. In [0, 1]. */
float skin_light_on_matter(SkinLight *light, const Cone *cone, double t_max, uint32_t own, const SkinPoint *at, double tolerance, Vec3 to_eye);

#endif
