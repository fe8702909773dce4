#include "render/volume_shoot.h"

#include <string.h>

/* Paths begin where lamps' light is scattered first: at places drawn in proportion to how much that is, which is known from the lamps' depths. (Blasi, Le
 * Saec & Schlick 1993 shoot from the lamps, which loses what misses, and lamps whose light does not fall with distance are none that could shoot.) */

enum { BATCHES = 8, MOST_TURNS = 20000 };
static const double MOST_RAYS = 1 << 26;

typedef struct Shooting {
    CompiledScene *compiled;
    const VolumeSet *set;
    Tracer **tracers;
    double *chances; /* sums so far of what each (volume, lamp, cell) scatters first */
    size_t entries;
    size_t *first_entry; /* of each volume */
    size_t *first_bin;   /* of each volume in a batch, in harmonics */
    size_t batch_size;
    float (*batches)[3];
    uint64_t begin, end;  /* rays of the round, in each batch */
    uint64_t *collisions; /* of each batch so far */
    double lamp_total;
    bool looks_help; /* more than one; where orders are counted, each is a further order */
    int looks;
    Vec3 middle;
    double radius;
} Shooting;

Vec3 volume_unit(const CompiledVolume *v, Vec3 point) {
    Vec3 cells = vec3_add(mat3_apply(&v->to_cells.linear, point), v->to_cells.offset);
    const int *n = v->lattice.size;
    return vec3((cells.x - 0.5) / n[0], (cells.y - 0.5) / n[1], (cells.z - 0.5) / n[2]);
}

double volume_density(const CompiledVolume *v, Vec3 unit) {
    if (v->body && !body_inside(v->body, transform_point_back(&v->body_place, volume_point(v, unit))))
        return 0;
    const int *n = v->lattice.size;
    return lattice_value(&v->lattice, vec3(unit.x * n[0] + 0.5, unit.y * n[1] + 0.5, unit.z * n[2] + 0.5));
}

static double volume_of(const CompiledVolume *v) {
    const int *n = v->lattice.size;
    return fabs(mat3_determinant(&v->from_cells)) * n[0] * n[1] * n[2];
}

static double brightness(const double c[3]) { return (c[0] + c[1] + c[2]) / 3; }

/* ---- where light is scattered first ---- */

static size_t cells_of(const VolumeLight *light) {
    return (size_t)light->cells[0] * (size_t)light->cells[1] * (size_t)light->cells[2];
}

/* About how much of a lamp's light a cell scatters: never 0 where it is any. */
static double cell_share(const CompiledScene *compiled, const CompiledVolume *v, size_t l, const int at[3]) {
    const VolumeLight *light = v->light;
    const int *n = light->cells;
    double light_sum = 0, density = 0, density_most = 0;
    for (int corner = 0; corner < 8; corner++) {
        size_t node = 0;
        for (int k = 2; k >= 0; k--) node = node * (size_t)(n[k] + 1) + (size_t)(at[k] + (corner >> k & 1));
        const float *depth = light->depths[l * light->nodes + node];
        double through = (exp(-(double)depth[0]) + exp(-(double)depth[1]) + exp(-(double)depth[2])) / 3;
        light_sum += light->states[l * light->nodes + node] == LIGHT_HIDDEN ? 0.02 * through : through;
        Vec3 unit =
            vec3((at[0] + 0.25 + 0.5 * (corner & 1)) / n[0], (at[1] + 0.25 + 0.5 * (corner >> 1 & 1)) / n[1],
                 (at[2] + 0.25 + 0.5 * (corner >> 2)) / n[2]);
        double here = lattice_value(&v->lattice,
                                    vec3(unit.x * v->lattice.size[0] + 0.5, unit.y * v->lattice.size[1] + 0.5,
                                         unit.z * v->lattice.size[2] + 0.5));
        density += here;
        density_most = double_max(density_most, here);
    }
    Vec3 point = volume_point(v, vec3((at[0] + 0.5) / n[0], (at[1] + 0.5) / n[1], (at[2] + 0.5) / n[2]));
    LightRay way = light_ray(&compiled->scene->lights[l], point);
    double color = (double)(way.color.x + way.color.y + way.color.z) / 3;
    double floor = 1e-3 * (double)v->lattice.most; /* between the samples there may be a little more */
    return brightness(v->scattering) * double_max(color, 0) * light_sum / 8 *
           double_max((density / 8 + density_most) / 2, floor);
}

