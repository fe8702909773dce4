#include "texel/sky_powers.h"

#include "base/random.h"
#include "texel/voxel_trim.h"

#include <math.h>

/* Rays to each direction, on a lattice; their voxels, in levels below the coarsest; steps in these, and at most; directions of the sky that triangles are asked for. */
enum { RAY_SIDE = 8, LEVELS_SEEN = 6, MOST_STEPS = 256, SKY_DIRECTIONS = 256 };
static const float STEP_VOXELS = 1.6f;
static const float DARK = 1.0f / 256;
/* Means are found from as many kinds of places, by what they see. */
enum { KINDS = 64, TRIES = 24 };
static const float LEAST_POWER = 0.125f, MOST_POWER = 8;

typedef struct PowersWork {
    const TexelSky *sky;
    const VoxelLayer *const *layers;
    size_t count;
    OpacityModel opacity;
    const VoxelLayer *paired;
    float *power;
} PowersWork;

/* The share of the sky that what is seen sees, over all of it, as triangles tell. They are asked down to the lowest ring of directions; from there to the
 * horizon light falls to nothing, in a layer without end. */
static float share_of_triangles(const VoxelLayer *paired, Vec3f to_eye) {
    float sum = 0, lowest = pair_direction(PAIR_NODES - 1).y;
    for (int i = 0; i < SKY_DIRECTIONS; i++) {
        float y = ((float)i + 0.5f) / SKY_DIRECTIONS, r = sqrtf(1 - y * y), around = 2.39996323f * (float)i;
        sum += float_min(1, y / lowest) * voxel_layer_lit_pair(paired, to_eye, vec3f(r * cosf(around), y, r * sinf(around)));
    }
    return sum / SKY_DIRECTIONS;
}

static float depth_at(const PowersWork *w, float lod, Vec3f at, Vec3f step) {
    float depth = 0, finest = 1 / w->layers[0]->level[0].density_unit, h = finest * exp2f(lod);
    for (size_t k = 0; k < w->count; k++) {
        VoxelSample v;
        if (!voxel_layer_sample_lod(w->layers[k], lod, at, &v)) continue;
        float own = w->opacity == OPACITY_MEAN ? opacity_depth_mean(&v, finest, h, step) : opacity_depth(w->opacity, &v, h, step);
        depth += w->opacity == OPACITY_CORRELATED ? own * voxel_layer_trim_at(w->layers[k], lod, step) : own;
    }
    return depth;
}

static float wrapped(float x, float size) { return float_clamp(x - size * floorf(x / size), 0, size); }

/* Down from the top to a place on the ground: adds how much is seen of each kind of place. */
static void look_down(const PowersWork *w, Vec3f foot, Vec3f to_eye, const Vec3f ways[SKY_WAYS], const float gaps[SKY_WAYS], float seen[KINDS]) {
    const VoxelLevel *finest = &w->layers[0]->level[0];
    Vec3f extent = vec3f(finest->sides[0] * (float)finest->size[0], finest->sides[1] * (float)finest->size[1], finest->sides[2] * (float)finest->size[2]);
    float lod = (float)int_max(0, w->layers[0]->levels - 1 - LEVELS_SEEN), way = extent.y / to_eye.y, through = 1;
    int steps = int_clamp((int)ceilf(way * finest->density_unit / (STEP_VOXELS * exp2f(lod))), 1, MOST_STEPS);
    Vec3f step = vec3f_scale(to_eye, way / (float)steps);
    for (int i = steps - 1; i >= 0 && through > DARK; i--) {
        Vec3f at = vec3f_madd(foot, step, (float)i + 0.5f);
        at.x = wrapped(at.x, extent.x), at.z = wrapped(at.z, extent.z);
        float rest = through * expf(-depth_at(w, lod, at, step));
        if (rest < through) seen[int_clamp((int)(texel_sky_seen(w->sky, at, ways, gaps, to_eye) * KINDS), 0, KINDS - 1)] += through - rest;
        through = rest;
    }
}

static float mean_of(const float seen[KINDS], float power) {
    float sum = 0, all = 0;
    for (int i = 0; i < KINDS; i++) {
        sum += seen[i] * powf(((float)i + 0.5f) / KINDS, power);
        all += seen[i];
    }
    return all > 0 ? sum / all : -1;
}

static void find_power(void *context, size_t node, int worker) {
    (void)worker;
    const PowersWork *w = context;
    const VoxelLevel *finest = &w->layers[0]->level[0];
    Vec3f to_eye = pair_direction((int)node), ways[SKY_WAYS];
    float gaps[SKY_WAYS], seen[KINDS] = {0}, low = log2f(LEAST_POWER), high = log2f(MOST_POWER), truth = share_of_triangles(w->paired, to_eye);
    for (int i = 0; i < SKY_WAYS; i++) ways[i] = texel_sky_way(i), gaps[i] = sky_open_to_eye(vec3f_dot(ways[i], to_eye));
    for (int i = 0; i < RAY_SIDE * RAY_SIDE; i++) {
        uint64_t bits = random_hash(node, (uint64_t)i, 1, 0);
        look_down(w, vec3f(finest->sides[0] * (float)finest->size[0] * ((float)(i % RAY_SIDE) + random_unitf(bits)) / RAY_SIDE, 0,
                           finest->sides[2] * (float)finest->size[2] * ((float)(i / RAY_SIDE) + random_unitf(random_mix(bits))) / RAY_SIDE), to_eye, ways, gaps, seen);
    }
    if (mean_of(seen, 1) < 0) return;
    for (int i = 0; i < TRIES; i++) {
        float middle = (low + high) / 2;
        *(mean_of(seen, exp2f(middle)) > truth ? &low : &high) = middle;
    }
    w->power[node] = exp2f((low + high) / 2);
}

bool sky_powers_find(const TexelSky *sky, const VoxelLayer *const *layers, size_t count, const TexelSkyOptions *options, float power[PAIR_NODES]) {
    const unsigned level = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z;
    float found[PAIR_NODES];
    PowersWork work = {sky, layers, count, options->opacity, NULL, found};
    for (size_t k = 0; k < count && !work.paired; k++)
        if (voxel_layer_is_paired(layers[k])) work.paired = layers[k];
    if (!work.paired || options->repeated != level) return true;
    for (int i = 0; i < PAIR_NODES; i++) found[i] = power[i];
    bool done = pool_run(options->pool, PAIR_NODES, find_power, &work);
    for (int i = 0; i < PAIR_NODES; i++) power[i] = found[i];
    return done;
}
