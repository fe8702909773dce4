#include "texel/voxel_pairs.h"

#include "texel/voxel_lit.h"

/* A surface meets its own picture on the grid at heights that differ by some of the grid's sides. */
static const float OWN_HEIGHT = 1, MOST_OWN_HEIGHT = 3;
/* Every so many places, along both axes, matter is asked whether it is lit. */
enum { LIT_STRIDE = 2 };
/* Widths of the spot are held below this. */
static const float WIDEST_SPOT = 2;

void voxel_layer_forget_pairs(VoxelLayer *layer) {
    for (int i = 0; i < PAIR_NODES * PAIR_NODES; i++) layer->pairs.lit[i] = -1;
    layer->pairs.spot = 0;
    voxel_layer_forget_powers(layer);
}

bool voxel_layer_is_paired(const VoxelLayer *layer) { return layer->pairs.lit[0] >= 0 || layer->pairs.spot > 0; }

bool voxel_pairs_are_sound(const VoxelPairs *pairs) {
    bool known = pairs->lit[0] >= 0, sound = pairs->spot >= 0 && pairs->spot <= WIDEST_SPOT;
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

/* The share of what `eye` sees that lies open to `light`: in its view nothing is higher at the same place. Of every `step`th place each way. */
static float lit_share_of(const PairView *eye, const PairView *light, int grid, const float size[2], int step) {
    float cell_x = (float)step * size[0] / (float)grid, cell_z = (float)step * size[1] / (float)grid,
          flat = sqrtf(light->slope_x * light->slope_x + light->slope_z * light->slope_z);
    float own = float_max(cell_x, cell_z) * float_min(OWN_HEIGHT * (1 + 1 / (flat + 1e-3f)), MOST_OWN_HEIGHT);
    float x_per = (eye->slope_x - light->slope_x) / cell_x, z_per = (eye->slope_z - light->slope_z) / cell_z;
    int seen = 0, lit = 0, places = grid / step;
    for (int row = 0; row < places; row += LIT_STRIDE)
        for (int column = row / LIT_STRIDE % LIT_STRIDE; column < places; column += LIT_STRIDE) {
            float height = eye->top[step * (row * grid + column)];
            if (height < 0) continue;
            int x = wrapped((float)column + height * x_per, places), z = wrapped((float)row + height * z_per, places);
            seen++;
            lit += light->top[step * (z * grid + x)] <= height + own;
        }
    return seen ? (float)lit / (float)seen : 1;
}

/* What lies within `own` of the surface shades nothing: the error falls as the cells do, and with every other place is twice as large. */
static float lit_share(const PairView *eye, const PairView *light, int grid, const float size[2]) {
    float fine = lit_share_of(eye, light, grid, size, 1), coarse = lit_share_of(eye, light, grid, size, 2);
    return float_clamp(2 * fine - coarse, 0, 1);
}

float pair_open(const PairView *eye, const PairView *light, int grid) {
    int seen = 0, lit = 0;
    for (int i = 0; i < grid * grid; i++) {
        seen += eye->top[i] < 0;
        lit += eye->top[i] < 0 && light->top[i] < 0;
    }
    return seen ? (float)lit / (float)seen : -1;
}

/* Where eye and light look along one line all that is seen is lit; but a few degrees beside it that is over, far less than the way to the next node: the
 * entry gets the mean of those around it. */
static void flatten_peak(float *table) {
    for (int node = 0; node < PAIR_NODES; node++) {
        int column = node % PAIR_SIDE, row = node / PAIR_SIDE, count = 0;
        float sum = 0;
        for (int i = 0; i < 4; i++) {
            int x = column + (i == 0) - (i == 1), z = row + (i == 2) - (i == 3), other = z * PAIR_SIDE + x;
            if (x < 0 || x >= PAIR_SIDE || z < 0 || z >= PAIR_SIDE) continue;
            sum += table[node * PAIR_NODES + other] + table[other * PAIR_NODES + node];
            count += 2;
        }
        table[node * PAIR_NODES + node] = sum / (float)count;
    }
}

float pair_lit_beside(const PairView views[SPOT_GROUPS * SPOT_VIEWS], int grid, const float size[2]) {
    float sum = 0;
    for (int i = 0; i < SPOT_GROUPS * SPOT_VIEWS; i++)
        if (i % SPOT_VIEWS) sum += lit_share(&views[i - i % SPOT_VIEWS], &views[i], grid, size) + lit_share(&views[i], &views[i - i % SPOT_VIEWS], grid, size);
    return sum / (2 * SPOT_GROUPS * (SPOT_VIEWS - 1));
}

float pair_open_beside(const PairView views[SPOT_GROUPS * SPOT_VIEWS], int grid) {
    float sum = 0;
    int count = 0;
    for (int i = 0; i < SPOT_GROUPS * SPOT_VIEWS; i++) {
        float open = i % SPOT_VIEWS ? pair_open(&views[i - i % SPOT_VIEWS], &views[i], grid) : -1;
        if (open >= 0) sum += open, count++;
    }
    return count ? sum / (float)count : -1;
}

void voxel_layer_pair(VoxelLayer *layer, const PairView views[PAIR_NODES], int grid, const float size[2]) {
    for (int a = 0; a < PAIR_NODES; a++)
        for (int b = 0; b < PAIR_NODES; b++) layer->pairs.lit[a * PAIR_NODES + b] = lit_share(&views[a], &views[b], grid, size);
    flatten_peak(layer->pairs.lit);
}

/* ---- reading ---- */

/* The nodes around a direction, and their weights. */
typedef struct NodesAround {
    int node[4];
    float weight[4];
} NodesAround;

/* How far from the zenith, 0 to 1, as the nodes have it: the last of them are not on the horizon, but a little above. */
static const float LAST_NODES = 0.8f;
static float ring_of(float r) { return r <= 0.5f ? r : float_min(1, 0.5f + 0.5f * (r - 0.5f) / (LAST_NODES - 0.5f)); }

/* The upper hemisphere as an octahedron's upper half, unfolded to a square. False below the horizon. */
static bool nodes_around(Vec3f d, NodesAround *out) {
    float sum = fabsf(d.x) + fabsf(d.y) + fabsf(d.z);
    if (!(sum > 0 && sum < INFINITY) || !(d.y > 0)) return false;
    float r = (fabsf(d.x) + fabsf(d.z)) / sum, stretch = r > 0 ? ring_of(r) / (r * sum) : 0;
    float x = d.x * stretch, z = d.z * stretch, a = (x + z + 1) * 0.5f * (PAIR_SIDE - 1), b = (x - z + 1) * 0.5f * (PAIR_SIDE - 1);
    int column = int_clamp((int)a, 0, PAIR_SIDE - 2), row = int_clamp((int)b, 0, PAIR_SIDE - 2);
    a -= (float)column, b -= (float)row;
    for (int i = 0; i < 4; i++) {
        out->node[i] = (row + (i >> 1)) * PAIR_SIDE + column + (i & 1);
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

float voxel_layer_spot(const VoxelLayer *layer, Vec3f to_eye, Vec3f to_light) {
    if (!(layer->pairs.spot > 0) || !(to_eye.y > 0) || !(to_light.y > 0)) return 0;
    float x = to_eye.x / to_eye.y - to_light.x / to_light.y, z = to_eye.z / to_eye.y - to_light.z / to_light.y;
    float spot = expf(-sqrtf(x * x + z * z) / layer->pairs.spot);
    return spot > 0 ? spot : 0; /* of slopes that are no numbers */
}

float voxel_layer_lit_pair(const VoxelLayer *layer, Vec3f to_eye, Vec3f to_light) {
    PairPlace place;
    float lit = 0;
    if (layer->pairs.lit[0] < 0 || !pair_place(to_eye, to_light, &place)) return -1;
    for (int i = 0; i < PAIR_CORNERS; i++) lit += place.weight[i] * layer->pairs.lit[place.entry[i]];
    return lit + (1 - lit) * voxel_layer_spot(layer, to_eye, to_light);
}
