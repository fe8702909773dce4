#include "render/beam_sight.h"

#include "base/random.h"
#include "render/beam_afford.h"
#include "render/beam_rigid.h"
#include "render/beam_settle.h"
#include "render/volume_set.h"

#include <string.h>

/* How far triangles may leave what the mapping makes of them, in pixels: as samples are fewer, their noise hides more; and so much for an error that is asked for. Of
 * grass in gusts (bench/charts/gusts.vts) edges that are bent by up to a sixteenth of a pixel make an RMSE of 0.005, up to a thirtieth 0.003. */
static const double LEAST_TOLERANCE = 0.02, MOST_TOLERANCE = 1, TOLERANCE_AN_ERROR = 15;
static double tolerance_for(const AllotPlan *plan, double max_error) {
    const bool asked = plan->first < plan->most;
    const double noise_hides = 1 / pow(asked ? 4 * plan->first : plan->first, 0.75);
    return double_clamp(asked ? fmin(noise_hides, TOLERANCE_AN_ERROR * max_error) : noise_hides, LEAST_TOLERANCE, MOST_TOLERANCE);
}

static void samples_init(BeamSamples *s, size_t all, Arena *arena) {
    s->first = arena_new_room(arena, uint32_t, BEAM_TILE * BEAM_TILE + 1);
    s->x = arena_new_room(arena, float, all);
    s->y = arena_new_room(arena, float, all);
    s->key = arena_new_room(arena, float, all);
    s->limit = arena_new_room(arena, float, all);
    s->mark = arena_new_room(arena, uint32_t, all);
}

static void draft_init(BeamTracer *tr, size_t all, Arena *arena) {
    const View *view = &tr->compiled->view;
    BeamDraft *draft = &tr->draft;
    draft->facet_capacity = (uint32_t)(all + 64);
    draft->facets = arena_new_room(arena, BeamFacet, draft->facet_capacity);
    draft->renumber = arena_new_room(arena, uint32_t, draft->facet_capacity + 1);
    draft->cells = arena_new_room(arena, BeamCell, beam_most_cells(tr->compiled));
    Cone middle = view_cone(view, view->width / 2.0, view->height / 2.0, 1);
    draft->eye = view->camera.location;
    draft->width = middle.width;
    draft->spread = middle.spread;
    draft->tolerance = tolerance_for(&tr->plan.samples, tr->compiled->max_error);
    draft->beam = &tr->beam;
    draft->interrupted = tr->plan.interrupted;
}

static void sky_init(BeamTracer *tr, size_t all, Arena *arena) {
    sky_scratch_init(&tr->sky, (uint32_t)all, arena);
    tr->sky_up = arena_new_room(arena, Vec3f, all);
    tr->sky_flat = arena_new_room(arena, Vec3f, all);
    tr->sky_turn = arena_new_room(arena, uint8_t, all);
}

/* More where an error is asked for that takes many, for their room is memory; but hits that may have several looks take four times the room. */
static const double IN_PASS_AN_ERROR = 0.08;
int beam_most_in_pass(const CompiledScene *compiled) {
    enum { FEW = 32, MANY = 64 };
    return hierarchy_blends(compiled->hierarchy) ? FEW : (int)double_clamp(IN_PASS_AN_ERROR / compiled->max_error, FEW, MANY);
}

