#include "render/beam_sky.h"

void sky_scratch_init(SkyScratch *scratch, uint32_t samples, Arena *arena) {
    *scratch = (SkyScratch){arena_new_room(arena, Vec3f, samples), arena_new_room(arena, float, samples), arena_new_room(arena, uint8_t, samples),
                            arena_new_room(arena, uint32_t, samples)};
}

/* Of a spiral with equal areas over a hemisphere; its other half is the opposites. */
static Vec3 sky_direction(int pair) {
    double height = (pair + 0.5) / SKY_PAIRS, turn = 2 * VTS_PI * 0.6180339887498949 * pair, r = sqrt(1 - height * height);
    return vec3(r * cos(turn), height, r * sin(turn));
}

Vec3 beam_sky_direction(int turn, Vec3f up) {
    Vec3 d = sky_direction(turn);
    return vec3f_dot(up, vec3f_from(d)) > 0 ? d : vec3_negate(d);
}

static void look_along(SkyScratch *scratch, ShadowScratch *shadow, const CompiledScene *compiled, const SkySamples *in, int pair, Vec3 d) {
    Vec3f direction = vec3f_from(d);
    uint32_t count = 0;
    for (uint32_t i = 0; i < in->count; i++) {
        if (in->turn[i] != pair || !(vec3f_dot(in->up[i], direction) > 0)) continue;
        float side = vec3f_dot(in->flat[i], direction) > 0 ? 1 : -1;
        scratch->points[count] = vec3f_madd(in->points[i], in->flat[i], side);
        scratch->distance[count] = in->distance[i];
        scratch->hidden[count] = 0;
        scratch->sample[count++] = i;
    }
    const Light light = {.kind = LIGHT_PARALLEL, .to_light = d};
    ShadowPoints points = {in->origin, scratch->points, scratch->distance, scratch->hidden, count};
    beam_shadow(shadow, compiled, &light, &points);
    for (uint32_t i = 0; i < count; i++) in->hidden[scratch->sample[i]] = scratch->hidden[i];
}

void beam_sky(SkyScratch *scratch, ShadowScratch *shadow, const CompiledScene *compiled, const SkySamples *samples) {
    for (uint32_t i = 0; i < samples->count; i++) samples->hidden[i] = 0;
    for (int pair = 0; pair < SKY_PAIRS; pair++) {
        Vec3 d = sky_direction(pair);
        look_along(scratch, shadow, compiled, samples, pair, d);
        look_along(scratch, shadow, compiled, samples, pair, vec3_negate(d));
    }
}
