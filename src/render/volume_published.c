#include "render/volume_published.h"

#include "render/volume_bins.h"
#include "render/volume_shoot.h"

#include <string.h>

/* Rays of `rays auto` are as many as the paper's. What a batch may do ends all of a kind: rays that nothing absorbs walk for ever. */
enum { AUTO_RAYS = 2000000, MOST_BATCHES = 8, MOST_STEPS_OF_RAY = 100000 };
static const uint64_t MOST_STEPS = 300000000;
static const double MOST_RAYS = 1 << 26, MOST_NUMBERS = 48e6;
/* Of what a ray began with, and of what the eye would see: the paper's THRESHOLD, which it leaves open. */
static const double THRESHOLD = 1e-3;

/* An elementary source: a disc. Rays start on it and go towards the ball around the volumes. */
typedef struct Disc {
    const Light *light;
    Vec3 middle, side, up; /* half axes of the disc */
    bool parallel;
    double least_cosine; /* of the angle to the ball's middle; -1: all around */
    double share;        /* irradiance of a light of colour 1 in the middle of the volumes, on the area that all rays cross there; over 4 pi */
} Disc;

typedef struct Publishing {
    CompiledScene *compiled;
    const VolumeSet *set;
    Disc *discs;
    size_t disc_count;
    size_t *first_bin; /* of each volume in a batch */
    size_t batch_size, batch_count;
    float (*batches)[3];
    uint64_t *shot; /* rays of each batch */
    double rays, step, radius;
    Vec3 middle;
} Publishing;

/* ---- sources ---- */

static Disc disc_of(const Publishing *p, const Light *light, const int at[2], const int counts[2]) {
    double area = vec3_length(vec3_cross(light->axis_u, light->axis_v)) / (counts[0] * counts[1]);
    Disc d = {.light = light, .parallel = light_is_parallel(light), .least_cosine = -1};
    d.middle = light_is_area(light) ? light_member(light, p->middle, at, counts) : light->location;
    Vec3 to = vec3_sub(p->middle, d.middle), axis = vec3_cross(light->axis_u, light->axis_v);
    double distance = vec3_length(to), radius = light_is_area(light) ? sqrt(area / VTS_PI) : 0, beam;
    if (light->orient || !(vec3_length(axis) > 0)) axis = to;
    if (d.parallel) axis = light->to_light, radius = p->radius, d.middle = vec3_madd(p->middle, light->to_light, p->radius);
    vec3_frame(vec3_length(axis) > 0 ? vec3_normalize(axis) : vec3(0, 1, 0), &d.side, &d.up);
    d.side = vec3_scale(d.side, radius), d.up = vec3_scale(d.up, radius);
    if (d.parallel) {
        beam = VTS_PI * radius * radius;
    } else {
        double reach = p->radius + radius;
        if (distance > reach) d.least_cosine = sqrt(1 - reach * reach / (distance * distance));
        distance = double_max(distance, p->radius);
        /* 1 - cosine, where that would cancel */
        double rest = d.least_cosine > 0 ? reach * reach / (distance * distance) / (1 + d.least_cosine) : 2;
        beam = 2 * VTS_PI * rest * distance * distance;
    }
    d.share = VOLUME_IRRADIANCE * beam / (4 * VTS_PI) / (counts[0] * counts[1]);
    return d;
}

static void find_discs(Publishing *p, Arena *arena) {
    const Scene *scene = p->compiled->scene;
    size_t count = 0;
    for (size_t l = 0; l < scene->light_count; l++) {
        const Light *light = &scene->lights[l];
        count += light_is_area(light) ? (size_t)int_max(1, light->size_u) * (size_t)int_max(1, light->size_v) : 1;
    }
    p->discs = arena_new_array(arena, Disc, count);
    for (size_t l = 0; l < scene->light_count; l++) {
        const Light *light = &scene->lights[l];
        bool area = light_is_area(light);
        const int counts[2] = {area ? int_max(1, light->size_u) : 1, area ? int_max(1, light->size_v) : 1};
        if (!light_shines_on(light, NULL)) continue;
        for (int at[2] = {0, 0}; at[1] < counts[1]; at[1]++)
            for (at[0] = 0; at[0] < counts[0]; at[0]++) p->discs[p->disc_count++] = disc_of(p, light, at, counts);
    }
}

static Vec3 in_cone(Vec3 axis, double least_cosine, RandomStream *random) {
    double mu = 1 - random_next_unit(random) * (1 - least_cosine);
    return phase_turn(axis, mu, random_next_unit(random));
}