static void tabulate(Shooting *s) {
    const Scene *scene = s->compiled->scene;
    double sum = 0;
    size_t e = 0;
    for (size_t i = 0; i < s->set->count; i++) {
        const CompiledVolume *v = &s->set->items[i];
        const int *n = v->light->cells;
        double cell = volume_of(v) / (double)cells_of(v->light);
        s->first_entry[i] = e;
        for (size_t l = 0; l < scene->light_count; l++)
            for (int z = 0; z < n[2]; z++)
                for (int y = 0; y < n[1]; y++)
                    for (int x = 0; x < n[0]; x++) {
                        double share = light_shines_on(&scene->lights[l], NULL)
                                           ? cell_share(s->compiled, v, l, (int[3]){x, y, z}) * cell
                                           : 0;
                        s->chances[e++] = sum += share > 0 && isfinite(share) ? share : 0;
                    }
    }
    s->first_entry[s->set->count] = e;
    s->lamp_total = sum;
}

/* Of the `parts` parts of the entries [begin, end), each of `size`, the one in which a share `*u` of what they scatter is reached; `*u` becomes that of it alone. So what is drawn moves as
 * steadily as lamps do. */
static size_t draw_part(const Shooting *s, size_t begin, size_t size, size_t parts, double *u) {
    const double before = begin ? s->chances[begin - 1] : 0, whole = s->chances[begin + parts * size - 1] - before, target = before + *u * whole;
    size_t lo = 0, hi = parts - 1;
    while (lo < hi) {
        size_t middle = (lo + hi) / 2;
        if (s->chances[begin + (middle + 1) * size - 1] > target) hi = middle;
        else lo = middle + 1;
    }
    const double low = lo ? s->chances[begin + lo * size - 1] : before, share = s->chances[begin + (lo + 1) * size - 1] - low;
    *u = share > 0 ? double_clamp((target - low) / share, 0, 1) : 0.5;
    return begin + lo * size;
}

/* ---- paths ---- */

typedef struct Shot {
    const Shooting *shooting;
    SurfaceTracer tracer;
    RandomStream random;
    float (*bins)[3]; /* of the batch */
    uint64_t collisions;
    double weight[3]; /* power */
    double whole;     /* at the beginning */
} Shot;

static void keep(const Shot *shot, const Collision *at, Vec3 point, Vec3 direction) {
    const CompiledVolume *v = at->volume;
    const VolumeLight *light = v->light;
    Vec3 unit = volume_unit(v, point);
    double shape[VOLUME_HARMONICS];
    size_t bin = 0;
    for (int k = 2; k >= 0; k--)
        bin = bin * (size_t)light->bins[k] +
              (size_t)double_to_int(vec3_get(unit, k) * light->bins[k], 0, light->bins[k] - 1);
    float(*out)[3] = shot->bins + shot->shooting->first_bin[v - shot->shooting->set->items] +
                     bin * (size_t)light->harmonics;
    volume_harmonics(direction, light->harmonics, shape);
    for (int i = 0; i < light->harmonics; i++)
        for (int c = 0; c < 3; c++) out[i][c] += (float)(shot->weight[c] * shape[i]);
}

static Vec3 scatter(Shot *shot, const CompiledVolume *v, Vec3 direction) {
    double mu =
        phase_draw(&v->phase, random_next_unit(&shot->random), random_next_unit(&shot->random));
    return phase_turn(direction, mu, random_next_unit(&shot->random));
}

