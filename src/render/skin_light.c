#include "render/skin_light.h"

/* Light that is less than this makes no difference: it is but a part of a pixel. */
static const float DARK_BELOW = 1.0f / 64;
/* The surroundings of a place, to both sides, in voxels of the shadow's cone: the blur of a blade. */
static const double SURROUNDINGS = 1.5;

void skin_light_init(SkinLight *light, const CompiledScene *compiled, TraceCounters *counters, Arena *arena) {
    *light = (SkinLight){compiled, arena_new_array(arena, SkinMarch, compiled->skin_count + 1),
                         arena_new_array(arena, uint32_t, compiled->skin_count + 1), counters};
    for (size_t i = 0; i < compiled->skin_count; i++) skin_march_init(&light->marches[i], &compiled->skins[i], arena);
}

static float rest_of_march(SkinMarch *march, float transmittance) {
    SkinSegment segment;
    while (transmittance > DARK_BELOW && skin_march_next(march, &segment)) transmittance *= segment.transmittance;
    return transmittance > DARK_BELOW ? transmittance : 0;
}

float skin_light_through(SkinLight *light, const Cone *cone, double t_max, int but) {
    const CompiledScene *scene = light->compiled;
    float transmittance = 1;
    const Ray axis = {cone->origin, cone->direction};
    size_t met = compiled_skins_met(scene, &axis, t_max, light->met);
    for (size_t k = 0; k < met && transmittance > 0; k++) {
        uint32_t i = light->met[k];
        if ((int)i == but) continue;
        SkinMarch *march = &light->marches[i];
        skin_march_begin(march, cone, 0, t_max, &scene->shadow_march, light->counters, false);
        transmittance = rest_of_march(march, transmittance);
    }
    return transmittance;
}

/* Blur spreads a blade over the voxels around it, and it must not shadow itself; but where many blades share a voxel they
 * shadow each other. What decides is that light is neither lost nor gained: what the beam loses, 1 − exp(−depth), falls on the
 * matter that is there. Its share of light is taken to fall as A·exp(−B·area passed), with A from that balance. B = 1 for matter at
 * random, depth = area; less where it hides itself in clumps, and nearing 0 as it comes to be one sheet, which loses
 * the most that its area can, is lit all alike and has but been blurred. */
float skin_light_share(float depth, float area, float before) {
    if (!(area > 0.01f)) return area > 0 ? float_clamp(depth / area, 0, 1) : 1; /* too thin to shadow itself */
    float lost = 1 - expf(-depth), random = 1 - expf(-area), sheet = float_min(area, 1);
    float fall = depth < area ? depth / area : 1 - float_clamp((lost - random) / (sheet - random), 0, 1);
    float along = fall * area;
    float share = along > 1e-3f ? lost * fall * expf(-fall * before) / (1 - expf(-along)) : lost / area;
    return float_clamp(share, 0, 1);
}

float skin_light_on_matter(SkinLight *light, const Cone *cone, double t_max, uint32_t own, const SkinPoint *at, double tolerance) {
    SkinMarch *march = &light->marches[own];
    double reach = skin_march_begin_around(march, cone, at, SURROUNDINGS, tolerance, t_max, &light->compiled->shadow_march, light->counters);
    float depth = 0, area = 0, before = 0, transmittance = 1;
    SkinSegment s;
    while (skin_march_next(march, &s)) {
        double length = s.t1 - s.t0, within = double_max(0, double_min(s.t1, reach) - s.t0);
        depth += s.depth * (float)(within / length);
        area += s.area * (float)(within / length);
        if (s.t1 > 0) before += s.area * (float)(double_max(0, within - double_max(-s.t0, 0)) / length);
        if (s.t1 > reach) {
            transmittance = rest_of_march(march, expf(-s.depth * (float)(1 - within / length)));
            break;
        }
    }
    return skin_light_share(depth, area, before) * transmittance;
}