BeamTracer *beam_tracer_create(const CompiledScene *compiled, const BeamPlan *plan, uint64_t seed, Arena *arena) {
    BeamTracer *tr = arena_new(arena, BeamTracer);
    const size_t hit_size = beam_hit_room(hierarchy_blends(compiled->hierarchy) ? LOOK_SHARES : 0);
    tr->most_in_pass = int_min(plan->samples.most, beam_most_in_pass(compiled));
    const size_t all = (size_t)tr->most_in_pass * BEAM_TILE * BEAM_TILE;
    tr->compiled = compiled;
    tr->plan = *plan;
    tr->seed = seed;
    bool sky = compiled->scene->settings.sky_light && compiled->voxels;
    if (!isinf(compiled->all_exact_to) || compiled->secondary || sky) tracer_init(&tr->volumes, compiled, arena);
    samples_init(&tr->beam.samples, all, arena);
    draft_init(tr, all, arena);
    tr->bounded = hierarchy_bounds(compiled->hierarchy, &tr->explicit_bounds);
    shadow_scratch_init(&tr->shadow, (uint32_t)all, arena);
    tr->shadow.draft = tr->draft; /* which cuts triangles alike, */
    tr->shadow.draft.facets = NULL; /* and keeps nothing */
    tr->surfaces = arena_new_room(arena, SeenSurface, all);
    tr->sample_hits.bytes = arena_push_room_(arena, all, hit_size);
    tr->pixel_hits.bytes = arena_push_room_(arena, VTS_ARRAY_COUNT(tr->pixels), hit_size);
    tr->fade = arena_new_room(arena, float, all);
    tr->surface = arena_new_room(arena, int32_t, all);
    tr->next = arena_new_room(arena, int32_t, all);
    tr->points = arena_new_room(arena, Vec3f, all);
    tr->hidden = arena_new_room(arena, uint8_t, all);
    tr->distance = arena_new_room(arena, float, all);
    tr->sights = arena_new_room(arena, Sight, all);
    if (compiled->scene->settings.sky_light) sky_init(tr, all, arena);
    return tr;
}

BeamWork beam_tracer_work(const BeamTracer *tr) {
    return (BeamWork){.triangles = tr->draft.triangles + tr->shadow.draft.triangles, .nodes = tr->draft.nodes + tr->shadow.draft.nodes,
                      .rays = tr->counters.camera_rays + tr->counters.shadow_rays + tr->shadow.rays, .samples = tr->sample_count, .sights = tr->shaded_count,
                      .steps = tr->volumes.counters.steps};
}

void beam_tracer_count(const BeamTracer *tr, TraceCounters *sum) {
    trace_counters_add(sum, &tr->counters);
    sum->shadow_rays += tr->shadow.rays;
    sum->triangles += tr->draft.triangles + tr->shadow.draft.triangles;
    trace_counters_add(sum, &tr->volumes.counters);
}
/* ---- skins ---- */

/* How many parts of a pixel each way hold a few samples each, where it has some. */
static int parts_of_pixels(const BeamTracer *tr) {
    enum { SAMPLES_IN_PART = 4, MOST_PARTS = MOST_BINS_ACROSS / BEAM_TILE };
    int samples = 0, pixels = 0;
    for (int i = 0; i < tr->columns * tr->rows; i++) samples += tr->allotment.asked[i], pixels += tr->allotment.asked[i] > 0;
    return int_clamp((int)ceil(sqrt((double)samples / (SAMPLES_IN_PART * int_max(pixels, 1)))), 1, MOST_PARTS);
}

/* Pixels of many samples are cut in parts of a few each. */
static void draw_in_parts(BeamTracer *tr, uint32_t cells) {
    if (cells == 0) return;
    Beam parted = tr->beam;
    beam_part(&parted, parts_of_pixels(tr), &tr->shadow.bins);
    tr->draft.beam = &parted;
    beam_draw_cells(&tr->draft, tr->compiled, cells);
    tr->draft.beam = &tr->beam;
    beam_join(&parted, &tr->shadow.bins, &tr->beam);
}

static void draw_skins(BeamTracer *tr, uint32_t cells) {
    BeamSamples *s = &tr->beam.samples;
    uint32_t count = s->first[tr->columns * tr->rows];
    tr->draft.facet_count = 0;
    if (!tr->beam.perspective) { /* everything is as wide: a skin is exact as a whole, or voxels */
        for (uint32_t i = 0; i < count; i++) s->limit[i] = -INFINITY;
    } else if (isfinite(tr->compiled->all_exact_to)) {
        for (uint32_t i = 0; i < count; i++) s->limit[i] = (float)beam_line_at(tr, (double)s->x[i], (double)s->y[i]).length / tr->fade[i];
    } else {
        memset(s->limit, 0, count * sizeof *s->limit);
    }
    if (tr->compiled->rigid)
        tr->counters.camera_rays += rigid_see(tr->compiled->rigid, &tr->draft, tr->corner, tr->right, tr->down, tr->compiled->view.camera.direction);
    draw_in_parts(tr, cells);
}

