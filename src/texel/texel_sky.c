#include "texel/texel_sky.h"

#include "texel/sky_powers.h"
#include "texel/voxel_layer.h"
#include "texel/voxel_trim.h"

#include <math.h>
#include <stdlib.h>

/* Second-order fits are smooth, and so is the sky's light: a few thousand places are enough. */
enum { MOST_CELLS = 8192, DIRECTIONS = 32, MOST_STEPS = 96 };
enum { SKY_EMPTY = 0, SKY_ASKED = 1, SKY_FIRST_ROUND = 2 };
enum { VIEW_NUMBERS = 10 }; /* mean, first, second: xx yy zz xy xz yz */
/* Numbers of a view are within ±3 (7.5 times a mean of products below 0.4). */
static const float VIEW_UNIT = 1.0f / 8192;

/* Voxels grow by this per length of the way: somewhat narrower than the thirtieth of the sphere that a direction stands for. */
static const float CONE_GROWTH = 0.2f;
static const float FIRST_VOXELS = 2.5f, STEP_VOXELS = 1.2f, LAYER_SHARE = 0.3f;
static const float DARK = 1.0f / 256;

struct TexelSky {
    int size[3];
    float per_side[3];
    bool repeated[3];
    int16_t (*views)[VIEW_NUMBERS];
    float power[PAIR_NODES]; /* of the share that is seen, by direction to the eye */
    MemoryBudget *memory;
    size_t bytes;
};

/* ---- building ---- */

typedef struct SkyBuild {
    const VoxelLayer *const *layers;
    size_t count;
    const TexelSkyOptions *options;
    TexelSky *sky;
    float extent[3], finest; /* side of the finest voxels, geometric mean */
    float longest_finest;    /* along the longest side, as opacity.h wants it */
    int level;               /* whose voxels are the cells */
    uint16_t *rank;          /* of each cell: SKY_EMPTY, SKY_ASKED, or the round in which it was filled */
    uint16_t round;
    size_t asked, filled;    /* cells with matter; those that this round filled */
    Vec3f direction[DIRECTIONS];
} SkyBuild;

/* The corners of an icosahedron and those of a dodecahedron: means over each are exact for polynomials up to the fifth degree, so
 * that products of second-order functions come out right. Turned, so that none lies in a plane of the grid. */
static void spread_directions(Vec3f out[DIRECTIONS]) {
    const double golden = (1 + sqrt(5.0)) / 2;
    const double rings[3][3] = {{0, 1, golden}, {1, 1, 1}, {0, 1 / golden, golden}};
    int count = 0;
    Vec3 turned[3];
    turned[0] = vec3_normalize(vec3(0.81, 0.37, -0.45));
    vec3_frame(turned[0], &turned[1], &turned[2]);
    for (int ring = 0; ring < 3; ring++)
        for (int signs = 0; signs < 8; signs++)
            for (int turn = 0; turn < 3; turn++) {
                double v[3];
                bool again =
                    ring == 1 ? turn > 0 : (signs & 1) != 0; /* −0 is 0, and <1, 1, 1> turned is itself */
                if (again) continue;
                for (int k = 0; k < 3; k++)
                    v[(k + turn) % 3] = signs >> k & 1 ? -rings[ring][k] : rings[ring][k];
                Vec3 d = vec3_madd(vec3_madd(vec3_scale(turned[0], v[0]), turned[1], v[1]), turned[2], v[2]);
                out[count++] = vec3f_from(vec3_normalize(d));
            }
}

/* p moved into the extent along repeated axes; false where it is outside along another. */
static bool bring_inside(const SkyBuild *b, float p[3]) {
    for (int k = 0; k < 3; k++) {
        if (b->sky->repeated[k])
            p[k] -= floorf(p[k] / b->extent[k]) * b->extent[k];
        else if (!(p[k] >= 0 && p[k] <= b->extent[k]))
            return false;
    }
    return true;
}

