#include "texel/voxel_lit.h"

#include "base/random.h"
#include "texel/light_share.h"
#include "texel/opacity.h"
#include "texel/visible_normals.h"
#include "texel/voxel_trim.h"

#include <math.h>
#include <string.h>

/* Rays along each direction to the eye, the fewer the finer voxels are; places on the ground, on lattices; steps along them in voxels, and at most. */
enum { MOST_EYE_SIDE = 10, MOST_EYE_RAYS = MOST_EYE_SIDE * MOST_EYE_SIDE, GROUND_SIDE = 8, GROUND_PLACES = GROUND_SIDE * GROUND_SIDE, MOST_LIT_STEPS = 512 };
/* As the renderer steps: in voxels, to the eye and to the light, and in heights of the layer. */
static const float EYE_STEP = 1.6f, LIT_STEP = 2, LAYER_STEP = 0.3f;
/* Where the renderer's shadows take voxels of some level, the eye's are finer by so many: by the eye's levels powers for matter are kept. */
static const float FINER_TO_EYE = 1.5f;
/* Cones of the eye that are thinner than the finest voxels are followed by the light's, until these are, too, so many levels later. */
enum { LEVELS_BEYOND = 2 };
/* Light that is less than this makes no difference. */
static const float DARK_BELOW = 1.0f / 256;
/* Shares are held within these before they are compared. */
static const float LEAST_SHARE = 0.005f, MOST_SHARE = 0.995f;
/* What so many triangles tell counts half: of gaps and of normals, and of how much is lit. */
static const float SOME_TRIANGLES = 2000, FEW_TRIANGLES = 40;
static const int EYE_SIDES[TRIM_LEVELS] = {5, 5, 5, 4, 4, 3, 3};
/* Of so many triangles, which take far longer by themselves, there are twice as many rays each way. */
enum { MANY_TRIANGLES = 20000 };
/* The other side counts as most materials have it that let light through. */
static const float SIDE_WEIGHT[2] = {1, 0.5f};
/* Less light than this, of the most that could fall there, needs no factor. */
static const float LEAST_FACING = 0.01f;
/* A power, or a factor, is 2^((code − POWER_ONE) / POWER_STEPS). */
enum { POWER_ONE = 128, POWER_STEPS = 32 };

/* Through the layer along a direction, over and over as if copies lay side by side. */
typedef struct LitWay {
    const LitLayers *among;
    Vec3f extent, d; /* unit */
    float lod, h, step;
} LitWay;

static LitWay way_along(const LitLayers *among, float lod, Vec3f d, float voxels) {
    Vec3f extent = among->extent;
    float h = exp2f(lod) / among->layers[0]->level[0].density_unit, way = extent.y / d.y;
    return (LitWay){among, extent, d, lod, h, float_clamp(voxels * h, way / MOST_LIT_STEPS, LAYER_STEP * way)};
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
    LitStep step = {0, 0, 0};
    for (size_t k = 0; k < w->among->count; k++) {
        const VoxelLayer *layer = w->among->layers[k];
        if (!voxel_layer_sample_lod(layer, w->lod, p, &v)) continue;
        float area = opacity_area(&v, along);
        step.depth += opacity_depth(OPACITY_CORRELATED, &v, w->h, along) * voxel_layer_trim_at(layer, w->lod, along);
        step.area += area;
        step.gamma_area += area * (v.gamma + v.solid * (1 - v.gamma));
    }
    return step;
}

/* What a ray from the eye to a place on the ground sees of the layer, and where the share `part` of that has been met. */
static float look_down(const LitWay *w, Vec3f foot, float part, Vec3f *seen) {
    int steps = int_clamp((int)ceilf(w->extent.y / (w->d.y * w->step)), 1, MOST_LIT_STEPS);
    float length = w->extent.y / (w->d.y * (float)steps), through = 1, met[MOST_LIT_STEPS];
    int last = steps;
    for (int i = steps - 1; i >= 0 && through > DARK_BELOW; i--) {
        through *= expf(-step_at(w, vec3f_madd(foot, w->d, ((float)i + 0.5f) * length), length).depth);
        met[last = i] = 1 - through;
    }
    int at = steps - 1;
    while (at > last && met[at] < part * (1 - through)) at--;
    *seen = vec3f_madd(foot, w->d, ((float)at + 0.5f) * length);
    return 1 - through;
}

