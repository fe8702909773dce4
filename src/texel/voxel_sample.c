#include "texel/voxel_layer.h"

#include <math.h>

/* The occupied ones of the eight voxels around a point, with their weights; lanes past `count` have weight 0. */
typedef struct Corners {
    int count;
    uint32_t diagonal[8], rest[8];
    float weight[8];
} Corners;

static inline void add_corner(Corners *c, VoxelCode code, float weight) {
    c->diagonal[c->count] = code.diagonal;
    c->rest[c->count] = code.rest;
    c->weight[c->count++] = weight;
}

/* The lower voxel along an axis, and the weight of the upper one; false where x is not a number or out of all bounds. */
static inline bool split_coordinate(float x, int *lower, float *t) {
    x -= 0.5f;
    if (!(x > -1e9f && x < 1e9f)) return false;
    int whole = (int)x;
    whole -= x < (float)whole;
    *lower = whole;
    *t = x - (float)whole;
    return true;
}

/* One or both of the two voxels along an axis, as far as they are in one brick. */
typedef struct Segment {
    int brick, place, count;
    const float *weights;
} Segment;

static inline int cut_at_bricks(int lower, const float weights[2], int size, bool cyclic,
                                Segment segments[2]) {
    if (lower >= 0 && lower < size - 1 && lower % BRICK_SIDE != BRICK_SIDE - 1) {
        segments[0] = (Segment){lower / BRICK_SIDE, lower % BRICK_SIDE, 2, weights};
        return 1;
    }
    int count = 0;
    for (int i = 0; i < 2; i++) {
        int at = cyclic ? (lower + i) & (size - 1) : lower + i; /* sizes are powers of two */
        if (at >= 0 && at < size)
            segments[count++] = (Segment){at / BRICK_SIDE, at % BRICK_SIDE, 1, weights + i};
    }
    return count;
}

static inline void gather_slice(Corners *c, const VoxelCode *codes, const VoxelBrick *brick, int z, float wz,
                                const Segment *y, const Segment *x) {
    uint64_t slice = brick->slice[z], wanted = x->count == 2 ? 3 : 1;
    for (int j = 0; j < y->count; j++) {
        int at = (y->place + j) * BRICK_SIDE + x->place;
        uint64_t pair = slice >> at & wanted;
        if (!pair) continue;
        const VoxelCode *code = codes + brick->first[z] + count_bits(slice & (((uint64_t)1 << at) - 1));
        float w = y->weights[j] * wz;
        if (pair & 1) add_corner(c, *code++, x->weights[0] * w);
        if (pair & 2) add_corner(c, *code, x->weights[1] * w);
    }
}

static void gather(const VoxelLevel *level, const bool cyclic[3], Vec3f p, Corners *c) {
    const float at[3] = {p.x, p.y, p.z};
    float weights[3][2];
    Segment segments[3][2];
    int counts[3];
    c->count = 0;
    for (int k = 0; k < 3; k++) {
        int lower;
        if (!split_coordinate(at[k] * level->per_side[k], &lower, &weights[k][1])) return;
        weights[k][0] = 1 - weights[k][1];
        counts[k] = cut_at_bricks(lower, weights[k], level->size[k], cyclic[k], segments[k]);
    }
    for (const Segment *z = segments[2]; z < segments[2] + counts[2]; z++)
        for (const Segment *y = segments[1]; y < segments[1] + counts[1]; y++)
            for (const Segment *x = segments[0]; x < segments[0] + counts[0]; x++) {
                int32_t brick = level->index[voxel_level_brick_at(level, x->brick, y->brick, z->brick)];
                for (int i = 0; brick >= 0 && i < z->count; i++)
                    gather_slice(c, level->codes, &level->bricks[brick], z->place + i, z->weights[i], y, x);
            }
    for (int i = c->count; i & 3; i++) {
        c->diagonal[i] = c->rest[i] = 0;
        c->weight[i] = 0;
    }
}

/* Sums of weight·density, weight·density·gamma and weight·density·S. */
enum { SUM_DENSITY, SUM_GAMMA, SUM_XX, SUM_YY, SUM_ZZ, SUM_XY, SUM_XZ, SUM_YZ, SUMS };

/* Of four corners, side by side so that compilers vectorise it. */
static inline void decode_four(const uint32_t diagonal[4], const uint32_t rest[4], const float weight[4],
                               float lanes[SUMS][4]) {
    for (int l = 0; l < 4; l++) {
        uint32_t d = diagonal[l], r = rest[l];
        float w = weight[l] * voxel_code_density(r);
        float xx = voxel_code_diagonal(d, 0), yy = voxel_code_diagonal(d, 1), zz = voxel_code_diagonal(d, 2);
        float xy = voxel_code_mixed(d, 3), xz = voxel_code_mixed(r, 0), yz = voxel_code_mixed(r, 1);
        lanes[SUM_DENSITY][l] = w;
        lanes[SUM_GAMMA][l] = w * voxel_code_gamma(r);
        lanes[SUM_XX][l] = w * (xx * xx + xy * xy + xz * xz);
        lanes[SUM_YY][l] = w * (xy * xy + yy * yy + yz * yz);
        lanes[SUM_ZZ][l] = w * (xz * xz + yz * yz + zz * zz);
        lanes[SUM_XY][l] = w * (xx * xy + xy * yy + xz * yz);
        lanes[SUM_XZ][l] = w * (xx * xz + xy * yz + xz * zz);
        lanes[SUM_YZ][l] = w * (xy * xz + yy * yz + yz * zz);
    }
}

static void add_corners(const Corners *c, float factor, float sums[SUMS]) {
    float lanes[SUMS][4], more[SUMS][4];
    decode_four(c->diagonal, c->rest, c->weight, lanes);
    if (c->count > 4) {
        decode_four(c->diagonal + 4, c->rest + 4, c->weight + 4, more);
        for (int i = 0; i < SUMS; i++)
            for (int l = 0; l < 4; l++) lanes[i][l] += more[i][l];
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