int volume_most_turns(const VolumeSet *set) {
    return set->orders ? int_min(set->orders - 2, MOST_TURNS) : MOST_TURNS;
}

/* On from a place; `order` turns are behind it. */
static void follow(Shot *shot, Ray ray, int order) {
    const Shooting *s = shot->shooting;
    for (int most = volume_most_turns(s->set); order <= most; order++) {
        Collision at;
        bool met;
        double clear = volume_clear_way(s->compiled, &ray, &met);
        shot->collisions++;
        if (!volume_collide(s->set, &shot->random, shot->weight, &ray, clear, RAY_MIRRORS, &at)) return;
        Vec3 point = vec3_madd(ray.origin, ray.direction, at.t);
        keep(shot, &at, point, ray.direction);
        if (!volume_survives(&shot->random, shot->weight, shot->whole)) return;
        ray = (Ray){point, scatter(shot, at.volume, ray.direction)};
    }
}

static bool set_power(Shot *shot, const double power[3]) {
    for (int c = 0; c < 3; c++) shot->weight[c] = power[c];
    shot->whole = double_max(power[0], double_max(power[1], power[2]));
    return shot->whole > 0 && isfinite(shot->whole);
}

static void shoot_lamp(Shot *shot, double u[4]) {
    const Shooting *s = shot->shooting;
    size_t i = 0;
    double which = u[0] * s->lamp_total;
    while (i + 1 < s->set->count && s->chances[s->first_entry[i + 1] - 1] <= which) i++;
    const CompiledVolume *v = &s->set->items[i];
    const VolumeLight *light = v->light;
    const int *n = light->cells;
    const size_t row = (size_t)n[0], slice = row * (size_t)n[1], cells = cells_of(light), lamps = s->compiled->scene->light_count;
    const double before = s->first_entry[i] ? s->chances[s->first_entry[i] - 1] : 0, whole = s->chances[s->first_entry[i + 1] - 1] - before;
    u[0] = whole > 0 ? (which - before) / whole : 0;
    const size_t of_lamp = draw_part(s, s->first_entry[i], cells, lamps, &u[0]), of_slice = draw_part(s, of_lamp, slice, (size_t)n[2], &u[3]);
    const size_t of_row = draw_part(s, of_slice, row, (size_t)n[1], &u[2]), entry = draw_part(s, of_row, 1, row, &u[1]), l = (of_lamp - s->first_entry[i]) / cells;
    double chance = (s->chances[entry] - (entry ? s->chances[entry - 1] : 0)) / s->lamp_total, power[3];
    Vec3 unit = vec3(((double)(entry - of_row) + u[1]) / n[0], ((double)((of_row - of_slice) / row) + u[2]) / n[1], ((double)((of_slice - of_lamp) / slice) + u[3]) / n[2]);
    Vec3 point = volume_point(v, unit);
    double density = volume_density(v, unit);
    if (!(density > 0) || !(chance > 0)) return;
    LightRay way = light_ray(&s->compiled->scene->lights[l], point);
    Vec3f color = vec3f_mul(way.color, volume_lamp(v, &shot->tracer, l, &way, unit, point));
    double scale = VOLUME_IRRADIANCE * density * volume_of(v) / (double)cells_of(light) / chance;
    const double colors[3] = {(double)color.x, (double)color.y, (double)color.z};
    for (int k = 0; k < 3; k++) power[k] = colors[k] * v->scattering[k] * scale;
    if (!set_power(shot, power)) return;
    follow(shot, (Ray){point, scatter(shot, v, vec3_negate(way.direction))}, 1);
}