/* The share of a light that comes to matter at p, as the renderer has it. */
static float light_at(const LitWay *w, Vec3f p, float facing) {
    float reach = (float)LIGHT_SURROUNDINGS * w->h, back = float_min(reach, p.y / w->d.y), end = (w->extent.y - p.y) / w->d.y;
    LightSurroundings around = {.facing = facing};
    float rest = 0, gamma_area = 0;
    for (float t = -back; t < end && rest < LIGHT_DEEPEST; t += w->step) {
        float length = float_min(w->step, end - t), within = float_clamp(reach - t, 0, length) / length;
        LitStep s = step_at(w, vec3f_madd(p, w->d, t + length / 2), length);
        around.depth += s.depth * within;
        around.area += s.area * within;
        gamma_area += s.gamma_area * within;
        around.before += s.area * float_clamp(within - float_max(0, -t) / length, 0, 1);
        rest += s.depth * (1 - within);
    }
    around.sheet = around.area > 0 ? float_clamp(gamma_area / (LIGHT_SHEET_GAMMA * around.area), 0, 1) : 0;
    return light_share(&around) * expf(-float_min(rest, LIGHT_DEEPEST));
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
    VoxelLayer *layer; /* that keeps them */
    const LitTruth *truth;
    const LitLayers *among;
    Vec3f d[PAIR_NODES];
    float open[PAIR_NODES * PAIR_NODES]; /* pair_opens() */
    float matter_beside[TRIM_LEVELS][PAIR_NODES], ground_beside[TRIM_LEVELS][PAIR_NODES]; /* the share that is lit, the light beside the eye, by its direction */
} PowerWork;

static uint8_t power_code(float truth, float share) {
    float power = logf(float_clamp(truth, LEAST_SHARE, MOST_SHARE)) / logf(float_clamp(share, LEAST_SHARE, MOST_SHARE));
    return (uint8_t)int_clamp((int)lrintf(POWER_ONE + POWER_STEPS * log2f(power)), 0, 255);
}

/* Gaps between few pieces coincide, or exclude each other, in some directions and not in those between. */
static float certainty(size_t triangles, float half) { return (float)triangles / ((float)triangles + half); }

static uint8_t less_certain(uint8_t code, float certain) { return (uint8_t)lrintf(POWER_ONE + certain * ((float)code - POWER_ONE)); }

/* On a lattice, each moved by lot. */
static Vec3f place_of(const PowerWork *work, int i, int side, uint64_t lot) {
    uint64_t bits = random_hash(lot, (uint64_t)i, 1, 0);
    return vec3f(work->among->extent.x * ((float)(i % side) + random_unitf(bits)) / (float)side, 0,
                 work->among->extent.z * ((float)(i / side) + random_unitf(random_mix(bits))) / (float)side);
}

/* Places that are seen along a direction, one of each ray. */
typedef struct LitPlaces {
    int count;
    float weight[MOST_EYE_RAYS], all;                /* how much of the ray's way is hidden there; their sum */
    float share[PAIR_NODES + 1][MOST_EYE_RAYS];      /* of each light, the last of which lies beside the eye */
    float facing[2][PAIR_NODES][MOST_EYE_RAYS];      /* as PairShade */
} LitPlaces;

/* Of the light on what S stands for, seen from the unit direction `eye`, what falls on either side: over eight normals on each of two rings. Adds `share`
 * of it. */
static void face_lights(const Sym3f *s, float share, Vec3f eye, const Vec3f *lights, int at, float facing[2][PAIR_NODES][MOST_EYE_RAYS]) {
    enum { RING = 8 };
    static const float radius[2] = {0.45970084f, 0.88807383f};
    VisibleNormals visible = visible_normals(s, eye);
    for (int i = 0; i < 2 * RING; i++) {
        float r = radius[i / RING], angle = (float)VTS_PI / RING * (float)(2 * (i % RING) + i / RING);
        Vec3f n = vec3f_add(vec3f_scale(visible.m[0], r * cosf(angle)), vec3f_scale(visible.m[1], r * sinf(angle)));
        n = vec3f_normalize(vec3f_madd(n, visible.m[2], sqrtf(1 - r * r)));
        for (int light = 0; light < PAIR_NODES; light++) {
            float cosine = vec3f_dot(n, lights[light]);
            facing[cosine < 0][light][at] += share * fabsf(cosine) / (2 * RING);
        }
    }
}

