#include "texel/voxel_layer.h"

#include <math.h>

/* The occupied ones of the eight voxels around a point, with their weights; lanes past `count` have weight 0. */
typedef struct Corners {
    int count;
    uint32_t diagonal[8], rest[8];
    float weight[8];
} Corners;

/* Per axis: the two voxels, as brick and place within it (brick −1: none), and their weights. */
typedef struct AxisPair {
    int brick[2], place[2];
    float weight[2];
} AxisPair;

static AxisPair axis_pair(float x, int size, bool cyclic) {
    x -= 0.5f;
    if (!(x > -1e9f && x < 1e9f)) return (AxisPair){.brick = {-1, -1}}; /* NaN too */
    float base = floorf(x), t = x - base;
    int at[2] = {(int)base, (int)base + 1};
    AxisPair pair = {.weight = {1 - t, t}};
    for (int c = 0; c < 2; c++) {
        if (cyclic) at[c] &= size - 1; /* sizes are powers of two */
        pair.brick[c] = at[c] >= 0 && at[c] < size ? at[c] / BRICK_SIDE : -1;
        pair.place[c] = at[c] & (BRICK_SIDE - 1);
    }
    return pair;
}

static int bits_of_byte(uint32_t x) {
    x -= x >> 1 & 0x55u;
    x = (x & 0x33u) + (x >> 2 & 0x33u);
    return (int)((x + (x >> 4)) & 0x0fu);
}

static void add_corner(Corners *c, const VoxelLevel *level, const VoxelBrick *brick, int row, int place,
                       float weight) {
    uint32_t mask = brick->mask[row];
    if (!(mask >> place & 1) || weight <= 0) return;
    VoxelCode code =
        level->codes[brick->first + brick->before[row] + (uint32_t)bits_of_byte(mask & ((1u << place) - 1))];
    c->diagonal[c->count] = code.diagonal;
    c->rest[c->count] = code.rest;
    c->weight[c->count++] = weight;
}

static void gather(const VoxelLevel *level, const bool cyclic[3], Vec3f p, Corners *c) {
    c->count = 0;
    AxisPair x = axis_pair(p.x * level->per_side[0], level->size[0], cyclic[0]);
    AxisPair y = axis_pair(p.y * level->per_side[1], level->size[1], cyclic[1]);
    AxisPair z = axis_pair(p.z * level->per_side[2], level->size[2], cyclic[2]);
    for (int k = 0; k < 2; k++) {
        if (z.brick[k] < 0) continue;
        for (int j = 0; j < 2; j++) {
            if (y.brick[j] < 0) continue;
            const int32_t *bricks = level->index + voxel_level_brick_at(level, 0, y.brick[j], z.brick[k]);
            int row = z.place[k] * BRICK_SIDE + y.place[j];
            for (int i = 0; i < 2; i++) {
                int32_t brick = x.brick[i] < 0 ? -1 : bricks[x.brick[i]];
                if (brick >= 0)
                    add_corner(c, level, &level->bricks[brick], row, x.place[i],
                               x.weight[i] * y.weight[j] * z.weight[k]);
            }
        }
    }
    for (int i = c->count; i & 3; i++) {
        c->diagonal[i] = c->rest[i] = 0;
        c->weight[i] = 0;
    }
}

/* Sums of weight·density, weight·density·gamma and weight·density·S. */
enum { SUM_DENSITY, SUM_GAMMA, SUM_XX, SUM_YY, SUM_ZZ, SUM_XY, SUM_XZ, SUM_YZ, SUMS };

static void add_corners(const Corners *c, float factor, float sums[SUMS]) {
    float lanes[SUMS][4] = {{0}};
    for (int group = 0; group < c->count; group += 4)
        for (int l = 0; l < 4; l++) {
            uint32_t d = c->diagonal[group + l], r = c->rest[group + l];
            float w = c->weight[group + l] * voxel_code_density(r);
            float xx = voxel_code_diagonal(d, 0), yy = voxel_code_diagonal(d, 1),
                  zz = voxel_code_diagonal(d, 2);
            float xy = voxel_code_mixed(d, 3), xz = voxel_code_mixed(r, 0), yz = voxel_code_mixed(r, 1);
            lanes[SUM_DENSITY][l] += w;
            lanes[SUM_GAMMA][l] += w * voxel_code_gamma(r);
            lanes[SUM_XX][l] += w * (xx * xx + xy * xy + xz * xz);
            lanes[SUM_YY][l] += w * (xy * xy + yy * yy + yz * yz);
            lanes[SUM_ZZ][l] += w * (xz * xz + yz * yz + zz * zz);
            lanes[SUM_XY][l] += w * (xx * xy + xy * yy + xz * yz);
            lanes[SUM_XZ][l] += w * (xx * xz + xy * yz + xz * zz);
            lanes[SUM_YZ][l] += w * (xy * xz + yy * yz + yz * zz);
        }
    for (int i = 0; i < SUMS; i++)
        sums[i] += factor * ((lanes[i][0] + lanes[i][1]) + (lanes[i][2] + lanes[i][3]));
}

static bool finish(const float sums[SUMS], VoxelSample *out) {
    if (!(sums[SUM_DENSITY] > 0)) {
        *out = (VoxelSample){0};
        return false;
    }
    float k = 1 / sums[SUM_DENSITY], s = k * VOXEL_CODE_SQUARE;
    *out = (VoxelSample){
        .density = sums[SUM_DENSITY],
        .gamma = k * sums[SUM_GAMMA],
        .s = {s * sums[SUM_XX], s * sums[SUM_YY], s * sums[SUM_ZZ], s * sums[SUM_XY], s * sums[SUM_XZ],
              s * sums[SUM_YZ]},
    };
    return true;
}

static void add_level(const VoxelLayer *layer, int level, Vec3f p, float factor, float sums[SUMS]) {
    Corners corners;
    gather(&layer->level[level], layer->cyclic, p, &corners);
    if (corners.count) add_corners(&corners, factor * layer->level[level].density_unit, sums);
}

bool voxel_layer_sample(const VoxelLayer *layer, int level, Vec3f p, VoxelSample *out) {
    float sums[SUMS] = {0};
    add_level(layer, int_clamp(level, 0, layer->levels - 1), p, 1, sums);
    return finish(sums, out);
}

bool voxel_layer_sample_lod(const VoxelLayer *layer, float lod, Vec3f p, VoxelSample *out) {
    float sums[SUMS] = {0}, top = (float)(layer->levels - 1);
    lod = lod > 0 ? float_min(lod, top) : 0;
    int level = (int)lod;
    float t = lod - (float)level;
    if (t < 1) add_level(layer, level, p, 1 - t, sums);
    if (t > 0) add_level(layer, level + 1, p, t, sums);
    return finish(sums, out);
}