/* From all around, through discs that the volumes lie behind. */
static void shoot_sky(Shot *shot, const double u[4]) {
    const Shooting *s = shot->shooting;
    double z = 1 - 2 * u[0], turn = 2 * VTS_PI * u[1], r = sqrt(double_max(0, 1 - z * z)), power[3];
    Vec3 from = vec3(r * cos(turn), z, r * sin(turn)), a, b;
    Vec3f sky = sky_radiance(s->compiled->scene, from, 0);
    double out = s->radius * sqrt(u[2]), around = 2 * VTS_PI * u[3];
    double scale = 4 * VTS_PI * VTS_PI * s->radius * s->radius;
    power[0] = (double)sky.x * scale, power[1] = (double)sky.y * scale, power[2] = (double)sky.z * scale;
    if (!set_power(shot, power)) return;
    vec3_frame(from, &a, &b);
    Vec3 start = vec3_madd(vec3_madd(vec3_madd(s->middle, a, out * cos(around)), b, out * sin(around)), from,
                           s->radius);
    if (hierarchy_object_count(s->compiled->hierarchy) &&
        hierarchy_occluded(s->compiled->hierarchy, &(Ray){start, from}, 0, VTS_INFINITY))
        return;
    follow(shot, (Ray){start, vec3_negate(from)}, 0);
}

/* Number i of a sequence that spreads evenly over [0, 1)^4 however far it goes: multiples of powers of 1/x, x^5 = x + 1. More rays go on where fewer ended. */
static void spread_in_four(uint64_t i, double out[4]) {
    static const uint64_t steps[4] = {0xDB4F0B9175AE2165u, 0xBBE0563303A4615Fu, 0xA0F2EC75A1FE1575u, 0x89E182857D9ED689u};
    for (int k = 0; k < 4; k++) out[k] = random_unit(i * steps[k]);
}

static void shoot_batch(void *context, size_t batch, int worker) {
    Shooting *s = context;
    Shot shot = {.shooting = s,
                 .tracer = tracer_of_surfaces(s->tracers[worker]),
                 .bins = s->batches + batch * s->batch_size};
    const atomic_bool *interrupted = s->compiled->options->interrupted;
    for (uint64_t i = s->begin; i < s->end && !(interrupted && *interrupted); i++) {
        uint64_t number = i * BATCHES + batch;
        shot.random.state = random_hash(number, 0x6c616d70, 0, 0);
        double places[4];
        if (s->lamp_total > 0 && volume_most_turns(s->set) > 0) {
            places[0] = random_unit(number * 0x9E3779B97F4A7C15u); /* of the golden ratio */
            draw_three((uint32_t)i, 0x6c616d70 + batch, places + 1); /* parts of one net would lie in parts of space each, and differ by that */
            shoot_lamp(&shot, places);
        }
        shot.random.state = random_hash(number, 0x736b79, 0, 0);
        if (!s->set->sky) continue;
        spread_in_four(number, places);
        shoot_sky(&shot, places);
    }
    s->collisions[batch] += shot.collisions;
}

/* ---- how many ---- */

/* In what is very dense a ray has thousands of free paths: the first round tells. */
enum { FIRST_ROUND = 1 << 7, LEAST_RAYS = 1 << 12 };
/* Rays are doubled until the error of the bins' light is below this multiple of max_error: a bin sees many, and a pixel several. What is left of it in pictures is so much less than in
 * bins (7.5 to 8.5 in a fractal cloud and a thick slab). Or until so many free paths. */
static const double BIN_ERROR = 12, SEEN_ERROR = 8, MOST_FREE_PATHS = 1.2e7, RAYS_AT_MOST = 1 << 22;

