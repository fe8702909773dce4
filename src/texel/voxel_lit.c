#include "texel/voxel_lit.h"

#include "base/random.h"
#include "texel/light_share.h"
#include "texel/opacity.h"
#include "texel/voxel_trim.h"

#include <math.h>
#include <string.h>

/* Rays along each direction to the eye, places on the ground, on lattices; steps along them in voxels, and at most. */
enum { EYE_SIDE = 3, EYE_RAYS = EYE_SIDE * EYE_SIDE, GROUND_SIDE = 8, GROUND_PLACES = GROUND_SIDE * GROUND_SIDE, MOST_LIT_STEPS = 512 };
static const float LIT_STEP = 1.5f;
/* Where the renderer's shadows take voxels of some level, the eye's are finer by so many. */
static const float FINER_TO_EYE = 1.5f;
/* Light that is less than this makes no difference. */
static const float DARK_BELOW = 1.0f / 256;
/* Shares are held within these before they are compared. */
static const float LEAST_SHARE = 0.005f, MOST_SHARE = 0.995f;
static const float SOME_TRIANGLES = 2000;
/* A power is 2^((code − POWER_ONE) / POWER_STEPS). */
enum { POWER_ONE = 128, POWER_STEPS = 32 };

/* Through the layer along a direction, over and over as if copies lay side by side. */
typedef struct LitWay {
    const VoxelLayer *layer;
    Vec3f extent, d; /* unit */
    float lod, h, step;
} LitWay;

static LitWay way_along(const VoxelLayer *layer, Vec3f extent, float lod, Vec3f d) {
    float h = exp2f(lod) / layer->level[0].density_unit;
    return (LitWay){layer, extent, d, lod, h, float_max(LIT_STEP * h, extent.y / (d.y * MOST_LIT_STEPS))};
}

static float wrapped_to(float x, float size) { return float_clamp(x - size * floorf(x / size), 0, size); }

/* The step of `length` about p. */
typedef struct LitStep {
    float depth, area, gamma_area;
} LitStep;

static LitStep step_at(const LitWay *w, Vec3f p, float length) {
    Vec3f along = vec3f_scale(w->d, length);
    VoxelSample v;
    p.x = wrapped_to(p.x, w->extent.x);
    p.z = wrapped_to(p.z, w->extent.z);
    if (!voxel_layer_sample_lod(w->layer, w->lod, p, &v)) return (LitStep){0, 0, 0};
    float area = opacity_area(&v, along);
    return (LitStep){opacity_depth(OPACITY_CORRELATED, &v, w->h, along) * voxel_layer_trim_at(w->layer, w->lod, along), area,
                     area * (v.gamma + v.solid * (1 - v.gamma))};
}

/* What a ray from the eye to a place on the ground sees of the layer, and one of the places where, by lot. */
static float look_down(const LitWay *w, Vec3f foot, uint64_t lot, Vec3f *seen) {
    int steps = int_max(1, (int)ceilf(w->extent.y / (w->d.y * w->step)));
    float length = w->extent.y / (w->d.y * (float)steps), through = 1, hidden = 0;
    for (int i = steps - 1; i >= 0 && through > DARK_BELOW; i--) {
        uint64_t bits = random_hash(lot, (uint64_t)i, 0, 0);
        Vec3f p = vec3f_madd(foot, w->d, ((float)i + random_unitf(bits)) * length);
        float after = through * expf(-step_at(w, p, length).depth), weight = through - after;
        hidden += weight;
        if (weight > 0 && random_unitf(random_mix(bits)) * hidden <= weight) *seen = p;
        through = after;
    }
    return hidden;
}

/* The share of a light that comes to matter at p, as the renderer has it. */
static float light_at(const LitWay *w, Vec3f p, float facing) {
    float reach = (float)LIGHT_SURROUNDINGS * w->h, back = float_min(reach, p.y / w->d.y), end = (w->extent.y - p.y) / w->d.y;
    LightSurroundings around = {.facing = facing};
    float rest = 0, gamma_area = 0;
    for (float t = -back; t < end && rest < 5; t += w->step) {
        float length = float_min(w->step, end - t), within = float_clamp(reach - t, 0, length) / length;
        LitStep s = step_at(w, vec3f_madd(p, w->d, t + length / 2), length);
        around.depth += s.depth * within;
        around.area += s.area * within;
        gamma_area += s.gamma_area * within;
        around.before += s.area * float_clamp(within - float_max(0, -t) / length, 0, 1);
        rest += s.depth * (1 - within);
    }
    around.sheet = around.area > 0 ? float_clamp(gamma_area / (LIGHT_SHEET_GAMMA * around.area), 0, 1) : 0;
    return light_share(&around) * expf(-rest);
}

