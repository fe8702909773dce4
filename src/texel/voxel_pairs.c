#include "texel/voxel_pairs.h"

#include "texel/voxel_lit.h"

#include <stdlib.h>
#include <string.h>

/* A surface meets its own picture on the grid beside the place that is asked for, up or down its slope by so many of the grid's sides at most; and its
 * heights are known to a part of one. */
static const float MOST_OWN = 3, LEAST_OWN = 0.05f;
/* Every so many places, along both axes, matter is asked whether it is lit. */
enum { LIT_STRIDE = 3 };
/* Radians. */
static const float NARROWEST_PEAK = 0.025f, WIDEST_PEAK = 2;
/* Nodes lie about as far apart, radians. */
static const float NODE_ANGLE = 0.5f;

void voxel_layer_forget_pairs(VoxelLayer *layer) {
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) layer->pairs.lit[i] = -1;
    memset(&layer->pairs.glow, 0, sizeof layer->pairs.glow);
    memset(&layer->pairs.spot, 0, sizeof layer->pairs.spot);
    memset(layer->pairs.peak, 0, sizeof layer->pairs.peak);
    voxel_layer_forget_powers(layer);
}

bool voxel_layer_is_paired(const VoxelLayer *layer) { return layer->pairs.lit[0] >= 0; }

static bool are_widths(const PairWidths *width) {
    bool are = true;
    for (int h = 0; h < PAIR_HEIGHTS; h++)
        for (int k = 0; k < 2; k++) are &= width->at[k][h] >= 0 && width->at[k][h] <= WIDEST_PEAK;
    return are;
}

bool voxel_pairs_are_sound(const VoxelPairs *pairs) {
    bool known = pairs->lit[0] >= 0, sound = are_widths(&pairs->glow) && are_widths(&pairs->spot);
    for (int i = 0; i < TRIM_LEVELS; i++) sound &= are_widths(&pairs->peak[0][i]) && are_widths(&pairs->peak[1][i]);
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) sound &= known ? pairs->lit[i] >= 0 && pairs->lit[i] <= 1 : pairs->lit[i] == -1;
    return sound;
}

/* ---- what the views tell ---- */

/* `places` is a power of two. */
static int wrapped(float place, int places) {
    float middle = place + 0.5f;
    int whole = (int)middle;
    return (whole - ((float)whole > middle)) & (places - 1);
}

/* What is seen, and what of it is lit; by sides as PairShade. */
typedef struct LitSums {
    int seen, lit;
    float facing[2], lit_facing[2], walls; /* walls: of facing[1] */
} LitSums;

/* A direction as (slope, 1, slope), times a normal. */
static float along(const PairView *v, const ViewNormal *n) { return (float)n->x * v->slope_x + (float)n->y + (float)n->z * v->slope_z; }

/* The other side of a wall is in the dark of its solid, however thin that is. */
static void add_place(LitSums *sums, float to_eye, float to_light, bool wall, bool is_open) {
    int side = (to_eye < 0) != (to_light < 0);
    bool is_lit = is_open && !(wall && side);
    sums->seen++;
    sums->lit += is_open;
    sums->facing[side] += fabsf(to_light);
    sums->walls += wall && side ? fabsf(to_light) : 0;
    sums->lit_facing[side] += is_lit ? fabsf(to_light) : 0;
}

/* By how much the height of a plane with normal n differs at a place that lies x and z beside another. */
static float own_height(const ViewNormal *n, float to_light, float x, float z, float cell) {
    float level = -((float)n->x * x + (float)n->z * z), most = MOST_OWN * cell;
    return fabsf(level) < most * fabsf(to_light) ? level / to_light : most;
}