/* Of the light of all bins that hold something, on the mean, as brightness of matter that hides what is behind; found by what batches differ. */
static double error_of_bins(const Shooting *s, double rays) {
    double sum = 0, weights = 0;
    for (size_t n = 0; n < s->set->count; n++) {
        const CompiledVolume *v = &s->set->items[n];
        const VolumeLight *light = v->light;
        double size = volume_of(v) / (double)volume_bins(light) * rays,
               shine = 0.28209479177387814 / brightness(v->extinction);
        for (size_t bin = 0; bin < volume_bins(light); bin++) {
            double mean = 0, spread_sum = 0, weight = (double)light->density[bin] * brightness(v->extinction);
            if (!(weight > 0)) continue;
            const float(*first)[3] =
                (const float(*)[3])s->batches + s->first_bin[n] + bin * (size_t)light->harmonics;
            for (size_t b = 0; b < BATCHES; b++) mean += (double)first[b * s->batch_size][1] / BATCHES;
            for (size_t b = 0; b < BATCHES; b++)
                spread_sum += ((double)first[b * s->batch_size][1] - mean) *
                              ((double)first[b * s->batch_size][1] - mean);
            double scale = shine / size / (double)light->density[bin];
            scale /= double_max(1, scale * mean * BATCHES); /* what is brighter than white is clamped */
            weight = double_min(weight, 1 / cbrt(volume_of(v) / (double)volume_bins(light)));
            sum += weight * scale * scale * spread_sum * BATCHES / (BATCHES - 1);
            weights += weight;
        }
    }
    return weights > 0 ? sqrt(sum / weights) : 0;
}

/* Each further look at other bins leaves about so much of the error of what paths have brought, where bins see each other (0.5 is too hopeful where clouds are as fine as bins); it
 * takes as long as so many free paths for each of its rays. */
static const double LOOK_LEAVES = 0.7, LOOK_RAY_PATHS = 1.5;
enum { MOST_LOOKS = 4 };

static double look_cost(const Shooting *s) {
    size_t filled = 0;
    for (size_t n = 0; n < s->set->count; n++) {
        const VolumeLight *light = s->set->items[n].light;
        for (size_t bin = 0; bin < volume_bins(light); bin++) filled += light->density[bin] > 0;
    }
    return LOOK_RAY_PATHS * VOLUME_LOOK_RAYS * (double)filled;
}

/* Whether light goes from bin to bin, on the mean: in a flat slab, whose bins are wide, or in what is very dense, it does not. */
static bool bins_see_each_other(const Shooting *s) {
    for (size_t n = 0; n < s->set->count; n++) {
        const CompiledVolume *v = &s->set->items[n];
        double extinction = brightness(v->extinction) * lattice_mean(&v->lattice);
        for (int k = 0; k < 3; k++)
            if (vec3_length(v->from_cells.c[k]) * v->lattice.size[k] / v->light->bins[k] * extinction > 1) return false;
    }
    return true;
}

/* How often to look around, and of how many rays, as a multiple of those that left `excess` of the error that may remain after one look: so that all that is still to be done takes the
 * least time. No jump where the clouds or lamps change a little. */
static double enough_rays(const Shooting *s, double excess, double paths, int *looks) {
    double best = 0, least = VTS_INFINITY;
    for (int k = 1; k <= (s->looks_help ? MOST_LOOKS : 1); k++) {
        double left = excess * pow(LOOK_LEAVES, k - 1), more = double_max(1, left * left), cost = (k - 1) * look_cost(s) + paths * (more - 1);
        if (cost < least) least = cost, best = more, *looks = k;
    }
    return best;
}

static double free_paths(const Shooting *s) {
    double sum = 0;
    for (size_t b = 0; b < BATCHES; b++) sum += (double)s->collisions[b];
    return sum;
}