static float depth_of_step(const SkyBuild *b, float lod, Vec3f at, Vec3f step) {
    float depth = 0, h = b->longest_finest * exp2f(lod);
    for (size_t i = 0; i < b->count; i++) {
        VoxelSample v;
        if (!voxel_layer_sample_lod(b->layers[i], lod, at, &v)) continue;
        float own = b->options->opacity == OPACITY_MEAN ? opacity_depth_mean(&v, b->longest_finest, h, step)
                                                        : opacity_depth(b->options->opacity, &v, h, step);
        depth += b->options->opacity == OPACITY_CORRELATED ? own * voxel_layer_trim_at(b->layers[i], lod, step) : own;
    }
    return depth;
}

/* Along a widening cone to the outside; a layer without end is dark in its own plane. */
static float march_out(const SkyBuild *b, const float from[3], Vec3f d) {
    const float along[3] = {d.x, d.y, d.z};
    float depth = 0, t = FIRST_VOXELS * b->finest, top = (float)(b->layers[0]->levels - 1),
          longest = INFINITY;
    for (int k = 0; k < 3; k++)
        if (!b->sky->repeated[k] && along[k] != 0)
            longest = float_min(longest, LAYER_SHARE * b->extent[k] / fabsf(along[k]));
    for (int i = 0; i < MOST_STEPS; i++) {
        float voxel = float_max(b->finest, CONE_GROWTH * t), step = float_min(STEP_VOXELS * voxel, longest),
              p[3];
        for (int k = 0; k < 3; k++) p[k] = from[k] + (t + step / 2) * along[k];
        if (!bring_inside(b, p)) break;
        float lod = float_min(nearbyintf(log2f(voxel / b->finest)), top); /* one level: steps are as long as its voxels anyway */
        depth += depth_of_step(b, lod, vec3f(p[0], p[1], p[2]), vec3f_scale(d, step));
        if (depth > -logf(DARK)) return 0;
        t += step;
    }
    return expf(-depth);
}

/* Area of all layers in a voxel, but for a factor that is the level's. */
static float matter_of_voxel(const SkyBuild *b, int level, const int at[3]) {
    float sum = 0;
    for (size_t i = 0; i < b->count; i++) {
        const VoxelLevel *l = &b->layers[i]->level[level];
        int32_t index =
            l->index[voxel_level_brick_at(l, at[0] / BRICK_SIDE, at[1] / BRICK_SIDE, at[2] / BRICK_SIDE)];
        if (index < 0) continue;
        const VoxelBrick *brick = &l->bricks[index];
        int z = at[2] & (BRICK_SIDE - 1),
            bit = BRICK_SIDE * (at[1] & (BRICK_SIDE - 1)) + (at[0] & (BRICK_SIDE - 1));
        uint64_t slice = brick->slice[z], below = ((uint64_t)1 << bit) - 1;
        if (slice >> bit & 1)
            sum += voxel_code_density(l->codes[brick->first[z] + count_bits(slice & below)].rest);
    }
    return sum;
}

/* The child of a voxel that a share u of the matter in it falls to; u becomes the share within the child. */
static void pick_child(const SkyBuild *b, int level, int at[3], float *u) {
    int first[3], halves[3], best[3] = {0, 0, 0};
    float shares[8], sum = 0;
    for (int k = 0; k < 3; k++) {
        halves[k] = voxel_layer_halves(b->layers[0], level - 1, k) ? 2 : 1;
        first[k] = at[k] * halves[k];
    }
    int count = halves[0] * halves[1] * halves[2];
    for (int i = 0; i < count; i++) {
        const int child[3] = {first[0] + i % halves[0], first[1] + i / halves[0] % halves[1],
                              first[2] + i / halves[0] / halves[1]};
        sum += shares[i] = matter_of_voxel(b, level - 1, child);
    }
    float rest = *u * sum;
    for (int i = 0; i < count; i++) {
        if (!(shares[i] > 0)) continue;
        best[0] = first[0] + i % halves[0], best[1] = first[1] + i / halves[0] % halves[1],
        best[2] = first[2] + i / halves[0] / halves[1];
        *u = float_clamp(rest / shares[i], 0, 1);
        if (rest < shares[i]) break;
        rest -= shares[i];
    }
    for (int k = 0; k < 3; k++) at[k] = sum > 0 ? best[k] : first[k];
}

