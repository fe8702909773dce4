#include "texel/voxel_layer.h"

#include <math.h>

/* ---- marking ---- */

/* The cells that have the voxel at a corner, per axis: its own number and the next; on cyclic axes the first cell is the last. */
static int cells_of(const VoxelLevel *level, const bool cyclic[3], int axis, int voxel, int out[4]) {
    int count = 0, size = level->size[axis];
    out[count++] = voxel;
    out[count++] = voxel + 1;
    if (cyclic[axis] && voxel == size - 1) out[count++] = 0;
    if (cyclic[axis] && voxel == 0) out[count++] = size;
    return count;
}

static size_t cell_brick(const VoxelSupport *cells, int x, int y, int z) {
    return ((size_t)(z / BRICK_SIDE) * (size_t)cells->brick_size[1] + (size_t)(y / BRICK_SIDE)) *
               (size_t)cells->brick_size[0] +
           (size_t)(x / BRICK_SIDE);
}

static int32_t number_brick(VoxelSupport *cells, size_t brick) {
    if (cells->index[brick] < 0) cells->index[brick] = (int32_t)cells->count++;
    return cells->index[brick];
}

static void visit_voxel(const VoxelLayer *layer, VoxelLevel *level, const int voxel[3], bool set) {
    VoxelSupport *cells = &level->support;
    int at[3][4], count[3];
    for (int k = 0; k < 3; k++) count[k] = cells_of(level, layer->cyclic, k, voxel[k], at[k]);
    for (int c = 0; c < count[0] * count[1] * count[2]; c++) {
        int x = at[0][c % count[0]], y = at[1][c / count[0] % count[1]], z = at[2][c / count[0] / count[1]];
        int32_t brick = number_brick(cells, cell_brick(cells, x, y, z));
        if (set) cells->bits[brick][z & 7] |= (uint64_t)1 << (8 * (y & 7) + (x & 7));
    }
}

/* Voxels of a slice whose eight cells are all in the brick of cells with the same number. */
static uint64_t inner_voxels(const VoxelLayer *layer, const int corner[3], int z) {
    uint64_t inner = 0x007f7f7f7f7f7f7fu;
    if (z == BRICK_SIDE - 1 || (z == 0 && layer->cyclic[2] && corner[2] == 0)) return 0;
    if (layer->cyclic[0] && corner[0] == 0) inner &= 0xfefefefefefefefeu;
    if (layer->cyclic[1] && corner[1] == 0) inner &= 0xffffffffffffff00u;
    return inner;
}

static void visit_slice(const VoxelLayer *layer, VoxelLevel *level, const int corner[3], uint64_t slice,
                        int z, bool set) {
    bool small = level->size[0] < BRICK_SIDE || level->size[1] < BRICK_SIDE || level->size[2] < BRICK_SIDE;
    uint64_t inner = small ? 0 : slice & inner_voxels(layer, corner, z);
    if (inner) {
        VoxelSupport *cells = &level->support;
        int32_t brick = number_brick(cells, cell_brick(cells, corner[0], corner[1], corner[2]));
        uint64_t spread = inner | inner << 1;
        spread |= spread << BRICK_SIDE;
        if (set) cells->bits[brick][z] |= spread, cells->bits[brick][z + 1] |= spread;
    }
    for (uint64_t rest = slice & ~inner; rest; rest &= rest - 1) {
        int bit = (int)count_bits((rest & (~rest + 1)) - 1);
        const int voxel[3] = {corner[0] + (bit & 7), corner[1] + (bit >> 3), corner[2] + z};
        visit_voxel(layer, level, voxel, set);
    }
}

/* One pass over all occupied voxels: numbers the bricks of cells (no bits yet), or sets the bits. */
static void visit_cells(const VoxelLayer *layer, VoxelLevel *level, bool set) {
    size_t nx = (size_t)level->brick_size[0], ny = (size_t)level->brick_size[1];
    for (size_t i = 0; i < voxel_level_bricks(level); i++) {
        if (level->index[i] < 0) continue;
        const VoxelBrick *brick = &level->bricks[level->index[i]];
        const int corner[3] = {(int)(i % nx) * BRICK_SIDE, (int)(i / nx % ny) * BRICK_SIDE,
                               (int)(i / nx / ny) * BRICK_SIDE};
        for (int z = 0; z < BRICK_SIDE; z++)
            if (brick->slice[z]) visit_slice(layer, level, corner, brick->slice[z], z, set);
    }
}

bool voxel_level_mark_support(VoxelLayer *layer, VoxelLevel *level) {
    VoxelSupport *cells = &level->support;
    size_t bricks = 1;
    for (int k = 0; k < 3; k++) {
        cells->brick_size[k] = level->size[k] / BRICK_SIDE + 1;
        bricks *= (size_t)cells->brick_size[k];
    }
    cells->index = voxel_layer_allocate(layer, bricks, sizeof *cells->index);
    if (!cells->index) return false;
    for (size_t i = 0; i < bricks; i++) cells->index[i] = -1;
    visit_cells(layer, level, false);
    cells->bits = voxel_layer_allocate(layer, cells->count, sizeof *cells->bits);
    if (!cells->bits) return false;
    visit_cells(layer, level, true);
    return true;
}

/* ---- walking ---- */

