#include "texel/voxel_pairs.h"

#include "texel/voxel_lit.h"

#include <stdlib.h>

/* A surface meets its own picture on the grid beside the place that is asked for, up or down its slope by so many of the grid's sides at most; and its
 * heights are known to a part of one. */
static const float MOST_OWN = 3, LEAST_OWN = 0.05f;
/* Every so many places, along both axes, matter is asked whether it is lit. */
enum { LIT_STRIDE = 3 };
/* Widths of the spot are held below this. */
static const float WIDEST_SPOT = 2;
/* What is left of a peak a little beside it. */
static const float LEAST_LEFT = 0.02f, MOST_LEFT = 0.99f;
/* Nodes lie about as far apart at least: differences of slopes, and radians. */
static const float NODES_APART = 0.5f, NODE_ANGLE = 0.35f;

void voxel_layer_forget_pairs(VoxelLayer *layer) {
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) layer->pairs.lit[i] = -1;
    layer->pairs.spot = layer->pairs.glow = 0;
    for (int i = 0; i < TRIM_LEVELS; i++) layer->pairs.peak[0][i] = layer->pairs.peak[1][i] = 0;
    voxel_layer_forget_powers(layer);
}

bool voxel_layer_is_paired(const VoxelLayer *layer) { return layer->pairs.lit[0] >= 0 || layer->pairs.spot > 0; }

bool voxel_pairs_are_sound(const VoxelPairs *pairs) {
    bool known = pairs->lit[0] >= 0, sound = pairs->spot >= 0 && pairs->spot <= WIDEST_SPOT && pairs->glow >= 0 && pairs->glow <= WIDEST_SPOT;
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int k = 0; k < 2; k++) sound &= pairs->peak[k][i] >= 0 && pairs->peak[k][i] <= WIDEST_SPOT;
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) sound &= known ? pairs->lit[i] >= 0 && pairs->lit[i] <= 1 : pairs->lit[i] == -1;
    return sound;
}

/* ---- what the views tell ---- */

/* Adds the covariance of the gaps of two views, and what it would be if they were the same. */
static void add_covariance(const PairView *a, const PairView *b, int places, double *sum, double *most) {
    int free_a = 0, free_b = 0, both = 0;
    for (int i = 0; i < places; i++) {
        int x = a->top[i] < 0, y = b->top[i] < 0;
        free_a += x, free_b += y, both += x & y;
    }
    double per = 1.0 / places, p = free_a * per, q = free_b * per;
    *sum += both * per - p * q;
    *most += sqrt(p * (1 - p) * q * (1 - q));
}

void voxel_layer_find_spot(VoxelLayer *layer, const PairView views[SPOT_GROUPS * SPOT_VIEWS], int grid) {
    double sum = 0, most = 0;
    for (int i = 0; i < SPOT_GROUPS * SPOT_VIEWS; i++)
        if (i % SPOT_VIEWS) add_covariance(&views[i - i % SPOT_VIEWS], &views[i], grid * grid, &sum, &most);
    double correlation = most > 0 ? sum / most : 0;
    layer->pairs.spot = correlation > 1e-3 ? float_min(WIDEST_SPOT, SPOT_OFFSET / (float)-log(double_min(correlation, 0.99))) : 0;
}

/* `places` is a power of two. */
static int wrapped(float place, int places) {
    float middle = place + 0.5f;
    int whole = (int)middle;
    return (whole - ((float)whole > middle)) & (places - 1);
}

/* What is seen, and what of it is lit; by sides as PairShade. */
typedef struct LitSums {
    int seen, lit;
    float facing[2], lit_facing[2];
} LitSums;

/* A direction as (slope, 1, slope), times a normal. */
static float along(const PairView *v, const ViewNormal *n) { return (float)n->x * v->slope_x + (float)n->y + (float)n->z * v->slope_z; }

static void add_place(LitSums *sums, float to_eye, float to_light, bool is_lit) {
    int side = (to_eye < 0) != (to_light < 0);
    sums->seen++;
    sums->lit += is_lit;
    sums->facing[side] += fabsf(to_light);
    sums->lit_facing[side] += is_lit ? fabsf(to_light) : 0;
}

