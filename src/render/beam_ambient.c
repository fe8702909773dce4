/* Ambient and emitted light of what beams show; under a sky, the share of it that each sight sees. */
#include "render/beam_sight.h"

#include "base/random.h"

static float grey_of(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
static float most_of(Vec3f c) { return float_max(c.x, float_max(c.y, c.z)); }

/* What a sight sees of the sky: all of its samples, and those with odd numbers. */
typedef struct SkyShares {
    Vec3f all, odd;
} SkyShares;

/* Whether the directions of the sky are asked for sample by sample: where nothing knows the skins but their triangles. */
static bool by_samples(const BeamTracer *tr, const Sight *sight) {
    return tr->compiled->scene->settings.sky_light && sight->look && sight->sky < 0 && !(sight->surface && tr->compiled->voxels);
}

/* Of the hemisphere that it looks at. */
static Vec3f middle_of(const Sight *sight) { return sight->surface ? sight->normal : sight->up; }

static uint8_t turn_of(const BeamTracer *tr, const Sight *sight, int sample) {
    uint32_t first = tr->beam.samples.first[sight->pixel];
    uint64_t x = (uint64_t)(tr->x0 + sight->pixel % tr->columns), y = (uint64_t)(tr->y0 + sight->pixel / tr->columns);
    uint32_t turn = (uint32_t)random_hash(x, y, 2, tr->seed);
    return (uint8_t)((turn + (uint32_t)tr->allotment.taken[sight->pixel] + (uint32_t)sample - first) % SKY_PAIRS);
}

static uint32_t add_points(BeamTracer *tr, const Sight *sight, uint32_t count) {
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i], count++) {
        double t;
        tr->points[count] = vec3f_from(vec3_sub(beam_sample_point(tr, (uint32_t)i, &t), tr->beam.origin));
        tr->distance[count] = (float)beam_faded_distance(tr, (uint32_t)i, t);
        tr->sky_up[count] = middle_of(sight);
        tr->sky_flat[count] = sight->bias;
        tr->sky_turn[count] = turn_of(tr, sight, i);
    }
    return count;
}

static void ask_triangles(BeamTracer *tr) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        tr->sights[k].begin = count;
        if (by_samples(tr, &tr->sights[k]) && vec3f_length(middle_of(&tr->sights[k])) > 0) count = add_points(tr, &tr->sights[k], count);
    }
    SkySamples samples = {tr->beam.origin, tr->points, tr->sky_up, tr->sky_flat, tr->distance, tr->sky_turn, tr->hidden, count};
    if (count) beam_sky(&tr->sky, &tr->shadow, tr->compiled, &samples);
}

/* What comes past explicit surfaces to a point along d. */
static float open_to(BeamTracer *tr, const Sight *sight, uint32_t point, Vec3 d, const Leg *leg) {
    SurfaceTracer surfaces = {.compiled = tr->compiled, .counters = &tr->counters, .seed = tr->seed};
    double side = vec3_dot(vec3_from_f(sight->flat), d) > 0 ? (double)sight->clear : -(double)sight->clear;
    Ray ray = {vec3_madd(vec3_add(tr->beam.origin, vec3_from_f(tr->points[point])), vec3_from_f(sight->flat), side), d};
    return grey_of(surface_open(&surfaces, &ray, VTS_INFINITY, leg, (double)sight->clear));
}

/* Of what is open past explicit surfaces the share that passes triangles of skins. Matter gets light from all directions alike, surfaces by the cosine. */
static void past_triangles(BeamTracer *tr, const Sight *sight, float *all, float *odd) {
    float seen[2] = {0, 0}, asked[2] = {0, 0};
    uint32_t at = sight->begin, first = tr->beam.samples.first[sight->pixel];
    Leg leg;
    surface_leg(&tr->cones[sight->pixel], &leg);
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i], at++) {
        Vec3 d = beam_sky_direction(tr->sky_turn[at], middle_of(sight));
        float weight = sight->surface ? vec3f_dot(sight->normal, vec3f_from(d)) : 1;
        int k = ((uint32_t)i - first) & 1;
        if (sight->surface && !(vec3f_dot(sight->flat, vec3f_from(d)) * vec3f_dot(sight->flat, sight->normal) > 0)) continue;
        weight *= open_to(tr, sight, at, d, &leg);
        asked[k] += weight;
        if (!tr->hidden[at]) seen[k] += weight;
    }
    *all = asked[0] + asked[1] > 0 ? (seen[0] + seen[1]) / (asked[0] + asked[1]) : 1;
    *odd = asked[1] > 0 ? seen[1] / asked[1] : *all;
}

/* What comes past explicit surfaces, and for these past voxels; `known`: the share that the rest leaves of it. */
static Vec3f share_of_place(BeamTracer *tr, const Sight *sight, float known) {
    SurfaceTracer surfaces = {.compiled = tr->compiled, .counters = &tr->counters};
    uint64_t x = (uint64_t)(tr->x0 + sight->pixel % tr->columns), y = (uint64_t)(tr->y0 + sight->pixel / tr->columns);
    float worth = known * most_of(vec3f_mul(sight->look->ambient, sight->color));
    Vec3 side = vec3_from_f(vec3f_dot(sight->flat, sight->view) < 0 ? vec3f_scale(sight->flat, -1) : sight->flat);
    Leg leg;
    surface_leg(&tr->cones[sight->pixel], &leg);
    SkyPlace place = {.flat = side, .normal = vec3_from_f(sight->normal), .clear = (double)sight->clear, .leg = &leg};
    place.point = vec3_madd(sight->point, side, place.clear);
    if (!sight->surface) place.flat = place.normal = vec3_from_f(sight->up), place.even = true;
    else if (tr->compiled->voxels) surfaces = tracer_of_surfaces(&tr->volumes);
    surfaces.part = (double)sight->count / beam_samples_of(tr, sight->pixel);
    return surface_sky(&surfaces, &place, worth, random_hash(x, y, 5 + (uint64_t)tr->allotment.taken[sight->pixel], tr->seed));
}

static SkyShares sky_seen(BeamTracer *tr, const Sight *sight) {
    float all = sight->sky >= 0 ? sight->sky : 1, odd = all;
    if (!tr->compiled->scene->settings.sky_light || !(vec3f_length(middle_of(sight)) > 0)) return (SkyShares){vec3f(all, all, all), vec3f(odd, odd, odd)};
    if (by_samples(tr, sight)) past_triangles(tr, sight, &all, &odd);
    Vec3f open = share_of_place(tr, sight, all);
    return (SkyShares){vec3f_scale(open, all), vec3f_scale(open, odd)};
}

void beam_add_ambient(BeamTracer *tr) {
    ask_triangles(tr);
    for (uint32_t k = 0; k < tr->sight_count; k++) {
        Sight *s = &tr->sights[k];
        if (!s->look) continue;
        SkyShares seen = sky_seen(tr, s);
        s->light = vec3f_mul(vec3f_add(s->look->emission, vec3f_mul(s->look->ambient, seen.all)), s->color);
        s->odd_light = vec3f_mul(vec3f_add(s->look->emission, vec3f_mul(s->look->ambient, seen.odd)), s->color);
    }
}