/* Of all layers, as much as each hides there. */
static void face_all(const LitWay *to_eye, Vec3f p, const Vec3f *lights, int at, float facing[2][PAIR_NODES][MOST_EYE_RAYS]) {
    float whole = step_at(to_eye, p, to_eye->step).depth;
    VoxelSample v;
    for (int light = 0; light < PAIR_NODES; light++) facing[0][light][at] = facing[1][light][at] = 0;
    p.x = wrapped_to(p.x, to_eye->extent.x), p.z = wrapped_to(p.z, to_eye->extent.z);
    for (size_t k = 0; k < to_eye->among->count && whole > 0; k++) {
        const VoxelLayer *layer = to_eye->among->layers[k];
        Vec3f along = vec3f_scale(to_eye->d, to_eye->step);
        if (!voxel_layer_sample_lod(layer, to_eye->lod, p, &v)) continue;
        face_lights(&v.s, opacity_depth(OPACITY_CORRELATED, &v, to_eye->h, along) * voxel_layer_trim_at(layer, to_eye->lod, along) / whole, to_eye->d, lights, at, facing);
    }
}

static void find_places(const PowerWork *work, int from_top, int eye, LitPlaces *out) {
    float top = (float)(work->layer->levels - 1), wanted = top - (float)from_top, lod = float_max(0, wanted);
    Vec3f d = work->d[eye], beside = pair_direction_beside(d, true);
    LitWay to_eye = way_along(work->among, lod, d, EYE_STEP);
    out->count = 0, out->all = 0;
    int side = EYE_SIDES[from_top] * (work->truth->triangles > MANY_TRIANGLES ? 2 : 1);
    for (int ray = 0; ray < side * side; ray++) {
        Vec3f at = {0, 0, 0};
        uint64_t lot = (uint64_t)(ray + MOST_EYE_RAYS * (from_top + TRIM_LEVELS * eye));
        float part = (float)((ray + 1) * 0.6180339887 - floor((ray + 1) * 0.6180339887));
        float weight = look_down(&to_eye, place_of(work, ray, side, lot), part, &at);
        if (!(weight > 0)) continue;
        float coarser = float_clamp(floorf(wanted + FINER_TO_EYE) + (float)(ray & 1), 0, top); /* by turns, which is half of the work of both */
        for (int light = 0; light <= PAIR_NODES; light++) {
            LitWay way = way_along(work->among, coarser, light < PAIR_NODES ? work->d[light] : beside, LIT_STEP);
            out->share[light][out->count] = light_at(&way, at, light_facing(vec3f_dot(d, way.d)));
        }
        face_all(&to_eye, at, work->d, out->count, out->facing);
        out->all += out->weight[out->count++] = weight;
    }
}

/* Of the other side so much as is of `sheets`: the rest is dark whatever the power is. */
static float weighted_sides(const float value[2], float sheets) { return SIDE_WEIGHT[0] * value[0] + SIDE_WEIGHT[1] * sheets * value[1]; }

/* How much comes of the light on what is seen, as that faces it, with shares taken to a power. */
static float mean_share(const LitPlaces *p, int light, float sheets, float power) {
    float sum = 0, most = 0;
    for (int i = 0; i < p->count; i++) {
        const float sides[2] = {p->facing[0][light][i], p->facing[1][light][i]};
        float weight = p->weight[i] * weighted_sides(sides, sheets);
        sum += weight * powf(p->share[light][i], power), most += weight;
    }
    return most > 0 ? sum / most : -1;
}

/* The power that brings it to what the triangles say: the mean falls with it, about as its own power does. */
static uint8_t find_power(const LitPlaces *p, int light, const PairShade *truth) {
    enum { TRIES = 3 };
    /* Of the other side all that comes there is on sheets. */
    float came = SIDE_WEIGHT[0] * truth->facing[0] * truth->lit[0] + SIDE_WEIGHT[1] * truth->facing[1] * truth->lit[1];
    float facing = weighted_sides(truth->facing, truth->sheets), code = POWER_ONE;
    for (int i = 0; i < TRIES && facing > 0; i++) {
        float mean = mean_share(p, light, truth->sheets, exp2f((code - POWER_ONE) / POWER_STEPS));
        if (mean < 0) break;
        code = float_clamp(code + (float)(power_code(came / facing, mean) - POWER_ONE), 0, 255);
    }
    return (uint8_t)lrintf(code);
}

static float factor_of(int code) { return exp2f((float)(code - POWER_ONE) / POWER_STEPS); }