/* A place in a cell: in matter, if there is any, as often as there is matter. On the matter itself, since what is a voxel beside a leaf
 * is in that leaf's shade as the leaf is not. */
static void pick_place(const SkyBuild *b, const int cell[3], int number, float out[3]) {
    int at[3] = {cell[0], cell[1], cell[2]}, level = b->level;
    float u = (float)(number * 0.6180339887 - floor(number * 0.6180339887));
    bool any = matter_of_voxel(b, level, at) > 0;
    for (; any && level > 0; level--) pick_child(b, level, at, &u);
    for (int k = 0; k < 3; k++) out[k] = ((float)at[k] + 0.5f) * b->layers[0]->level[level].sides[k];
}

static void store_view(const SkyBuild *b, size_t cell, const float v[DIRECTIONS]) {
    float sums[VIEW_NUMBERS] = {0};
    for (int i = 0; i < DIRECTIONS; i++) {
        Vec3f d = b->direction[i];
        float s = v[i] / DIRECTIONS;
        const float products[VIEW_NUMBERS] = {1,
                                              3 * d.x,
                                              3 * d.y,
                                              3 * d.z,
                                              7.5f * (d.x * d.x - 1.0f / 3),
                                              7.5f * (d.y * d.y - 1.0f / 3),
                                              7.5f * (d.z * d.z - 1.0f / 3),
                                              7.5f * d.x * d.y,
                                              7.5f * d.x * d.z,
                                              7.5f * d.y * d.z};
        for (int k = 0; k < VIEW_NUMBERS; k++) sums[k] += s * products[k];
    }
    for (int k = 0; k < VIEW_NUMBERS; k++)
        b->sky->views[cell][k] = (int16_t)lrintf(float_clamp(sums[k], -3.9f, 3.9f) / VIEW_UNIT);
}

/* ---- which cells are asked ---- */

static size_t sky_cell(const TexelSky *sky, const int at[3]) { return ((size_t)at[2] * (size_t)sky->size[1] + (size_t)at[1]) * (size_t)sky->size[0] + (size_t)at[0]; }

/* The cell `by` away from a cell; false beyond the end. */
static bool sky_neighbour(const TexelSky *sky, const int at[3], const int by[3], size_t *out) {
    int there[3];
    for (int k = 0; k < 3; k++) {
        there[k] = at[k] + by[k];
        if (sky->repeated[k]) there[k] &= sky->size[k] - 1;
        if (there[k] < 0 || there[k] >= sky->size[k]) return false;
    }
    *out = sky_cell(sky, there);
    return true;
}

typedef void (*SkyVisit)(SkyBuild *b, const int at[3]);

static void visit_sky_cells(SkyBuild *b, SkyVisit visit) {
    int at[3];
    for (at[2] = 0; at[2] < b->sky->size[2]; at[2]++)
        for (at[1] = 0; at[1] < b->sky->size[1]; at[1]++)
            for (at[0] = 0; at[0] < b->sky->size[0]; at[0]++) visit(b, at);
}