/* By how much the height of a plane with normal n differs at a place that lies x and z beside another. */
static float own_height(const ViewNormal *n, float to_light, float x, float z, float cell) {
    float level = -((float)n->x * x + (float)n->z * z), most = MOST_OWN * cell;
    return fabsf(level) < most * fabsf(to_light) ? level / to_light : most;
}

/* What `eye` sees lies open to `light` where in its view nothing is higher at the same place. */
static LitSums lit_sums(const PairView *eye, const PairView *light, int grid, const float size[2]) {
    float cell_x = size[0] / (float)grid, cell_z = size[1] / (float)grid, cell = float_max(cell_x, cell_z);
    float x_per = (eye->slope_x - light->slope_x) / cell_x, z_per = (eye->slope_z - light->slope_z) / cell_z;
    LitSums sums = {0};
    for (int row = 0; row < grid; row += LIT_STRIDE)
        for (int column = row / LIT_STRIDE % LIT_STRIDE; column < grid; column += LIT_STRIDE) {
            int at = row * grid + column;
            float height = eye->top[at];
            if (height < 0) continue;
            float x = (float)column + height * x_per, z = (float)row + height * z_per;
            const ViewNormal *n = &eye->normal[at];
            float to_light = along(light, n), own = own_height(n, to_light, (floorf(x + 0.5f) - x) * cell_x, (floorf(z + 0.5f) - z) * cell_z, cell);
            add_place(&sums, along(eye, n), to_light, light->top[wrapped(z, grid) * grid + wrapped(x, grid)] <= height + own + LEAST_OWN * cell);
        }
    return sums;
}

/* A bit for each of 64 places from `at` on where nothing is seen. */
static uint64_t open_places(const PairView *v, int at) {
    uint64_t bits = 0;
    for (int i = 0; i < 64; i++) bits |= (uint64_t)(v->top[at + i] < 0) << i;
    return bits;
}

bool pair_opens(const PairView *views, int count, int grid, float *open) {
    int words = grid * grid / 64;
    uint64_t *bits = malloc((size_t)(count * words) * sizeof *bits);
    for (int i = 0; bits && i < count * words; i++) bits[i] = open_places(&views[i / words], i % words * 64);
    for (int pair = 0; bits && pair < count * count; pair++) {
        const uint64_t *eye = bits + (size_t)(pair / count * words), *light = bits + (size_t)(pair % count * words);
        uint32_t seen = 0, both = 0;
        for (int i = 0; i < words; i++) seen += count_bits(eye[i]), both += count_bits(eye[i] & light[i]);
        open[pair] = seen ? (float)both / (float)seen : -1;
    }
    free(bits);
    return bits != NULL;
}

static float share_of(float part, float whole) { return whole > 0 ? part / whole : 1; }

static PairShade pair_shade(const PairView *eye, const PairView *light, int grid, const float size[2]) {
    LitSums sums = lit_sums(eye, light, grid, size);
    float unit = 127 * sqrtf(1 + light->slope_x * light->slope_x + light->slope_z * light->slope_z) * (float)int_max(sums.seen, 1);
    PairShade out = {.all = share_of((float)sums.lit, (float)sums.seen)};
    for (int side = 0; side < 2; side++) {
        out.facing[side] = sums.facing[side] / unit;
        out.lit[side] = share_of(sums.lit_facing[side], sums.facing[side]);
    }
    return out;
}

float pair_lit_beside(const PairView views[SPOT_GROUPS * SPOT_VIEWS], int grid, const float size[2]) {
    float sum = 0;
    for (int i = 0; i < SPOT_GROUPS * SPOT_VIEWS; i++)
        if (i % SPOT_VIEWS) sum += pair_shade(&views[i - i % SPOT_VIEWS], &views[i], grid, size).all + pair_shade(&views[i], &views[i - i % SPOT_VIEWS], grid, size).all;
    return sum / (2 * SPOT_GROUPS * (SPOT_VIEWS - 1));
}