static Ray ray_from(const Publishing *p, const Disc *d, RandomStream *random) {
    double r = sqrt(random_next_unit(random)), turn = 2 * VTS_PI * random_next_unit(random);
    Vec3 place = vec3_madd(vec3_madd(d->middle, d->side, r * cos(turn)), d->up, r * sin(turn));
    if (d->parallel) return (Ray){place, vec3_negate(d->light->to_light)};
    Vec3 to = vec3_sub(p->middle, place);
    return (Ray){place, in_cone(vec3_length(to) > 0 ? vec3_normalize(to) : vec3(0, 1, 0), d->least_cosine, random)};
}

/* What a ray of the disc brings: a lamp's beam may be narrow, and fall off with distance. */
static void radiance_of(const Publishing *p, const Disc *d, const Ray *ray, double out[3]) {
    double distance = double_max(p->radius, vec3_length(vec3_sub(p->middle, d->middle)));
    LightRay way = light_ray_from(d->light, vec3_madd(ray->origin, ray->direction, distance), ray->origin);
    out[0] = d->share * (double)way.color.x, out[1] = d->share * (double)way.color.y, out[2] = d->share * (double)way.color.z;
}

/* ---- a ray of the first pass ---- */

static double mean_of(const double c[3]) { return (c[0] + c[1] + c[2]) / 3; }

/* The share of light that is scattered evenly: the r of the paper. */
static double even_share(const Phase *phase) {
    double sum = 0;
    for (int i = 0; i < phase->count; i++) sum += phase->lobes[i].kind == PHASE_ISOTROPIC || phase->lobes[i].k == 0 ? phase->lobes[i].weight : 0;
    return sum;
}

/* The cosine of a turn by all the others; there must be some. */
static double draw_turn(const Phase *phase, RandomStream *random) {
    Phase rest = {.count = 0};
    double sum = 0;
    for (int i = 0; i < phase->count; i++) {
        const PhaseLobe *lobe = &phase->lobes[i];
        if (lobe->kind == PHASE_ISOTROPIC || (lobe->kind != PHASE_RAYLEIGH && lobe->k == 0)) continue;
        rest.lobes[rest.count++] = *lobe;
        sum += lobe->weight;
    }
    return phase_draw(&rest, random_next_unit(random) * sum, random_next_unit(random));
}

/* What is at a place: the voxel of one of the volumes, drawn by how much each scatters, and the sums of all. */
typedef struct Here {
    const CompiledVolume *volume;
    size_t voxel; /* in a batch */
    double scattering, absorption[3];
} Here;

static bool voxel_at(const CompiledVolume *v, Vec3 point, size_t *out) {
    const int *n = v->light->bins;
    const Vec3 unit = volume_unit(v, point);
    size_t bin = 0;
    for (int k = 2; k >= 0; k--) {
        double x = vec3_get(unit, k) * n[k];
        if (!(x >= 0 && x < n[k])) return false;
        bin = bin * (size_t)n[k] + (size_t)x;
    }
    *out = bin;
    return true;
}

static Here look(const Publishing *p, Vec3 point, RandomStream *random) {
    Here here = {.volume = NULL};
    for (size_t i = 0; i < p->set->count; i++) {
        const CompiledVolume *v = &p->set->items[i];
        size_t voxel;
        if (!voxel_at(v, point, &voxel) || !(v->light->density[voxel] > 0)) continue;
        double density = (double)v->light->density[voxel], scattering = density * mean_of(v->scattering);
        here.scattering += scattering;
        for (int c = 0; c < 3; c++) here.absorption[c] += density * v->absorption[c];
        if (!here.volume || random_next_unit(random) * here.scattering < scattering) here.volume = v, here.voxel = p->first_bin[i] + voxel;
    }
    return here;
}

static void store(float (*bins)[3], size_t voxel, const double radiance[3], double share) {
    for (int c = 0; c < 3; c++) bins[voxel][c] += (float)(share * radiance[c]);
}

/* At an interception: the even part stays (eq. 8's albedo in it), the rest goes on in another direction. */
static void intercept(const Here *here, float (*bins)[3], double radiance[3], Ray *ray, Vec3 point, RandomStream *random) {
    const CompiledVolume *v = here->volume;
    double even = even_share(&v->phase);
    for (int c = 0; c < 3; c++) {
        double all = v->scattering[c] + v->absorption[c];
        radiance[c] *= all > 0 ? v->scattering[c] / all : 0;
    }
    store(bins, here->voxel, radiance, even);
    for (int c = 0; c < 3; c++) radiance[c] *= even < 1 - 1e-9 ? 1 - even : 0;
    if (even < 1 - 1e-9) *ray = (Ray){point, phase_turn(ray->direction, draw_turn(&v->phase, random), random_next_unit(random))};
}

