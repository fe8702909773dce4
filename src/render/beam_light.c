#include "render/beam_sight.h"

#include "base/random.h"

#include <string.h>

static float luminance(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/* What the light would send to the eye if nothing were in its way. */
static Vec3f tone_of(const Sight *sight, const Light *light, LightRay *ray) {
    if (!light_shines_on(light, sight->look->texture->group)) return vec3f(0, 0, 0);
    *ray = light_ray(light, sight->point);
    NdfShade shade = sheet_shade(sight->normal, sight->view, vec3f_from(ray->direction), &sight->look->sheet);
    if (shade.diffuse <= 0 && shade.highlight <= 0) return vec3f(0, 0, 0);
    return light_tone(ray, &shade, sight->look, sight->color);
}

/* Puts the samples of a sight on the list of points whose shadows are wanted. */
static uint32_t add_points(BeamTracer *tr, const Sight *sight, const LightRay *ray, uint32_t count) {
    bool front = vec3f_dot(sight->flat, vec3f_from(ray->direction)) > 0;
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
        double t;
        Vec3f p = vec3f_from(vec3_sub(beam_sample_point(tr, (uint32_t)i, &t), tr->beam.origin));
        tr->points[count] = front ? vec3f_add(p, sight->bias) : vec3f_sub(p, sight->bias);
        tr->hidden[count] = 0;
        tr->distance[count] = (float)beam_faded_distance(tr, (uint32_t)i, t);
        count++;
    }
    return count;
}

/* What comes past explicit surfaces to a point of a sight. */
static Vec3f past_surfaces(BeamTracer *tr, const Sight *sight, const Light *light, const LightRay *way, uint32_t point) {
    double clear = (double)sight->clear, side = vec3f_dot(sight->flat, vec3f_from(way->direction)) > 0 ? clear : -clear;
    Ray shadow = {vec3_madd(vec3_add(tr->beam.origin, vec3_from_f(tr->points[point])), vec3_from_f(sight->flat), side), way->direction};
    if (tr->compiled->clear_shadows) {
        SurfaceTracer surfaces = {.compiled = tr->compiled, .counters = &tr->counters, .seed = tr->seed};
        Leg leg;
        surface_eye_leg(tr->compiled, &tr->cones[sight->pixel], &leg);
        return surface_shadow(&surfaces, light, way, &leg, shadow.origin, clear, random_mix(tr->seed + point));
    }
    tr->counters.shadow_rays++;
    bool hidden = hierarchy_occluded(tr->compiled->hierarchy, &shadow, clear, way->distance);
    return hidden ? vec3f(0, 0, 0) : vec3f(1, 1, 1);
}

static bool hidden_by_surfaces(BeamTracer *tr, const Sight *sight, const Light *light, const LightRay *way, uint32_t point) {
    return !(luminance(past_surfaces(tr, sight, light, way, point)) > 0);
}

enum { SOME_HIDDEN = 1, SOME_LIT = 2 };

/* One ray for each sight; all of its samples where that and the pixels around do not agree: there an edge of a shadow passes. */
static void hide_by_surfaces(BeamTracer *tr, const Light *light) {
    memset(tr->shade, 0, sizeof tr->shade);
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        if (!sight->asked) continue;
        LightRay ray = light_ray(light, sight->point);
        Vec3f past = past_surfaces(tr, sight, light, &ray, sight->begin);
        bool hidden = !(luminance(past) > 0);
        if (!hidden) sight->tone = vec3f_mul(sight->tone, past);
        memset(tr->hidden + sight->begin, hidden, (size_t)sight->count);
        tr->shade[sight->pixel] |= hidden ? SOME_HIDDEN : SOME_LIT;
    }
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        const Sight *sight = &tr->sights[k];
        if (!sight->asked || sight->count == 1) continue;
        int column = sight->pixel % tr->columns, row = sight->pixel / tr->columns;
        unsigned around = tr->shade[sight->pixel];
        if (column > 0) around |= tr->shade[sight->pixel - 1];
        if (column + 1 < tr->columns) around |= tr->shade[sight->pixel + 1];
        if (row > 0) around |= tr->shade[sight->pixel - tr->columns];
        if (row + 1 < tr->rows) around |= tr->shade[sight->pixel + tr->columns];
        if (around != (SOME_HIDDEN | SOME_LIT)) continue;
        LightRay ray = light_ray(light, sight->point);
        for (uint32_t i = 1; i < (uint32_t)sight->count; i++)
            tr->hidden[sight->begin + i] = hidden_by_surfaces(tr, sight, light, &ray, sight->begin + i);
    }
}