static float through_from_ground(const LitWay *w, Vec3f foot) {
    float depth = 0, end = w->extent.y / w->d.y;
    for (float t = 0; t < end && depth < 8; t += w->step) {
        float length = float_min(w->step, end - t);
        depth += step_at(w, vec3f_madd(foot, w->d, t + length / 2), length).depth;
    }
    return expf(-depth);
}

/* ---- powers ---- */

typedef struct PowerWork {
    VoxelLayer *layer;
    const LitTruth *truth;
    Vec3f extent, d[PAIR_NODES];
    float open[PAIR_NODES * PAIR_NODES]; /* pair_open(), the eye first */
    float matter_beside[TRIM_LEVELS][PAIR_NODES], ground_beside[TRIM_LEVELS][PAIR_NODES]; /* the share that is lit, the light beside the eye, by its direction */
} PowerWork;

static uint8_t power_code(float truth, float share) {
    float power = logf(float_clamp(truth, LEAST_SHARE, MOST_SHARE)) / logf(float_clamp(share, LEAST_SHARE, MOST_SHARE));
    return (uint8_t)int_clamp((int)lrintf(POWER_ONE + POWER_STEPS * log2f(power)), 0, 255);
}

/* Gaps between few pieces coincide, or exclude each other, in some directions and not in those between. */
static float certainty(size_t triangles) { return (float)triangles / ((float)triangles + SOME_TRIANGLES); }

static uint8_t less_certain(uint8_t code, float certain) { return (uint8_t)lrintf(POWER_ONE + certain * ((float)code - POWER_ONE)); }

/* On a lattice, each moved by lot. */
static Vec3f place_of(const PowerWork *work, int i, int side, uint64_t lot) {
    uint64_t bits = random_hash(lot, (uint64_t)i, 1, 0);
    return vec3f(work->extent.x * ((float)(i % side) + random_unitf(bits)) / (float)side, 0,
                 work->extent.z * ((float)(i / side) + random_unitf(random_mix(bits))) / (float)side);
}

static Vec3f direction_beside(Vec3f d) { return vec3f_normalize(vec3f(d.x / d.y + SPOT_OFFSET, 1, d.z / d.y)); }

static void find_matter_powers(PowerWork *work, int from_top, int eye) {
    VoxelLayer *layer = work->layer;
    float lod = (float)(layer->levels - 1 - from_top), sum[PAIR_NODES + 1] = {0}, seen = 0;
    Vec3f d = work->d[eye], beside = direction_beside(d);
    LitWay to_eye = way_along(layer, work->extent, float_max(0, lod - FINER_TO_EYE), work->d[eye]);
    for (int ray = 0; ray < EYE_RAYS; ray++) {
        Vec3f at = {0, 0, 0};
        uint64_t lot = (uint64_t)(ray + EYE_RAYS * (from_top + TRIM_LEVELS * eye));
        float weight = look_down(&to_eye, place_of(work, ray, EYE_SIDE, lot), lot, &at);
        seen += weight;
        for (int light = 0; light <= PAIR_NODES && weight > 0; light++) {
            LitWay way = way_along(layer, work->extent, lod, light < PAIR_NODES ? work->d[light] : beside);
            sum[light] += weight * light_at(&way, at, light_facing(vec3f_dot(work->d[eye], way.d)));
        }
    }
    for (int light = 0; light < PAIR_NODES && seen > 0; light++)
        layer->pairs.matter[from_top][eye * PAIR_NODES + light] = power_code(layer->pairs.lit[eye * PAIR_NODES + light], sum[light] / seen);
    work->matter_beside[from_top][eye] = seen > 0 ? sum[PAIR_NODES] / seen : 1;
}

static void find_ground_powers(PowerWork *work, int from_top) {
    VoxelLayer *layer = work->layer;
    float lod = (float)(layer->levels - 1 - from_top), through[PAIR_NODES][GROUND_PLACES];
    for (int node = 0; node < PAIR_NODES; node++) {
        LitWay way = way_along(layer, work->extent, lod, work->d[node]), near = way_along(layer, work->extent, lod, direction_beside(work->d[node]));
        float both = 0, seen = 0;
        for (int i = 0; i < GROUND_PLACES; i++) {
            Vec3f foot = place_of(work, i, GROUND_SIDE, (uint64_t)from_top);
            seen += through[node][i] = through_from_ground(&way, foot);
            both += through[node][i] * through_from_ground(&near, foot);
        }
        work->ground_beside[from_top][node] = seen > 0 ? both / seen : 1;
    }
    for (int eye = 0; eye < PAIR_NODES; eye++)
        for (int light = 0; light < PAIR_NODES; light++) {
            float both = 0, seen = 0, truth = work->open[eye * PAIR_NODES + light];
            for (int i = 0; i < GROUND_PLACES; i++) both += through[eye][i] * through[light][i], seen += through[eye][i];
            float spot = float_min(0.9f, voxel_layer_spot(layer, work->d[eye], work->d[light])); /* is added when the power is used */
            if (truth >= 0) truth = float_max(0, (truth - spot) / (1 - spot));
            if (seen > 0 && truth >= 0) layer->pairs.ground[from_top][eye * PAIR_NODES + light] = less_certain(power_code(truth, both / seen), certainty(work->truth->triangles));
        }
}