/* What `eye` sees lies open to `light` where in its view nothing is higher at the same place, or `beside` places from there. */
static LitSums lit_sums(const PairView *eye, const PairView *light, int grid, const float size[2], float beside) {
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
            float to_light = along(light, n), own = own_height(n, to_light, (floorf(x + beside + 0.5f) - x) * cell_x, (floorf(z + 0.5f) - z) * cell_z, cell);
            add_place(&sums, along(eye, n), to_light, n->solid, light->top[wrapped(z, grid) * grid + wrapped(x + beside, grid)] <= height + own + LEAST_OWN * cell);
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
    LitSums sums = lit_sums(eye, light, grid, size, 0);
    float unit = 127 * sqrtf(1 + light->slope_x * light->slope_x + light->slope_z * light->slope_z) * (float)int_max(sums.seen, 1);
    PairShade out = {.all = share_of((float)sums.lit, (float)sums.seen), .sheets = share_of(sums.facing[1] - sums.walls, sums.facing[1])};
    for (int side = 0; side < 2; side++) {
        out.facing[side] = sums.facing[side] / unit;
        out.lit[side] = share_of(sums.lit_facing[side], sums.facing[side]);
    }
    return out;
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

int pair_spot_node(int spot) { return node_of(spot / SPOT_KINDS, 3 * (spot / SPOT_KINDS) + 2 * (spot & 1) + 5 * (spot >> 1 & 1)); }

Vec3f pair_direction_beside(Vec3f d, bool around) {
    Vec3f across = {-d.z, 0, d.x};
    across = vec3f_length(across) > 1e-3f ? vec3f_normalize(across) : vec3f(1, 0, 0);
    return vec3f_madd(vec3f_scale(d, cosf(SPOT_ANGLE)), around ? across : vec3f_cross(across, d), sinf(SPOT_ANGLE));
}

/* ---- beside each other ---- */

static float free_of(const PairView *view, int grid) {
    int free = 0;
    for (int i = 0; i < grid * grid; i++) free += view->top[i] < 0;
    return (float)free / (float)(grid * grid);
}

/* How far rounding moves what is looked up, on the mean, in places. */
#define ROUNDED 0.38f

/* The share `lit` of what is seen that is lit from beside, as it would be on a grid without end. Of things finer than the grid a place to which a light's way is
 * rounded shows others: as far as one place from a direction's own tells, so much of what a peak has more than `far` is lost. */
static float without_grid(float lit, float far, const PairView *view, int grid, const float size[2]) {
    LitSums own = lit_sums(view, view, grid, size, 1);
    float next = own.seen ? (float)own.lit / (float)own.seen : 1, left = 1 - ROUNDED * (1 - next) / float_max(1 - far, 0.01f);
    return float_min(1, far + (lit - far) / float_clamp(left, 0.5f, 1));
}

/* What is lit, but for the peak, at a height. */
static float lit_far(const VoxelLayer *layer, int height) {
    float far = 0;
    for (int i = 0; i < PAIR_RING; i++) far += layer->pairs.lit[node_of(height, i) * (PAIR_NODES + 1)] / PAIR_RING;
    return far;
}

bool pair_beside(const VoxelLayer *layer, const PairView *views, int grid, const float size[2], PairBeside *out) {
    int seen[2][PAIR_HEIGHTS] = {{0}};
    *out = (PairBeside){0};
    for (int i = 0; i < SPOT_VIEWS; i++) {
        const PairView pair[2] = {views[pair_spot_node(i)], views[PAIR_NODES + i]};
        int h = i / SPOT_KINDS, around = i & 1;
        float open[4];
        if (!pair_opens(pair, 2, grid, open)) return false;
        float lit = (pair_shade(&pair[0], &pair[1], grid, size).all + pair_shade(&pair[1], &pair[0], grid, size).all) / 2;
        out->lit.at[around][h] += without_grid(lit, lit_far(layer, h), &pair[0], grid, size) * 2 / SPOT_KINDS;
        out->free.at[around][h] += (free_of(&pair[0], grid) + free_of(&pair[1], grid)) / SPOT_KINDS;
        if (open[1] >= 0) out->open.at[around][h] += open[1], seen[around][h]++;
    }
    for (int around = 0; around < 2; around++)
        for (int h = 0; h < PAIR_HEIGHTS; h++) out->open.at[around][h] = seen[around][h] ? out->open.at[around][h] / (float)seen[around][h] : -1;
    return true;
}

/* What is left of a peak at an angle, of all that it has of some width: it ends where the tables of nodes know more. */
static float left_at(float angle, float per_width) {
    float rest = expf(-NODE_ANGLE * per_width), left = (expf(-angle * per_width) - rest) / (1 - rest);
    return left > 0 ? left : 0;
}

float pair_peak_width(float beside, float far) {
    if (!(beside >= 0) || !(far < 1)) return 0;
    float narrow = NARROWEST_PEAK, wide = WIDEST_PEAK, left = (beside - far) / (1 - far);
    for (int i = 0; i < 20; i++) {
        float width = (narrow + wide) / 2;
        *(left_at(SPOT_ANGLE, 1 / width) < left ? &narrow : &wide) = width;
    }
    return wide;
}

void voxel_layer_find_peaks(VoxelLayer *layer, const PairBeside *beside) {
    for (int h = 0; h < PAIR_HEIGHTS; h++) {
        float far = lit_far(layer, h);
        for (int around = 0; around < 2; around++) {
            layer->pairs.glow.at[around][h] = pair_peak_width(beside->lit.at[around][h], far);
            layer->pairs.spot.at[around][h] = pair_peak_width(beside->open.at[around][h], beside->free.at[around][h]);
        }
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

/* The height whose sine is `rise`: between which of the heights of nodes, and how far it is on the way to the lower one. Lower than the last ring all is as on it. */
static int height_around(float rise, float *part) {
    float up = asinf(float_min(1, rise)) * (float)(180 / VTS_PI);
    int ring = 0;
    while (ring + 1 < PAIR_RINGS && up < RING_HEIGHT[ring + 1]) ring++;
    *part = float_clamp((RING_HEIGHT[ring] - up) / (RING_HEIGHT[ring] - RING_HEIGHT[ring + 1]), 0, 1);
    return ring;
}

/* A direction on the net of nodes. */
typedef struct NetPlace {
    int ring;
    float part, turns; /* on the way to the next ring; around, in nodes */
} NetPlace;

/* False below the horizon. */
static bool find_place(Vec3f d, NetPlace *out) {
    float length = vec3f_length(d);
    if (!(length > 0 && length < INFINITY) || !(d.y > 0)) return false;
    out->turns = atan2f(d.z, d.x) * (float)(PAIR_RING / (2 * VTS_PI)) + PAIR_RING - RING_TURN;
    out->ring = height_around(d.y / length, &out->part);
    return true;
}

bool pair_nodes_around(Vec3f d, int node[PAIR_NODES_AROUND], float weight[PAIR_NODES_AROUND]) {
    NetPlace place;
    if (!find_place(d, &place)) return false;
    int first = (int)place.turns;
    float a = place.turns - (float)first;
    for (int i = 0; i < PAIR_NODES_AROUND; i++) {
        node[i] = node_of(place.ring + (i >> 1), first + (i & 1));
        weight[i] = (i & 1 ? a : 1 - a) * (i >> 1 ? place.part : 1 - place.part);
    }
    return true;
}

/* Light depends on how far eye and light are apart around the zenith much more than on where they both are: interpolation is between nodes of the
 * lower direction, and between the differences that nodes have. (Between nodes of each, eye and light that are one would count as 45 degrees apart.) */
bool pair_place(Vec3f to_eye, Vec3f to_light, PairPlace *out) {
    NetPlace eye, light;
    if (!find_place(to_eye, &eye) || !find_place(to_light, &light)) return false;
    bool by_eye = (float)eye.ring + eye.part >= (float)light.ring + light.part;
    const NetPlace *low = by_eye ? &eye : &light, *high = by_eye ? &light : &eye;
    int first = (int)low->turns, step = (int)floorf(high->turns - low->turns);
    float a = low->turns - (float)first, b = high->turns - low->turns - (float)step;
    for (int i = 0; i < PAIR_CORNERS; i++) {
        int around = first + (i & 1), other = around + step + (i >> 1 & 1);
        int low_node = node_of(low->ring + (i >> 2 & 1), around), high_node = node_of(high->ring + (i >> 3), other);
        out->entry[i] = by_eye ? low_node * PAIR_NODES + high_node : high_node * PAIR_NODES + low_node;
        out->weight[i] = (i & 1 ? a : 1 - a) * (i >> 1 & 1 ? b : 1 - b) * (i >> 2 & 1 ? low->part : 1 - low->part) * (i >> 3 ? high->part : 1 - high->part);
    }
    return true;
}

/* Falls with the angle between two directions, to nothing where nodes are as far apart. Where trunks stand upright the light that is higher than the eye
 * falls through the same gap, but not one beside it. */
float pair_peak(const PairWidths *width, Vec3f to_eye, Vec3f to_light) {
    float part, eye = vec3f_length(to_eye), light = vec3f_length(to_light);
    if (!(to_eye.y > 0) || !(to_light.y > 0) || !(eye < INFINITY) || !(light < INFINITY)) return 0;
    float y[2] = {float_min(1, to_eye.y / eye), float_min(1, to_light.y / light)};
    float apart = atan2f(vec3f_length(vec3f_cross(to_eye, to_light)), vec3f_dot(to_eye, to_light)), up = asinf(y[0]) - asinf(y[1]);
    int height = height_around((y[0] + y[1]) / 2, &part);
    float over[2];
    for (int k = 0; k < 2; k++) over[k] = (1 - part) * width->at[k][height] + part * width->at[k][height + 1];
    if (!(over[0] > 0) || !(over[1] > 0)) return 0;
    float up2 = up * up, around2 = float_max(0, apart * apart - up2), widths = sqrtf(up2 / (over[0] * over[0]) + around2 / (over[1] * over[1]));
    return apart > 0 ? left_at(apart, widths / apart) : 1;
}

float voxel_layer_lit_pair(const VoxelLayer *layer, Vec3f to_eye, Vec3f to_light) {
    PairPlace place;
    float lit = 0;
    if (layer->pairs.lit[0] < 0 || !pair_place(to_eye, to_light, &place)) return -1;
    for (int i = 0; i < PAIR_CORNERS; i++) lit += place.weight[i] * layer->pairs.lit[place.entry[i]];
    return lit + (1 - lit) * pair_peak(&layer->pairs.glow, to_eye, to_light);
}