static uint8_t factor_code(float factor) { return (uint8_t)int_clamp((int)lrintf(POWER_ONE + POWER_STEPS * log2f(factor)), 0, 255); }

/* What then is missing of the light on a side; of the other one sheets have it all, which is certain. */
static uint8_t find_factor(const LitPlaces *p, int light, const PairShade *truth, int side, float power, float certain) {
    float sum = 0, sheets = side ? truth->sheets : 1;
    for (int i = 0; i < p->count; i++) sum += p->weight[i] * p->facing[side][light][i] * powf(p->share[light][i], power);
    uint8_t code = less_certain(factor_code((truth->facing[side] * truth->lit[side] + LEAST_FACING) / (sheets * sum / p->all + LEAST_FACING)), certain);
    return factor_code(factor_of(code) * float_max(sheets, LEAST_SHARE));
}

static float mean_beside(const LitPlaces *p) {
    float sum = 0;
    for (int i = 0; i < p->count; i++) sum += p->weight[i] * p->share[PAIR_NODES][i];
    return p->count ? sum / p->all : 1;
}

static void find_matter_powers(PowerWork *work, int from_top, int eye) {
    VoxelPairs *pairs = &work->layer->pairs;
    LitPlaces places;
    find_places(work, from_top, eye, &places);
    work->matter_beside[from_top][eye] = mean_beside(&places);
    for (int light = 0; light < PAIR_NODES && places.count; light++) {
        int entry = eye * PAIR_NODES + light;
        const PairShade *truth = &work->truth->shades[entry];
        pairs->matter[from_top][entry] = less_certain(find_power(&places, light, truth), certainty(work->truth->triangles, FEW_TRIANGLES));
        float power = factor_of(pairs->matter[from_top][entry]);
        for (int side = 0; side < 2; side++) pairs->facing[side][from_top][entry] = find_factor(&places, light, truth, side, power, certainty(work->truth->triangles, SOME_TRIANGLES));
    }
}

static void find_ground_powers(PowerWork *work, int from_top) {
    VoxelLayer *layer = work->layer;
    float lod = (float)(layer->levels - 1 - from_top), through[PAIR_NODES][GROUND_PLACES];
    for (int node = 0; node < PAIR_NODES; node++) {
        LitWay way = way_along(work->among, lod, work->d[node], LIT_STEP), near = way_along(work->among, lod, pair_direction_beside(work->d[node], true), LIT_STEP);
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
            if (seen > 0 && truth >= 0) layer->pairs.ground[from_top][eye * PAIR_NODES + light] = less_certain(power_code(truth, both / seen), certainty(work->truth->triangles, SOME_TRIANGLES));
        }
}

static void find_powers(void *context, size_t number, int worker) {
    (void)worker;
    PowerWork *work = context;
    int from_top = (int)number / (PAIR_NODES + 1), node = (int)number % (PAIR_NODES + 1);
    if (node < PAIR_NODES) find_matter_powers(work, from_top, node);
    else if (from_top < work->layer->levels) find_ground_powers(work, from_top);
}

/* What voxels make of the share that is lit a little beside the eye at a height, beside[]. */
static float share_beside(const uint8_t *codes, const float beside[PAIR_NODES], int height) {
    int first = height ? 1 + (height - 1) * PAIR_RING : 0, count = height ? PAIR_RING : 1;
    float mean = 0;
    for (int node = first; node < first + count; node++) mean += powf(beside[node], factor_of(codes[node * PAIR_NODES + node])) / (float)count;
    return mean;
}

/* Of the peaks that bring it to the truth. */
static void find_widths(PairWidths *out, const PairWidths *truth, const uint8_t *codes, const float beside[PAIR_NODES]) {
    for (int h = 0; h < PAIR_HEIGHTS; h++)
        for (int around = 0; around < 2; around++) out->at[around][h] = pair_peak_width(truth->at[around][h], share_beside(codes, beside, h));
}

/* Where eye and light look along one line the share that is lit has a peak far narrower than the way to the next node, which is kept by itself: the
 * entry gets the mean of those around it. */
static void flatten_peak(uint8_t *codes) {
    for (int node = 0; node < PAIR_NODES; node++) {
        int around[PAIR_MOST_NEIGHBOURS], count = pair_neighbours(node, around), sum = 0;
        for (int i = 0; i < count; i++) sum += codes[node * PAIR_NODES + around[i]] + codes[around[i] * PAIR_NODES + node];
        codes[node * PAIR_NODES + node] = (uint8_t)((sum + count) / (2 * count));
    }
}