/* Returns how many rays were shot; 0 when interrupted. */
static double shoot_rounds(Shooting *s) {
    /* Of finer bins a line of sight meets more. */
    double asked = 0, rays = 0, finer = sqrt(s->set->fineness), most_paths = MOST_FREE_PATHS * s->set->fineness * s->set->fineness;
    for (size_t i = 0; i < s->set->count; i++) asked = double_max(asked, s->set->items[i].volume->rays);
    asked = double_min(asked, MOST_RAYS);
    double next = asked > 0 ? asked : FIRST_ROUND;
    s->looks = 1;
    s->looks_help = !s->set->orders && bins_see_each_other(s);
    for (bool enough = false;;) {
        s->begin = s->end, s->end = (uint64_t)ceil(next / BATCHES);
        if (!pool_run(s->compiled->options->pool, BATCHES, shoot_batch, s)) return 0;
        rays = (double)s->end * BATCHES;
        if (enough || asked > 0) break;
        double paths = free_paths(s), most = double_min(RAYS_AT_MOST / rays, most_paths / double_max(paths, 1));
        double wanted = rays < LEAST_RAYS ? VTS_INFINITY : enough_rays(s, error_of_bins(s, rays) / (BIN_ERROR * finer * s->compiled->max_error), paths, &s->looks);
        if (most < wanted && most < 2) s->looks = s->looks_help ? MOST_LOOKS : 1;
        next = rays * double_min(double_min(wanted, 2), most);
        enough = wanted < 2 || most < 2;
        if (next <= rays) break;
    }
    s->compiled->volume_rays = rays;
    s->compiled->volume_error = error_of_bins(s, rays) / (SEEN_ERROR * finer) * pow(LOOK_LEAVES, s->looks - 1);
    return rays;
}

/* ---- what is kept ---- */

Vec3 volume_bin_place(const VolumeLight *light, const int at[3], const double in[3]) {
    const int *n = light->bins;
    return vec3((at[0] + in[0]) / n[0], (at[1] + in[1]) / n[1], (at[2] + in[2]) / n[2]);
}

enum { LEAST_ACROSS = 3, MOST_ACROSS = 6 };

static double mean_density(const CompiledVolume *v, const int at[3]) {
    int across[3];
    double sum = 0;
    for (int k = 0; k < 3; k++)
        across[k] = v->body
                        ? MOST_ACROSS
                        : int_clamp(2 * v->lattice.size[k] / v->light->bins[k], LEAST_ACROSS, MOST_ACROSS);
    for (int z = 0; z < across[2]; z++)
        for (int y = 0; y < across[1]; y++)
            for (int x = 0; x < across[0]; x++) {
                Vec3 unit = volume_bin_place(
                    v->light, at,
                    (double[3]){(x + 0.5) / across[0], (y + 0.5) / across[1], (z + 0.5) / across[2]});
                sum += volume_density(v, unit);
            }
    return sum / (across[0] * across[1] * across[2]);
}

/* Lamps' light that is scattered for the first time in the bin: of eight places. */
static void add_lamps(const Shooting *s, const CompiledVolume *v, SurfaceTracer *tracer, const int at[3],
                      double (*sent)[3]) {
    const Scene *scene = s->compiled->scene;
    for (int corner = 0; corner < 8; corner++) {
        Vec3 unit = volume_bin_place(
                 v->light, at,
                 (double[3]){corner & 1 ? 0.75 : 0.25, corner & 2 ? 0.75 : 0.25, corner & 4 ? 0.75 : 0.25}),
             point = volume_point(v, unit);
        double density = volume_density(v, unit), shape[VOLUME_HARMONICS];
        for (size_t l = 0; l < scene->light_count && density > 0; l++) {
            if (!light_shines_on(&scene->lights[l], NULL)) continue;
            LightRay way = light_ray(&scene->lights[l], point);
            if (way.color.x == 0 && way.color.y == 0 && way.color.z == 0) continue;
            Vec3f light = vec3f_mul(way.color, volume_lamp(v, tracer, l, &way, unit, point));
            const double color[3] = {(double)light.x, (double)light.y, (double)light.z};
            volume_harmonics(vec3_negate(way.direction), v->light->harmonics, shape);
            for (int h = 0; h < v->light->harmonics; h++)
                for (int c = 0; c < 3; c++)
                    sent[h][c] += density / 8 * VOLUME_IRRADIANCE * color[c] * shape[h];
        }
    }
}

typedef struct Settling {
    const Shooting *shooting;
    size_t number;
    double rays;
} Settling;