/* Returns the number of steps. */
static uint64_t walk(const Publishing *p, float (*bins)[3], Ray ray, double radiance[3], RandomStream *random) {
    double least = THRESHOLD * double_max(radiance[0], double_max(radiance[1], radiance[2])), t = 0, end = VTS_INFINITY, since = 0;
    size_t last = SIZE_MAX;
    int turns = 0;
    uint64_t steps = 0;
    if (!box3_clip_ray(p->set->bounds, &ray, &t, &end)) return 1;
    while (double_max(radiance[0], double_max(radiance[1], radiance[2])) > least && steps < MOST_STEPS_OF_RAY) {
        t += p->step, steps++;
        if (t > end) break;
        Vec3 point = vec3_madd(ray.origin, ray.direction, t);
        Here here = look(p, point, random);
        if (!here.volume) continue;
        last = here.voxel;
        since += here.scattering * p->step;
        for (int c = 0; c < 3; c++) radiance[c] *= exp(-here.absorption[c] * p->step);
        if (random_next_unit(random) >= -expm1(-since)) continue; /* since the last scattering, at each step: sec. 4.2 */
        intercept(&here, bins, radiance, &ray, point, random);
        if (++turns == p->set->orders) return steps;
        since = t = 0, end = VTS_INFINITY;
        if (!box3_clip_ray(p->set->bounds, &ray, &t, &end)) return steps;
    }
    if (last != SIZE_MAX && double_max(radiance[0], double_max(radiance[1], radiance[2])) > least) store(bins, last, radiance, 1);
    return steps;
}

static void shoot_batch(void *context, size_t batch, int worker) {
    const Publishing *p = context;
    const atomic_bool *interrupted = p->compiled->options->interrupted;
    uint64_t rays = (uint64_t)ceil(p->rays / (double)p->batch_count), steps = 0, most = MOST_STEPS / p->batch_count, i = 0;
    (void)worker;
    for (; i < rays && steps < most && !(interrupted && *interrupted); i++) {
        uint64_t number = i * p->batch_count + batch;
        RandomStream random = {random_hash(number, 0x7075626c, 0, 0)};
        const Disc *disc = &p->discs[number % p->disc_count];
        const Ray ray = ray_from(p, disc, &random);
        double radiance[3];
        radiance_of(p, disc, &ray, radiance);
        steps += walk(p, p->batches + batch * p->batch_size, ray, radiance, &random);
    }
    p->shot[batch] = i;
}

/* ---- making ready ---- */

enum { AUTO_VOXELS = 64 };

static double side_of(const CompiledVolume *v, int k) { return vec3_length(v->from_cells.c[k]) * v->lattice.size[k]; }

/* Voxels are the density's cells; what is even everywhere has none of its own. */
static void choose_voxels(const CompiledVolume *v, int out[3]) {
    const int *n = v->lattice.size;
    double longest = double_max(side_of(v, 0), double_max(side_of(v, 1), side_of(v, 2))), wanted = v->volume->step, count = 1;
    bool even = n[0] == 1 && n[1] == 1 && n[2] == 1;
    double step = wanted > 0 ? double_max(wanted, longest / 256) : longest / AUTO_VOXELS;
    for (int k = 0; k < 3; k++) count *= double_max(1, side_of(v, k) / step);
    if (count > 4e6) step *= cbrt(count / 4e6);
    for (int k = 0; k < 3; k++) out[k] = even ? (int)double_clamp(ceil(side_of(v, k) / step - 1e-9), 1, 256) : n[k];
}

static void make_voxels(CompiledScene *compiled, CompiledVolume *v) {
    VolumeLight *light = v->light = arena_new(compiled->arena, VolumeLight);
    choose_voxels(v, light->bins);
    light->harmonics = 1;
    light->kept = arena_push_array_(compiled->arena, volume_bins(light), sizeof *light->kept);
    light->density = arena_new_array(compiled->arena, float, volume_bins(light));
    const int *n = light->bins;
    size_t bin = 0;
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++)
                light->density[bin++] = (float)volume_density(v, vec3((x + 0.5) / n[0], (y + 0.5) / n[1], (z + 0.5) / n[2]));
}

static double step_of(const VolumeSet *set) {
    double step = VTS_INFINITY;
    for (size_t i = 0; i < set->count; i++) {
        const CompiledVolume *v = &set->items[i];
        for (int k = 0; k < 3 && !(v->volume->step > 0); k++) step = double_min(step, side_of(v, k) / v->light->bins[k]);
        if (v->volume->step > 0) step = double_min(step, v->volume->step);
    }
    return step;
}