/* Of what volumes ask for the light that comes to them. */
static SurfaceTracer air_tracer(BeamTracer *tr) {
    if (tr->compiled->volumes) return tracer_of_surfaces(&tr->volumes);
    return (SurfaceTracer){.compiled = tr->compiled};
}

/* Whether there is nothing else in the tile, which no cell of a skin is in. */
static bool is_sky(const BeamTracer *tr) {
    if (!tr->bounded || beam_meets_box(&tr->beam, &tr->explicit_bounds) || !isinf(tr->compiled->all_exact_to)) return false;
    return !tr->compiled->rigid || !rigid_meets(tr->compiled->rigid, &tr->beam);
}

static void aim_cones(BeamTracer *tr) {
    Cone *cone = tr->cones;
    for (int y = 0; y < tr->rows; y++)
        for (int x = 0; x < tr->columns; x++) *cone++ = view_cone(&tr->compiled->view, tr->x0 + x + 0.5, tr->y0 + y + 0.5, 1);
}

static Radiance sky_along(const Scene *scene, const Cone *cone, const Air *air) {
    return (Radiance){air_over(air, sky_radiance(scene, cone->direction, cone->spread), 1), air->cover};
}

/* Where nothing depends on directions nobody asks for them. */
static void see_sky(BeamTracer *tr, Radiance *out) {
    const Scene *scene = tr->compiled->scene;
    const int pixels = tr->columns * tr->rows;
    const bool even = scene->sky_layer_count == 0 && air_is_clear(tr->compiled);
    SurfaceTracer surfaces = air_tracer(tr);
    if (!even) aim_cones(tr);
    Air air = air_clear();
    const Radiance all = even ? sky_along(scene, &(Cone){.width = 0}, &air) : (Radiance){.alpha = 0};
    for (int i = 0; i < pixels; i++) {
        if (!even) air = air_from_eye(&surfaces, &tr->cones[i], VTS_INFINITY);
        out[i] = even ? all : sky_along(scene, &tr->cones[i], &air);
        if (tr->aovs) tr->aovs[i].samples = 1;
    }
}

/* ---- pixels ---- */

/* Where skins' voxels begin for the samples of a sight. */
static ConeStart starts_of(const BeamTracer *tr, const Sight *sight) {
    float count[MOST_CONE_STARTS] = {0}, sum[MOST_CONE_STARTS] = {0};
    for (int i = sight->first; i != BEAM_NOTHING; i = tr->next[i]) {
        int at = int_clamp((int)(((double)tr->fade[i] / BEAM_LEAST_FADE - 1) * MOST_CONE_STARTS), 0, MOST_CONE_STARTS - 1);
        count[at] += 1;
        sum[at] += tr->fade[i];
    }
    ConeStart start = {.count = 0};
    for (int at = 0; at < MOST_CONE_STARTS; at++) {
        if (!(count[at] > 0)) continue;
        start.share[start.count] = count[at] / (float)sight->count;
        start.factor[start.count++] = sum[at] / count[at];
    }
    return start;
}

static AovSample aov_of_sight(const Sight *s) {
    AovSample seen = {.share = 1, .depth = (double)s->t, .position = s->point, .normal = s->normal, .albedo = s->color, .level = -1};
    if (!s->surface) return seen;
    seen.object = s->surface->number;
    seen.u = (float)s->surface->uv.u, seen.v = (float)s->surface->uv.v;
    return seen;
}

/* Of `transmittance` of its samples it is what lies behind voxels. */
static void see_aovs(BeamTracer *tr, const Sight *sight, const MatterAov *met, float transmittance) {
    AovSum *sum = &tr->aovs[sight->pixel];
    AovSample seen = sight->look ? aov_of_sight(sight) : (AovSample){.share = 0};
    AovSample matter = matter_sum_end(met, &tr->cones[sight->pixel]);
    seen.share *= transmittance;
    aov_add(sum, &matter, sight->count);
    aov_add(sum, &seen, sight->count);
    sum->samples += sight->count;
}