static void measure_row(void *context, size_t row, int worker) {
    const Settling *g = context;
    const CompiledVolume *v = &g->shooting->set->items[g->number];
    const int *n = v->light->bins;
    (void)worker;
    int at[3] = {0, (int)(row % (size_t)n[1]), (int)(row / (size_t)n[1])};
    for (; at[0] < n[0]; at[0]++)
        v->light->density[row * (size_t)n[0] + (size_t)at[0]] = (float)mean_density(v, at);
}

static void settle_row(void *context, size_t row, int worker) {
    const Settling *g = context;
    const Shooting *s = g->shooting;
    const CompiledVolume *v = &s->set->items[g->number];
    VolumeLight *light = v->light;
    const int *n = light->bins;
    double size = volume_of(v) / (double)volume_bins(light) * g->rays;
    SurfaceTracer tracer = tracer_of_surfaces(s->tracers[worker]);
    int at[3] = {0, (int)(row % (size_t)n[1]), (int)(row / (size_t)n[1])};
    for (; at[0] < n[0]; at[0]++) {
        size_t bin = row * (size_t)n[0] + (size_t)at[0], place = bin * (size_t)light->harmonics;
        double sent[VOLUME_HARMONICS][3] = {{0}};
        if (!(light->density[bin] > 0)) continue;
        if (volume_most_turns(s->set) >= 0) add_lamps(s, v, &tracer, at, sent);
        for (int h = 0; h < light->harmonics; h++)
            for (int c = 0; c < 3; c++) {
                double sum = 0;
                for (size_t b = 0; b < BATCHES; b++)
                    sum += (double)
                               s->batches[b * s->batch_size + s->first_bin[g->number] + place + (size_t)h][c];
                double kept = g->rays > 0 ? sum / size : 0;
                double moment = v->moments[volume_harmonic_degree(h)];
                light->again[place + (size_t)h][c] = (float)(kept * moment);
                light->source[place + (size_t)h][c] = (float)((sent[h][c] * v->scattering[c] + kept) * moment);
            }
    }
}

static bool for_rows(const Shooting *s, double rays, void (*job)(void *, size_t, int)) {
    for (size_t i = 0; i < s->set->count; i++) {
        Settling g = {s, i, rays};
        const int *n = s->set->items[i].light->bins;
        if (!pool_run(s->compiled->options->pool, (size_t)n[1] * (size_t)n[2], job, &g)) return false;
    }
    return true;
}

bool volumes_shoot(CompiledScene *compiled, Tracer **tracers) {
    const VolumeSet *set = compiled->volumes;
    Arena *scratch = &compiled->scratch;
    ArenaMark mark = arena_mark(scratch);
    Shooting s = {.compiled = compiled, .set = set, .tracers = tracers};
    s.first_entry = arena_new_array(scratch, size_t, set->count + 1);
    s.first_bin = arena_new_array(scratch, size_t, set->count);
    s.collisions = arena_new_array(scratch, uint64_t, BATCHES);
    for (size_t i = 0; i < set->count; i++) {
        const VolumeLight *light = set->items[i].light;
        s.entries += compiled->scene->light_count * cells_of(light);
        s.first_bin[i] = s.batch_size;
        s.batch_size += volume_bins(light) * (size_t)light->harmonics;
    }
    s.chances = arena_new_array(scratch, double, s.entries + 1);
    s.batches = arena_push_array_(scratch, s.batch_size * BATCHES, sizeof *s.batches);
    s.middle = vec3_lerp(set->bounds.min, set->bounds.max, 0.5);
    s.radius = vec3_length(vec3_sub(set->bounds.max, set->bounds.min)) / 2;
    tabulate(&s);
    double rays = 0;
    bool done = for_rows(&s, 0, measure_row);
    if (done && volume_most_turns(set) >= (set->sky ? 0 : 1)) done = (rays = shoot_rounds(&s)) > 0;
    compiled->volumes->looks = int_max(1, s.looks);
    done = done && for_rows(&s, rays, settle_row);
    arena_reset_to(scratch, mark);
    return done && !(compiled->options->interrupted && *compiled->options->interrupted);
}