/* A ray counts as if the rays of its source were one for each face of a voxel that they cross. */
static void settle(const Publishing *p) {
    uint64_t rays = 0;
    for (size_t b = 0; b < p->batch_count; b++) rays += p->shot[b];
    for (size_t i = 0; i < p->set->count; i++) {
        const CompiledVolume *v = &p->set->items[i];
        size_t bins = volume_bins(v->light);
        double face = 1, scale;
        for (int k = 0; k < 3; k++) face *= side_of(v, k) / v->light->bins[k];
        scale = (double)p->disc_count / (double)rays / cbrt(face * face);
        for (size_t bin = 0; bin < bins; bin++)
            for (int c = 0; c < 3; c++) {
                double sum = 0;
                for (size_t b = 0; b < p->batch_count; b++) sum += (double)p->batches[b * p->batch_size + p->first_bin[i] + bin][c];
                v->light->kept[bin][c] = (float)(sum * scale);
            }
    }
}

void volumes_publish(VolumeSet *set) {
    for (size_t i = 0; i < set->count; i++) memcpy(set->items[i].extinction, set->items[i].absorption, sizeof set->items[i].extinction);
}

bool volumes_light_published(CompiledScene *compiled) {
    const VolumeSet *set = compiled->volumes;
    Arena *scratch = &compiled->scratch;
    ArenaMark mark = arena_mark(scratch);
    Publishing p = {.compiled = compiled, .set = set, .middle = vec3_lerp(set->bounds.min, set->bounds.max, 0.5)};
    p.radius = vec3_length(vec3_sub(set->bounds.max, set->bounds.min)) / 2;
    p.first_bin = arena_new_array(scratch, size_t, set->count);
    for (size_t i = 0; i < set->count; i++) {
        make_voxels(compiled, &compiled->volumes->items[i]);
        p.first_bin[i] = p.batch_size;
        p.batch_size += volume_bins(set->items[i].light);
        p.rays = double_max(p.rays, set->items[i].volume->rays);
    }
    p.rays = double_min(p.rays > 0 ? p.rays : AUTO_RAYS, MOST_RAYS), p.step = step_of(set);
    p.batch_count = (size_t)double_clamp(MOST_NUMBERS / (3 * (double)p.batch_size), 1, MOST_BATCHES);
    p.batches = arena_push_array_(scratch, p.batch_size * p.batch_count, sizeof *p.batches);
    p.shot = arena_new_array(scratch, uint64_t, p.batch_count);
    find_discs(&p, scratch);
    bool done = true;
    if (p.disc_count) {
        done = pool_run(compiled->options->pool, p.batch_count, shoot_batch, &p);
        settle(&p);
    }
    arena_reset_to(scratch, mark);
    return done && !(compiled->options->interrupted && *compiled->options->interrupted);
}

/* ---- the second pass ---- */

enum { MOST_AT_ONCE = 64 };

/* What the voxels that begin with the piece add to what is seen, and by how much all of them dim it. */
static Vec3f piece_light(const BinSweep *sweep, double depth[3]) {
    Vec3f sum = {0, 0, 0};
    for (int c = 0; c < 3; c++) depth[c] = 0;
    for (int i = 0; i < sweep->count; i++) {
        const BinWalk *w = &sweep->walks[i];
        const VolumeLight *light = w->volume->light;
        if (!bin_sweep_has(sweep, w)) continue;
        if (w->t >= sweep->t0) sum = vec3f_add(sum, vec3f(light->kept[w->bin][0], light->kept[w->bin][1], light->kept[w->bin][2]));
        for (int c = 0; c < 3; c++) depth[c] += w->volume->absorption[c] * (double)light->density[w->bin] * (sweep->t1 - sweep->t0);
    }
    return sum;
}

Air volumes_gather_published(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t) {
    BinWalk walks[MOST_AT_ONCE];
    BinSweep sweep = {.walks = walks};
    const Ray ray = {cone->origin, cone->direction};
    const VolumeSet *set = tracer->compiled->volumes;
    for (size_t i = 0; i < set->count && sweep.count < MOST_AT_ONCE; i++)
        if (set->items[i].seen) sweep.count += bin_walk_begin(&walks[sweep.count], &set->items[i], &ray, 0, t_max);
    Air air = air_clear();
    double weights = 0, depth[3];
    *mean_t = 0;
    while (bin_sweep_next(&sweep)) {
        Vec3f light = vec3f_mul(air.keep, piece_light(&sweep, depth));
        double weight = (double)(light.x + light.y + light.z);
        if (weight > 0) *mean_t += weight * (sweep.t0 + sweep.t1) / 2, weights += weight;
        air.add = vec3f_add(air.add, light);
        air.keep = vec3f_mul(air.keep, vec3f((float)exp(-depth[0]), (float)exp(-depth[1]), (float)exp(-depth[2])));
        if (float_max(air.keep.x, float_max(air.keep.y, air.keep.z)) < (float)THRESHOLD) break;
    }
    if (weights > 0) *mean_t /= weights;
    return air;
}