float pair_open_beside(const PairView views[SPOT_GROUPS * SPOT_VIEWS], int grid) {
    float open[SPOT_VIEWS * SPOT_VIEWS], sum = 0;
    int count = 0;
    for (int i = 0; i < SPOT_GROUPS; i++) {
        if (!pair_opens(views + i * SPOT_VIEWS, SPOT_VIEWS, grid, open)) return -1;
        for (int k = 1; k < SPOT_VIEWS; k++)
            if (open[k] >= 0) sum += open[k], count++;
    }
    return count ? sum / (float)count : -1;
}

/* ---- directions ---- */

/* Of the rings, heights above the horizon, degrees. */
static const float RING_HEIGHT[1 + PAIR_RINGS] = {90, 55, 30, 14, 5};
/* Turned from the axes and diagonals of the tile, in directions: along these eye and light look down lanes between copies that go on for ever. */
static const float RING_TURN = 0.5f;

static float radians_of(float degrees) { return degrees * (float)(VTS_PI / 180); }

Vec3f pair_direction(int node) {
    float up = radians_of(RING_HEIGHT[(node + PAIR_RING - 1) / PAIR_RING]), around = (float)(2 * VTS_PI / PAIR_RING) * ((float)((node + PAIR_RING - 1) % PAIR_RING) + RING_TURN);
    return vec3f(cosf(up) * cosf(around), sinf(up), cosf(up) * sinf(around));
}

static int node_of(int ring, int around) { return ring > 0 ? 1 + (ring - 1) * PAIR_RING + (around & (PAIR_RING - 1)) : 0; }

int pair_neighbours(int node, int out[PAIR_MOST_NEIGHBOURS]) {
    int ring = (node + PAIR_RING - 1) / PAIR_RING, around = (node + PAIR_RING - 1) % PAIR_RING, count = 0;
    for (int i = 0; i < PAIR_RING && ring == 0; i++) out[count++] = node_of(1, i);
    if (ring == 0) return count;
    out[count++] = node_of(ring, around + 1);
    out[count++] = node_of(ring, around - 1);
    out[count++] = node_of(ring - 1, around);
    if (ring < PAIR_RINGS) out[count++] = node_of(ring + 1, around);
    return count;
}

/* Where eye and light look along one line all that is seen is lit; but a few degrees beside it that is over, far less than the way to the next node: the
 * entry gets the mean of those around it. */
static void flatten_peak(float *table) {
    for (int node = 0; node < PAIR_NODES; node++) {
        int around[PAIR_MOST_NEIGHBOURS], count = pair_neighbours(node, around);
        float sum = 0;
        for (int i = 0; i < count; i++) sum += table[node * PAIR_NODES + around[i]] + table[around[i] * PAIR_NODES + node];
        table[node * PAIR_NODES + node] = sum / (float)(2 * count);
    }
}

typedef struct PairWork {
    VoxelLayer *layer;
    const PairView *views;
    int grid;
    const float *size;
    PairShade *shades;
} PairWork;

static void pair_with_all(void *context, size_t eye, int worker) {
    const PairWork *work = context;
    (void)worker;
    for (size_t light = 0; light < PAIR_NODES; light++) {
        PairShade *shade = &work->shades[eye * PAIR_NODES + light];
        *shade = pair_shade(&work->views[eye], &work->views[light], work->grid, work->size);
        work->layer->pairs.lit[eye * PAIR_NODES + light] = shade->all;
    }
}

bool voxel_layer_pair(VoxelLayer *layer, const PairView views[PAIR_NODES], int grid, const float size[2], PairShade shades[PAIR_NODES * PAIR_NODES], Pool *pool) {
    PairWork work = {layer, views, grid, size, shades};
    bool done = pool_run(pool, PAIR_NODES, pair_with_all, &work);
    if (done) flatten_peak(layer->pairs.lit);
    return done;
}

/* ---- reading ---- */

/* The nodes around a direction, and their weights. */
typedef struct NodesAround {
    int node[4];
    float weight[4];
} NodesAround;