/* The cells between which what is read in matter is interpolated. */
static void mark_around_matter(SkyBuild *b, const int at[3]) {
    size_t other;
    if (!(matter_of_voxel(b, b->level, at) > 0)) return;
    b->asked++;
    for (int i = 0; i < 27; i++)
        if (sky_neighbour(b->sky, at, (const int[3]){i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, &other)) b->rank[other] = SKY_ASKED;
}

/* The mean of the neighbours that were known before this round. */
static void fill_from_neighbours(SkyBuild *b, const int at[3]) {
    static const int beside[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    size_t cell = sky_cell(b->sky, at), other;
    int sum[VIEW_NUMBERS] = {0}, count = 0;
    if (b->rank[cell] != SKY_EMPTY) return;
    for (int i = 0; i < 6; i++) {
        if (!sky_neighbour(b->sky, at, beside[i], &other) || b->rank[other] == SKY_EMPTY || b->rank[other] == b->round) continue;
        count++;
        for (int k = 0; k < VIEW_NUMBERS; k++) sum[k] += b->sky->views[other][k];
    }
    if (!count) return;
    b->rank[cell] = b->round;
    b->filled++;
    for (int k = 0; k < VIEW_NUMBERS; k++) b->sky->views[cell][k] = (int16_t)(sum[k] / count);
}

static void see_all(SkyBuild *b, const int at[3]) { b->sky->views[sky_cell(b->sky, at)][0] = (int16_t)lrintf(1 / VIEW_UNIT); }

/* Far from matter nobody looks, but that coarse voxels spread theirs: it has the sky of what is nearest. */
static void fill_rest(SkyBuild *b) {
    if (!b->asked) visit_sky_cells(b, see_all);
    b->round = SKY_FIRST_ROUND;
    do {
        b->filled = 0;
        visit_sky_cells(b, fill_from_neighbours);
    } while (b->filled && b->round++ < UINT16_MAX);
}

/* A row of cells along x. */
static void build_row(void *context, size_t row, int worker) {
    (void)worker;
    const SkyBuild *b = context;
    const TexelSky *sky = b->sky;
    const int y = (int)row % sky->size[1], z = (int)row / sky->size[1];
    for (int x = 0; x < sky->size[0]; x++) {
        const int at[3] = {x, y, z};
        float v[DIRECTIONS], place[3];
        if (b->rank[sky_cell(sky, at)] != SKY_ASKED) continue;
        for (int i = 0; i < DIRECTIONS; i++) {
            pick_place(b, at, i, place);
            v[i] = march_out(b, place, b->direction[i]);
        }
        store_view(b, sky_cell(sky, at), v);
    }
}

static int choose_level(const VoxelLayer *layer) {
    int level = int_min(1, layer->levels - 1);
    for (; level + 1 < layer->levels; level++) {
        const int *size = layer->level[level].size;
        if ((size_t)size[0] * (size_t)size[1] * (size_t)size[2] <= MOST_CELLS) break;
    }
    return level;
}

static TexelSky *create(const VoxelLayer *layer, int level, const TexelSkyOptions *options) {
    const VoxelLevel *l = &layer->level[level];
    size_t cells = (size_t)l->size[0] * (size_t)l->size[1] * (size_t)l->size[2],
           bytes = sizeof(TexelSky) + cells * sizeof(int16_t[VIEW_NUMBERS]);
    if (!memory_budget_take(options->memory, bytes)) return NULL;
    TexelSky *sky = calloc(1, sizeof *sky);
    if (sky) sky->views = calloc(cells, sizeof *sky->views);
    if (!sky || !sky->views) {
        memory_budget_give_back(options->memory, bytes);
        free(sky);
        return NULL;
    }
    sky->memory = options->memory;
    sky->bytes = bytes;
    for (int k = 0; k < 3; k++) {
        sky->size[k] = l->size[k];
        sky->per_side[k] = l->per_side[k];
        sky->repeated[k] = options->repeated >> k & 1;
    }
    return sky;
}

static bool find_views(SkyBuild *b) {
    const TexelSky *sky = b->sky;
    b->rank = calloc((size_t)sky->size[0] * (size_t)sky->size[1] * (size_t)sky->size[2], sizeof *b->rank);
    if (!b->rank) return false;
    visit_sky_cells(b, mark_around_matter);
    bool done = pool_run(b->options->pool, (size_t)sky->size[1] * (size_t)sky->size[2], build_row, b);
    if (done) fill_rest(b);
    free(b->rank);
    return done;
}

TexelSky *texel_sky_build(const VoxelLayer *const *layers, size_t count, const TexelSkyOptions *options) {
    if (count == 0) return NULL;
    const VoxelLevel *finest = &layers[0]->level[0];
    SkyBuild b = {.layers = layers, .count = count, .options = options, .level = choose_level(layers[0])};
    b.sky = create(layers[0], b.level, options);
    if (!b.sky) return NULL;
    for (int k = 0; k < 3; k++) b.extent[k] = finest->sides[k] * (float)finest->size[k];
    b.finest = cbrtf(finest->sides[0] * finest->sides[1] * finest->sides[2]);
    b.longest_finest = 1 / finest->density_unit;
    spread_directions(b.direction);
    for (int i = 0; i < PAIR_NODES; i++) b.sky->power[i] = 1;
    if (find_views(&b) && sky_powers_find(b.sky, layers, count, options, b.sky->power)) return b.sky;
    texel_sky_destroy(b.sky);
    return NULL;
}

void texel_sky_destroy(TexelSky *sky) {
    if (!sky) return;
    memory_budget_give_back(sky->memory, sky->bytes);
    free(sky->views);
    free(sky);
}

size_t texel_sky_bytes(const TexelSky *sky) { return sky->bytes; }

/* ---- reading ---- */

/* The two cells along an axis and the weight of the second. */
static float pair_of_cells(const TexelSky *sky, int axis, float p, int out[2]) {
    int size = sky->size[axis];
    float x = p * sky->per_side[axis] - 0.5f;
    if (!(fabsf(x) < 1e9f)) x = 0;
    if (!sky->repeated[axis]) x = float_clamp(x, 0, (float)(size - 1));
    float lower = floorf(x);
    int at = (int)lower;
    for (int i = 0; i < 2; i++)
        out[i] = sky->repeated[axis] ? (at + i) & (size - 1) : int_min(at + i, size - 1);
    return x - lower;
}

SkyView texel_sky_at(const TexelSky *sky, Vec3f p) {
    int x[2], y[2], z[2];
    float tx = pair_of_cells(sky, 0, p.x, x), ty = pair_of_cells(sky, 1, p.y, y),
          tz = pair_of_cells(sky, 2, p.z, z);
    float n[VIEW_NUMBERS] = {0};
    for (int i = 0; i < 8; i++) {
        int a = i & 1, b = i >> 1 & 1, c = i >> 2;
        const int16_t *view =
            sky->views[((size_t)z[c] * (size_t)sky->size[1] + (size_t)y[b]) * (size_t)sky->size[0] +
                       (size_t)x[a]];
        float w = (a ? tx : 1 - tx) * (b ? ty : 1 - ty) * (c ? tz : 1 - tz) * VIEW_UNIT;
        for (int k = 0; k < VIEW_NUMBERS; k++) n[k] += w * (float)view[k];
    }
    return (SkyView){
        .mean = n[0], .first = {n[1], n[2], n[3]}, .second = {n[4], n[5], n[6], n[7], n[8], n[9]}};
}

/* ---- what the eye sees ---- */

/* Two rings, at the middles of equal heights. */
static const Vec3f WAYS[SKY_WAYS] = {{0.9682458f, 0.25f, 0}, {0, 0.25f, 0.9682458f}, {-0.9682458f, 0.25f, 0}, {0, 0.25f, -0.9682458f},
                                     {0.4677072f, 0.75f, 0.4677072f}, {-0.4677072f, 0.75f, 0.4677072f}, {-0.4677072f, 0.75f, -0.4677072f}, {0.4677072f, 0.75f, -0.4677072f}};

Vec3f texel_sky_way(int i) { return WAYS[i]; }

float sky_open_to_eye(float cosine) {
    float near = 2 * cosine - 1;
    return near > 0 ? near * near : 0;
}

static float power_to_eye(const TexelSky *sky, Vec3f to_eye) {
    int node[PAIR_NODES_AROUND];
    float weight[PAIR_NODES_AROUND], power = 0;
    if (!pair_nodes_around(to_eye, node, weight)) return 1;
    for (int i = 0; i < PAIR_NODES_AROUND; i++) power += weight[i] * sky->power[node[i]];
    return power;
}

float texel_sky_seen(const TexelSky *sky, Vec3f at, const Vec3f ways[SKY_WAYS], const float gaps[SKY_WAYS], Vec3f to_eye) {
    SkyView view = texel_sky_at(sky, at);
    float sum = 0;
    for (int i = 0; i < SKY_WAYS; i++) {
        float open = sky_view_toward(&view, ways[i]);
        sum += open + (1 - open) * gaps[i];
    }
    return powf(sum / SKY_WAYS, power_to_eye(sky, to_eye));
}