void voxel_layer_forget_powers(VoxelLayer *layer) {
    memset(layer->pairs.matter, POWER_ONE, sizeof layer->pairs.matter);
    memset(layer->pairs.ground, POWER_ONE, sizeof layer->pairs.ground);
    memset(layer->pairs.facing, POWER_ONE, sizeof layer->pairs.facing);
}

bool voxel_layer_find_powers(VoxelLayer *layer, const LitTruth *truth, const LitLayers *among, int levels, Pool *pool) {
    PowerWork work = {.layer = layer, .truth = truth, .among = among};
    voxel_layer_forget_powers(layer);
    for (int i = 0; i < PAIR_NODES; i++) work.d[i] = pair_direction(i);
    if (!pair_opens(truth->views, PAIR_NODES, truth->grid, work.open)) return false;
    int known = levels == layer->levels ? int_min(levels + LEVELS_BEYOND, TRIM_LEVELS) : levels;
    bool done = pool_run(pool, (size_t)(known * (PAIR_NODES + 1)), find_powers, &work);
    for (int i = 0; i < known; i++) {
        flatten_peak(layer->pairs.matter[i]);
        find_widths(&layer->pairs.peak[0][i], &truth->beside->lit, layer->pairs.matter[i], work.matter_beside[i]);
        for (int side = 0; side < 2; side++) flatten_peak(layer->pairs.facing[side][i]);
        flatten_peak(layer->pairs.ground[i]);
        if (i < levels) find_widths(&layer->pairs.peak[1][i], &truth->beside->open, layer->pairs.ground[i], work.ground_beside[i]);
    }
    return done;
}

/* ---- reading ---- */

typedef uint8_t PairCodes[PAIR_NODES * PAIR_NODES];

/* A level of the tables, and how far it is on the way to the next. */
static int level_at(const VoxelLayer *layer, float lod, float *part) {
    int known = int_min(layer->levels + LEVELS_BEYOND, TRIM_LEVELS);
    float from_top = float_clamp((float)(layer->levels - 1) - lod, 0, (float)(known - 1));
    int level = int_clamp((int)from_top, 0, TRIM_LEVELS - 2);
    *part = from_top - (float)level;
    return level;
}

static float power_at(const VoxelLayer *layer, const PairCodes *codes, float lod, const PairPlace *place) {
    float t, sum = 0;
    int level = level_at(layer, lod, &t);
    for (int i = 0; i < PAIR_CORNERS; i++)
        sum += place->weight[i] * ((1 - t) * (float)codes[level][place->entry[i]] + t * (float)codes[level + 1][place->entry[i]]);
    return exp2f((sum - POWER_ONE) / POWER_STEPS);
}

static float peak_at(const VoxelLayer *layer, const PairWidths peak[TRIM_LEVELS], float lod, Vec3f to_eye, Vec3f to_light) {
    PairWidths width;
    float t;
    int level = level_at(layer, lod, &t);
    for (int h = 0; h < PAIR_HEIGHTS; h++)
        for (int k = 0; k < 2; k++) width.at[k][h] = (1 - t) * peak[level].at[k][h] + t * peak[level + 1].at[k][h];
    return pair_peak(&width, to_eye, to_light);
}

float voxel_layer_light_on_matter(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float share) {
    PairPlace place;
    lod -= FINER_TO_EYE;
    if (!pair_place(to_eye, to_light, &place)) return share;
    share = powf(share, power_at(layer, layer->pairs.matter, lod, &place));
    return share + (1 - share) * peak_at(layer, layer->pairs.peak[0], lod, to_eye, to_light);
}

float voxel_layer_light_on_ground(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float through) {
    PairPlace place;
    lod = float_max(lod, 0);
    if (!pair_place(to_eye, to_light, &place)) return through;
    through = powf(through, power_at(layer, layer->pairs.ground, lod, &place));
    return through + (1 - through) * peak_at(layer, layer->pairs.peak[1], lod, to_eye, to_light);
}

void voxel_layer_facing(const VoxelLayer *layer, float lod, Vec3f to_eye, Vec3f to_light, float factor[2]) {
    PairPlace place;
    bool known = pair_place(to_eye, to_light, &place);
    for (int side = 0; side < 2; side++) factor[side] = known ? power_at(layer, layer->pairs.facing[side], lod, &place) : 1;
}