/* A sight is a part of its pixel: at a horizon, the one above it. */
static Vec3f sky_seen(const BeamTracer *tr, const Sight *sight) {
    Cone cone = tr->cones[sight->pixel];
    double part = sqrt((double)sight->count / tr->allotment.asked[sight->pixel]), t;
    if (sight->count < tr->allotment.asked[sight->pixel]) cone = beam_sight_cone(tr, sight, &t);
    return sky_radiance(tr->compiled->scene, cone.direction, part * cone.spread);
}

/* What a sight sends through fog and voxels, to all of its samples and to the odd ones. */
static void see_sight(BeamTracer *tr, const Sight *sight, Radiance *all, Vec3f *odd) {
    Cone cone = tr->cones[sight->pixel];
    double t = sight->look ? (double)sight->t : VTS_INFINITY;
    Vec3f sky = {0, 0, 0};
    if (!sight->look) sky = sky_seen(tr, sight);
    SurfaceTracer surfaces = air_tracer(tr);
    Air air = air_from_eye(&surfaces, &cone, t);
    *all = (Radiance){air_over(&air, sight->look ? sight->light : sky, 1), sight->look ? 1 : air.cover};
    *odd = air_over(&air, sight->look ? sight->odd_light : sky, 1);
    MatterAov met = {.share = 0};
    if (!sight->beyond) {
        if (tr->aovs) see_aovs(tr, sight, &met, 1);
        return;
    }
    ConeStart start = starts_of(tr, sight);
    cone = beam_sight_cone(tr, sight, &t);
    float transmittance;
    tr->volumes.matter = tr->aovs ? &met : NULL;
    tr->volumes.seed = random_hash((uint64_t)(tr->x0 + sight->pixel % tr->columns), (uint64_t)(tr->y0 + sight->pixel / tr->columns), 1, tr->seed);
    Vec3f matter = trace_skins(&tr->volumes, &cone, &start, t, &transmittance);
    if (tr->aovs) see_aovs(tr, sight, &met, transmittance);
    all->color = vec3f_madd(matter, all->color, transmittance);
    all->alpha = 1 - transmittance * (1 - all->alpha);
    *odd = vec3f_madd(matter, *odd, transmittance);
}

static float clamped_difference(Vec3f a, Vec3f b) {
    float x = float_clamp(a.x, 0, 1) - float_clamp(b.x, 0, 1), y = float_clamp(a.y, 0, 1) - float_clamp(b.y, 0, 1);
    float z = float_clamp(a.z, 0, 1) - float_clamp(b.z, 0, 1);
    return (x * x + y * y + z * z) / 3;
}

/* What a pass has seen of one pixel, summed over its samples. */
typedef struct PixelSum {
    Vec3f all, odd;
    float alpha;
} PixelSum;

/* How wrong voxels make a pixel of which the sight is a part: relative to all of its samples. */
static double voxels_error(const BeamTracer *tr, const Sight *sight) {
    const CompiledScene *compiled = tr->compiled;
    if (!sight->beyond || !(compiled->voxel_error > 0)) return 0;
    double nearer = compiled->all_exact_to / fmax((double)sight->t, compiled->all_exact_to);
    return compiled->voxel_error * nearer * sight->count / tr->allotment.asked[sight->pixel];
}

/* Sights come pixel by pixel; *k is the first of this one's, and becomes that of the next. */
static PixelSum see_pixel(BeamTracer *tr, int pixel, uint32_t *k) {
    PixelSum sum = {{0, 0, 0}, {0, 0, 0}, 0};
    double wrong = 0;
    for (; *k < tr->sight_count && tr->sights[*k].pixel == pixel; ++*k) {
        const Sight *s = &tr->sights[*k];
        Radiance seen;
        Vec3f odd;
        see_sight(tr, s, &seen, &odd);
        sum.all = vec3f_madd(sum.all, seen.color, (float)s->count);
        sum.odd = vec3f_madd(sum.odd, odd, (float)s->odd);
        sum.alpha += seen.alpha * (float)s->count;
        wrong += voxels_error(tr, s);
    }
    if (tr->first_pass) tr->squared_error += wrong * wrong;
    return sum;
}