/* The share of light that voxels let through to a sight: of skins that have no exact geometry there. */
static float through_voxels(BeamTracer *tr, const Sight *sight, const LightRay *ray) {
    if (!sight->beyond) return 1;
    double t, seen_from = beam_faded_distance(tr, (uint32_t)sight->first, (double)sight->t);
    Cone cone = beam_sight_cone(tr, sight, &t);
    double aperture = tr->compiled->shadow_aperture, side = vec3f_dot(sight->flat, vec3f_from(ray->direction)) > 0 ? 1 : -1;
    Vec3 from = vec3_madd(cone_point(&cone, t), vec3_from_f(sight->bias), side);
    Cone shadow = {from, ray->direction, cone_diameter(&cone, t) * aperture, cone.spread * aperture};
    return skin_light_through_voxels(&tr->volumes.light, &shadow, ray->distance, seen_from, vec3_negate(cone.direction));
}

/* The share of a sight's points that are not hidden, of all and of those with odd numbers. */
static void shares_seen(const BeamTracer *tr, const Sight *sight, float *all, float *odd) {
    int hidden = 0, odd_hidden = 0;
    uint32_t at = sight->begin, first = tr->beam.samples.first[sight->pixel];
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i], at++) {
        hidden += tr->hidden[at];
        odd_hidden += (((uint32_t)i - first) & 1) ? tr->hidden[at] : 0;
    }
    *all = 1 - (float)hidden / (float)sight->count;
    *odd = sight->odd ? 1 - (float)odd_hidden / (float)sight->odd : *all;
}

/* Tones of all sights, without shadows, and the list of places whose shadows are wanted; returns how many. */
static uint32_t ask_light(BeamTracer *tr, const Light *light) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        sight->tone = vec3f(0, 0, 0);
        sight->begin = count;
        sight->asked = false;
        if (!sight->look) continue;
        LightRay ray;
        sight->tone = tone_of(sight, light, &ray);
        if (light_comes_everywhere(light) || !(luminance(sight->tone) > 0)) continue;
        count = add_points(tr, sight, &ray, count);
        sight->asked = true;
        sight->tone = vec3f_scale(sight->tone, through_voxels(tr, sight, &ray));
    }
    return count;
}

static void take_light(BeamTracer *tr) {
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        if (!(luminance(sight->tone) > 0)) continue;
        float seen = 1, odd_seen = 1;
        if (sight->asked) shares_seen(tr, sight, &seen, &odd_seen);
        sight->light = vec3f_madd(sight->light, sight->tone, seen);
        sight->odd_light = vec3f_madd(sight->odd_light, sight->tone, odd_seen);
    }
}

void beam_add_light(BeamTracer *tr, const Light *light) {
    uint32_t count = ask_light(tr, light);
    hide_by_surfaces(tr, light);
    ShadowPoints points = {.origin = tr->beam.origin, .points = tr->points, .distance = tr->distance, .hidden = tr->hidden, .count = count};
    beam_shadow(&tr->shadow, tr->compiled, light, &points);
    take_light(tr);
}

void beam_add_beyond(BeamTracer *tr) {
    if (!tr->compiled->secondary) return;
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *sight = &tr->sights[k];
        if (!sight->surface || sight->look->plain) continue;
        Vec3f sum = {0, 0, 0}, odd = {0, 0, 0};
        uint32_t first = tr->beam.samples.first[sight->pixel];
        for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
            BeamLine line = beam_sample_line(tr, (uint32_t)i);
            Cone cone = tr->cones[sight->pixel];
            cone.origin = line.origin;
            cone.direction = vec3_scale(line.direction, 1 / line.length);
            SurfaceHit hit;
            if (!hierarchy_intersect(tr->compiled->hierarchy, &(Ray){cone.origin, cone.direction}, 1e-9, VTS_INFINITY, &hit)) continue;
            tr->volumes.seed = random_hash((uint64_t)(tr->x0 + sight->pixel % tr->columns), (uint64_t)(tr->y0 + sight->pixel / tr->columns),
                                           3 + (uint64_t)tr->allotment.taken[sight->pixel] + (uint32_t)i - first, tr->seed);
            tr->volumes.part = 1.0 / beam_samples_of(tr, sight->pixel);
            SurfaceTracer surfaces = tracer_of_surfaces(&tr->volumes);
            Leg leg;
            surface_eye_leg(tr->compiled, &cone, &leg);
            Vec3f one = surface_beyond(&surfaces, &leg, &hit);
            sum = vec3f_add(sum, one);
            if (((uint32_t)i - first) & 1) odd = vec3f_add(odd, one);
        }
        sight->light = vec3f_madd(sight->light, sum, 1 / (float)sight->count);
        if (sight->odd) sight->odd_light = vec3f_madd(sight->odd_light, odd, 1 / (float)sight->odd);
    }
}
