#include "render/skin_light.h"

#include "render/skin_joint.h"
#include "texel/light_share.h"

void skin_light_init(SkinLight *light, const CompiledScene *compiled, TraceCounters *counters, Arena *arena) {
    *light = (SkinLight){.compiled = compiled, .met = arena_new_array(arena, SkinMet, compiled->skin_count + 1), .counters = counters};
    skin_marches_init(&light->marches, compiled, 1, arena);
}

static float rest_of_march(const SkinLight *light, SkinMarch *march, float transmittance) {
    float dark = light->compiled->dark_below;
    SkinSegment segment;
    while (transmittance > dark && skin_march_next(march, &segment)) transmittance *= segment.transmittance;
    return transmittance > dark ? transmittance : 0;
}

/* Through one skin, from what may be the ground under it. */
static float through_skin(const SkinLight *light, SkinMarch *march, Vec3 to_eye) {
    SkinSegment first;
    if (!skin_march_next(march, &first)) return 1;
    return skin_joint_ground(march, to_eye, rest_of_march(light, march, first.transmittance));
}

float skin_light_through(SkinLight *light, const Cone *cone, double t_max, int but, Vec3 to_eye) {
    const CompiledScene *scene = light->compiled;
    float transmittance = 1;
    const Ray axis = {cone->origin, cone->direction};
    size_t met = compiled_skins_met(scene, &axis, t_max, light->met);
    for (size_t k = 0; k < met && transmittance > scene->dark_below; k++) {
        uint32_t i = light->met[k].skin;
        if ((int)i == but) continue;
        SkinMarch *march = skin_marches_get(&light->marches, i, 0);
        skin_march_begin(march, cone, 0, t_max, &scene->shadow_march, light->counters, false);
        transmittance *= through_skin(light, march, to_eye);
    }
    return transmittance > scene->dark_below ? transmittance : 0;
}

float skin_light_through_voxels(SkinLight *light, const Cone *cone, double t_max, double seen_from, Vec3 to_eye) {
    const CompiledScene *scene = light->compiled;
    float transmittance = 1;
    const Ray axis = {cone->origin, cone->direction};
    size_t met = compiled_skins_met(scene, &axis, t_max, light->met);
    for (size_t k = 0; k < met && transmittance > scene->dark_below; k++) {
        uint32_t i = light->met[k].skin;
        const CompiledSkin *skin = &scene->skins[i];
        if (skin->boxes && seen_from <= skin->exact_to) continue;
        SkinMarch *march = skin_marches_get(&light->marches, i, 0);
        skin_march_begin(march, cone, 0, t_max, &scene->shadow_march, light->counters, false);
        transmittance *= through_skin(light, march, to_eye);
    }
    return transmittance > scene->dark_below ? transmittance : 0;
}

float skin_light_on_matter(SkinLight *light, const Cone *cone, double t_max, uint32_t own, const SkinPoint *at, double tolerance, Vec3 to_eye) {
    SkinMarch *march = skin_marches_get(&light->marches, own, 0);
    double reach = skin_march_begin_around(march, cone, at, LIGHT_SURROUNDINGS, tolerance, t_max, &light->compiled->shadow_march, light->counters);
    LightSurroundings around = {.facing = light_facing((float)vec3_dot(to_eye, cone->direction))};
    float transmittance = 1, gamma_area = 0;
    SkinSegment s;
    while (skin_march_next(march, &s)) {
        double length = s.t1 - s.t0, within = double_max(0, double_min(s.t1, reach) - s.t0);
        around.depth += s.depth * (float)(within / length);
        around.area += s.area * (float)(within / length);
        gamma_area += s.gamma_area * (float)(within / length);
        if (s.t1 > 0) around.before += s.area * (float)(double_max(0, within - double_max(-s.t0, 0)) / length);
        if (s.t1 > reach) {
            transmittance = rest_of_march(light, march, expf(-s.depth * (float)(1 - within / length)));
            break;
        }
    }
    around.sheet = around.area > 0 ? float_clamp(gamma_area / (LIGHT_SHEET_GAMMA * around.area), 0, 1) : 0;
    return skin_joint_matter(march, to_eye, light_share(&around), transmittance);
}