static void find_powers(void *context, size_t number, int worker) {
    (void)worker;
    int from_top = (int)number / (PAIR_NODES + 1), node = (int)number % (PAIR_NODES + 1);
    if (node < PAIR_NODES) find_matter_powers(context, from_top, node);
    else find_ground_powers(context, from_top);
}

/* Where eye and light are nearly one, what holds a little beside that is taken for all directions. */
static void lay_peak(uint8_t *codes, float lit, const float beside[PAIR_NODES], float certain) {
    float mean = 0;
    for (int node = 0; node < PAIR_NODES; node++) mean += beside[node] / PAIR_NODES;
    for (int node = 0; node < PAIR_NODES; node++) {
        uint8_t *code = &codes[node * PAIR_NODES + node];
        *code = (uint8_t)lrintf(certain * (float)power_code(lit, mean) + (1 - certain) * (float)*code);
    }
}

/* Where eye and light look along one line the share that is lit has a peak far narrower than the way to the next node, which the spot tells of: the
 * entry gets the mean of those around it. */
static void flatten_peak(uint8_t *codes) {
    for (int node = 0; node < PAIR_NODES; node++) {
        int column = node % PAIR_SIDE, row = node / PAIR_SIDE, count = 0, sum = 0;
        for (int i = 0; i < 4; i++) {
            int x = column + (i == 0) - (i == 1), z = row + (i == 2) - (i == 3), other = z * PAIR_SIDE + x;
            if (x < 0 || x >= PAIR_SIDE || z < 0 || z >= PAIR_SIDE) continue;
            sum += codes[node * PAIR_NODES + other] + codes[other * PAIR_NODES + node];
            count += 2;
        }
        codes[node * PAIR_NODES + node] = (uint8_t)((sum + count / 2) / count);
    }
}

void voxel_layer_forget_powers(VoxelLayer *layer) {
    memset(layer->pairs.matter, POWER_ONE, sizeof layer->pairs.matter);
    memset(layer->pairs.ground, POWER_ONE, sizeof layer->pairs.ground);
}

bool voxel_layer_find_powers(VoxelLayer *layer, const LitTruth *truth, Vec3f extent, int levels, Pool *pool) {
    PowerWork work = {.layer = layer, .truth = truth, .extent = extent};
    voxel_layer_forget_powers(layer);
    for (int i = 0; i < PAIR_NODES; i++) work.d[i] = vec3f_normalize(vec3f(truth->views[i].slope_x, 1, truth->views[i].slope_z));
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) work.open[i] = pair_open(&truth->views[i / PAIR_NODES], &truth->views[i % PAIR_NODES], truth->grid);
    bool done = pool_run(pool, (size_t)(levels * (PAIR_NODES + 1)), find_powers, &work);
    for (int i = 0; i < levels; i++) {
        lay_peak(layer->pairs.matter[i], truth->lit_beside, work.matter_beside[i], 1);
        flatten_peak(layer->pairs.ground[i]);
        if (truth->open_beside >= 0) lay_peak(layer->pairs.ground[i], truth->open_beside, work.ground_beside[i], certainty(truth->triangles));
    }
    return done;
}

/* ---- reading ---- */

static float power_at(const VoxelLayer *layer, const uint8_t (*codes)[PAIR_NODES * PAIR_NODES], float lod, Vec3f to_eye, Vec3f to_light) {
    float from_top = float_clamp((float)(layer->levels - 1) - lod, 0, TRIM_LEVELS - 1);
    PairPlace place;
    if (!pair_place(to_eye, to_light, &place)) return 1;
    int level = int_min((int)from_top, TRIM_LEVELS - 2);
    float t = from_top - (float)level, sum = 0;
    for (int i = 0; i < PAIR_CORNERS; i++)
        sum += place.weight[i] * ((1 - t) * (float)codes[level][place.entry[i]] + t * (float)codes[level + 1][place.entry[i]]);
    return exp2f((sum - POWER_ONE) / POWER_STEPS);
}

float voxel_layer_matter_power(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light) {
    return power_at(layer, layer->pairs.matter, lod, to_eye, to_light);
}

float voxel_layer_ground_power(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light) {
    return power_at(layer, layer->pairs.ground, lod, to_eye, to_light);
}