/* False below the horizon. Lower than the last ring all is as on it. */
static bool nodes_around(Vec3f d, NodesAround *out) {
    float length = vec3f_length(d);
    if (!(length > 0 && length < INFINITY) || !(d.y > 0)) return false;
    float up = asinf(float_min(1, d.y / length)) * (float)(180 / VTS_PI), turns = atan2f(d.z, d.x) * (float)(PAIR_RING / (2 * VTS_PI)) + PAIR_RING - RING_TURN;
    int ring = 0, around = (int)turns;
    while (ring + 1 < PAIR_RINGS && up < RING_HEIGHT[ring + 1]) ring++;
    float b = float_clamp((RING_HEIGHT[ring] - up) / (RING_HEIGHT[ring] - RING_HEIGHT[ring + 1]), 0, 1), a = turns - (float)around;
    for (int i = 0; i < 4; i++) {
        out->node[i] = node_of(ring + (i >> 1), around + (i & 1));
        out->weight[i] = (i & 1 ? a : 1 - a) * (i >> 1 ? b : 1 - b);
    }
    return true;
}

bool pair_place(Vec3f to_eye, Vec3f to_light, PairPlace *out) {
    NodesAround eye, light;
    if (!nodes_around(to_eye, &eye) || !nodes_around(to_light, &light)) return false;
    for (int i = 0; i < PAIR_CORNERS; i++) {
        out->entry[i] = eye.node[i / 4] * PAIR_NODES + light.node[i % 4];
        out->weight[i] = eye.weight[i / 4] * light.weight[i % 4];
    }
    return true;
}

/* Falls with the distance between two directions, over `width`, to nothing at the distance that nodes have. */
static float fall(float apart, float width, float nodes) {
    if (!(width > 0)) return 0;
    float rest = expf(-nodes / width), left = (expf(-apart / width) - rest) / (1 - rest);
    return left > 0 ? left : 0; /* nor of slopes that are no numbers */
}

float pair_spot(float width, Vec3f to_eye, Vec3f to_light) {
    if (!(to_eye.y > 0) || !(to_light.y > 0)) return 0;
    float x = to_eye.x / to_eye.y - to_light.x / to_light.y, z = to_eye.z / to_eye.y - to_light.z / to_light.y;
    return fall(sqrtf(x * x + z * z), width, NODES_APART);
}

float pair_glow(float width, Vec3f to_eye, Vec3f to_light) {
    if (!(to_eye.y > 0) || !(to_light.y > 0)) return 0;
    return fall(atan2f(vec3f_length(vec3f_cross(to_eye, to_light)), vec3f_dot(to_eye, to_light)), width, NODE_ANGLE);
}

Vec3f pair_direction_beside(Vec3f d) { return vec3f_normalize(vec3f(d.x / d.y + SPOT_OFFSET, 1, d.z / d.y)); }

/* How far the views beside each other are apart, on the mean. */
static float glow_offset(void) {
    float along = atanf(SPOT_SLOPE + SPOT_OFFSET) - atanf(SPOT_SLOPE), across = atanf(SPOT_OFFSET / sqrtf(1 + SPOT_SLOPE * SPOT_SLOPE));
    return (along + across) / 2;
}

static float peak_width(float offset, float lit, float far) {
    return far < 1 ? float_min(WIDEST_SPOT, offset / -logf(float_clamp((lit - far) / (1 - far), LEAST_LEFT, MOST_LEFT))) : 0;
}

float pair_glow_width(float lit, float far) { return peak_width(glow_offset(), lit, far); }
float pair_spot_width(float open, float far) { return peak_width(SPOT_OFFSET, open, far); }

void voxel_layer_find_glow(VoxelLayer *layer, float lit) {
    float far = 0;
    for (int i = 1; i <= PAIR_RING; i++) far += layer->pairs.lit[i * PAIR_NODES + i] / PAIR_RING; /* the ring that is nearest to the spots' */
    layer->pairs.glow = pair_glow_width(lit, far);
}

float voxel_layer_lit_pair(const VoxelLayer *layer, Vec3f to_eye, Vec3f to_light) {
    PairPlace place;
    float lit = 0;
    if (layer->pairs.lit[0] < 0 || !pair_place(to_eye, to_light, &place)) return -1;
    for (int i = 0; i < PAIR_CORNERS; i++) lit += place.weight[i] * layer->pairs.lit[place.entry[i]];
    return lit + (1 - lit) * pair_glow(layer->pairs.glow, to_eye, to_light);
}