/* The square of how far the means of a pixel's odd and even samples are apart. */
static float halves_apart(const PixelSum *sum, int samples) {
    float odds = (float)(samples / 2), evens = (float)samples - odds;
    if (!(odds > 0)) return 0;
    return clamped_difference(vec3f_scale(sum->odd, 1 / odds), vec3f_scale(vec3f_sub(sum->all, sum->odd), 1 / evens));
}

/* Adds what the pass has seen to the means so far; tells how far the halves of each pixel's samples are apart. */
static void take_pixels(BeamTracer *tr, Radiance *out, float *apart) {
    int pixels = tr->columns * tr->rows;
    uint32_t k = 0;
    for (int pixel = 0; pixel < pixels; pixel++) {
        int asked = tr->allotment.asked[pixel];
        apart[pixel] = 0;
        if (!asked) continue;
        PixelSum sum = see_pixel(tr, pixel, &k);
        Radiance *mean = &out[pixel];
        float share = 1 / (float)beam_samples_of(tr, pixel), before = (float)tr->allotment.taken[pixel] * share;
        mean->color = vec3f_madd(vec3f_scale(mean->color, before), sum.all, share);
        mean->alpha = mean->alpha * before + sum.alpha * share;
        apart[pixel] = halves_apart(&sum, asked);
        tr->sample_count += (uint64_t)asked;
    }
}

static void see_pass(BeamTracer *tr, Radiance *out, float *apart) {
    const Scene *scene = tr->compiled->scene;
    uint32_t cells = beam_gather(&tr->draft, tr->compiled);
    beam_lay_samples(tr);
    beam_see_surfaces(tr);
    draw_skins(tr, cells);
    beam_gather_sights(tr);
    tr->shaded_count += tr->sight_count;
    beam_add_ambient(tr);
    for (size_t l = 0; l < scene->light_count; l++) beam_add_light(tr, &scene->lights[l]);
    beam_add_beyond(tr);
    take_pixels(tr, out, apart);
}

void beam_tile(BeamTracer *tr, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs) {
    const int pixels = (x1 - x0) * (y1 - y0);
    float apart[BEAM_TILE * BEAM_TILE];
    tr->x0 = x0, tr->y0 = y0, tr->columns = x1 - x0, tr->rows = y1 - y0;
    tr->aovs = aovs;
    beam_aim(tr);
    tr->pixel_count += (uint64_t)pixels;
    tr->tile_noise = 0;
    if (beam_gather(&tr->draft, tr->compiled) == 0 && is_sky(tr)) {
        see_sky(tr, out);
        return;
    }
    aim_cones(tr);
    memset(out, 0, (size_t)pixels * sizeof *out);
    allot_begin(&tr->allotment, &tr->plan.samples, tr->columns, tr->rows, tr->most_in_pass);
    tr->first_pass = true;
    double fixed;
    do {
        const BeamWork before = beam_tracer_work(tr);
        if (!tr->first_pass) beam_aim(tr); /* drawing has narrowed the beam */
        see_pass(tr, out, apart);
        tr->first_pass = false;
        const BeamWork after = beam_tracer_work(tr);
        fixed = beam_price_in_samples(&before, &after);
    } while (allot_next(&tr->allotment, &tr->plan.samples, apart, tr->most_in_pass, fixed) && !beam_is_interrupted(&tr->draft));
    /* samples that somebody counts are left as they are */
    tr->tile_noise = tr->plan.samples.worth > 0 ? beam_settle(&tr->allotment, out) : allot_error(&tr->allotment);
    tr->squared_noise += tr->tile_noise * pixels;
}

double beam_tracer_error(const BeamTracer *tr, uint64_t *pixels) {
    *pixels = tr->pixel_count;
    return tr->squared_error + tr->squared_noise;
}

double beam_tracer_noise(const BeamTracer *tr) { return tr->squared_noise; }
double beam_tile_noise(const BeamTracer *tr) { return tr->tile_noise; }