/* A walk through a grid along a ray (Amanatides & Woo 1987). */
typedef struct GridWalk {
    int at[3], step[3];
    float next[3],
        pace[3]; /* where the ray leaves the current box along each axis; length between two such */
} GridWalk;

/* Position x and speed v in units of the grid; boxes [lo, hi). */
static void start_walk(GridWalk *walk, const float x[3], const float v[3], const int lo[3], const int hi[3],
                       float t) {
    for (int k = 0; k < 3; k++) {
        float here = x[k] + t * v[k];
        walk->at[k] = int_clamp((int)here, lo[k], hi[k] - 1); /* never below 0 but by rounding */
        walk->step[k] = v[k] > 0 ? 1 : -1;
        float edge = (float)(walk->at[k] + (v[k] > 0));
        walk->pace[k] = v[k] != 0 ? fabsf(1 / v[k]) : INFINITY;
        walk->next[k] = v[k] != 0 ? float_max(t, (edge - x[k]) / v[k]) : INFINITY;
    }
}

static int nearest_axis(const GridWalk *walk) {
    return walk->next[0] <= walk->next[1] ? (walk->next[0] <= walk->next[2] ? 0 : 2)
                                          : (walk->next[1] <= walk->next[2] ? 1 : 2);
}

/* Within one brick of cells, from t to t_end: to the first cell whose bit is set. */
static float skip_in_brick(const uint64_t bits[8], const int brick[3], const float x[3], const float v[3],
                           float t, float t_end) {
    int lo[3], hi[3];
    for (int k = 0; k < 3; k++) lo[k] = brick[k] * BRICK_SIDE, hi[k] = lo[k] + BRICK_SIDE;
    GridWalk walk;
    start_walk(&walk, x, v, lo, hi, t);
    while (t < t_end) {
        if (bits[walk.at[2] & 7] >> (8 * (walk.at[1] & 7) + (walk.at[0] & 7)) & 1) return t;
        int k = nearest_axis(&walk);
        t = walk.next[k];
        walk.next[k] += walk.pace[k];
        walk.at[k] += walk.step[k];
        if (walk.at[k] < lo[k] || walk.at[k] >= hi[k]) break;
    }
    return t_end;
}

static bool cell_is_set(const VoxelSupport *cells, int x, int y, int z) {
    size_t at = ((size_t)(z / BRICK_SIDE) * (size_t)cells->brick_size[1] + (size_t)(y / BRICK_SIDE)) *
                    (size_t)cells->brick_size[0] +
                (size_t)(x / BRICK_SIDE);
    return cells->index[at] >= 0 && (cells->bits[cells->index[at]][z & 7] >> (8 * (y & 7) + (x & 7)) & 1);
}

/* To the first cell in which anything is, at most limit. */
static float skip_level(const VoxelLevel *level, const bool cyclic[3], const float p[3], const float d[3],
                        float limit) {
    const VoxelSupport *cells = &level->support;
    const int zero[3] = {0, 0, 0};
    float x[3], v[3], brick_x[3], brick_v[3];
    for (int k = 0; k < 3; k++) {
        x[k] = p[k] * level->per_side[k] + 0.5f; /* cell 0 begins half a voxel before voxel 0's centre … */
        v[k] = d[k] * level->per_side[k];
        if (!(x[k] >= 0 && x[k] <= (float)(level->size[k] + 1))) return 0;
        /* … and where a cyclic axis ends the caller wraps and asks again. */
        if (cyclic[k] && v[k] != 0)
            limit = float_min(limit, ((v[k] > 0 ? (float)level->size[k] + 0.5f : 0.5f) - x[k]) / v[k]);
        brick_x[k] = x[k] / BRICK_SIDE;
        brick_v[k] = v[k] / BRICK_SIDE;
    }
    if (cell_is_set(cells, (int)x[0], (int)x[1], (int)x[2]))
        return 0; /* the most frequent answer within matter */
    GridWalk walk;
    start_walk(&walk, brick_x, brick_v, zero, cells->brick_size, 0);
    for (float t = 0; t < limit;) {
        int k = nearest_axis(&walk);
        float leave = walk.next[k];
        size_t at = ((size_t)walk.at[2] * (size_t)cells->brick_size[1] + (size_t)walk.at[1]) *
                        (size_t)cells->brick_size[0] +
                    (size_t)walk.at[0];
        if (cells->index[at] >= 0) {
            float end = float_min(leave, limit),
                  found = skip_in_brick(cells->bits[cells->index[at]], walk.at, x, v, t, end);
            if (found < end) return found;
        }
        t = leave;
        walk.next[k] += walk.pace[k];
        walk.at[k] += walk.step[k];
        if (walk.at[k] < 0 || walk.at[k] >= cells->brick_size[k]) return limit; /* outside of all matter */
    }
    return float_max(limit, 0);
}

float voxel_layer_skip(const VoxelLayer *layer, float lod, Vec3f p, Vec3f d, float limit) {
    const float at[3] = {p.x, p.y, p.z}, along[3] = {d.x, d.y, d.z};
    lod = lod > 0 ? float_min(lod, (float)(layer->levels - 1)) : 0;
    /* Where the coarser of both levels is empty, so is the finer: its voxels' support lies within their parents'. */
    return skip_level(&layer->level[(int)ceilf(lod)], layer->cyclic, at, along, float_max(limit, 0));
}
