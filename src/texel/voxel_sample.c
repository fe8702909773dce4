#include "texel/voxel_layer.h"

#include <math.h>
#include <stdlib.h>

/* The eight voxels around a point: x in bit 0, y in bit 1, z in bit 2. Empty ones have weight 0 and any code: testing each
 * would cost more, in mispredicted branches, than decoding them. */
typedef struct Corners {
    uint32_t diagonal[8], rest[8];
    float weight[8];
} Corners;

/* The two voxels along an axis, by brick and place in it. Outside of the layer: weight 0, place of voxel 0. */
typedef struct AxisPair {
    uint32_t brick[2], place[2];
    float weight[2];
} AxisPair;

/* False where x is not a number or out of all bounds. */
static inline bool pair_on_axis(float x, int size, bool cyclic, AxisPair *pair) {
    if (!cyclic) {
        /* Up to the side the outermost voxels hold their value, beyond it nothing is: so no matter is lost, however few and
         * large the voxels are. */
        if (!(x >= 0 && x <= (float)size)) return false;
        x = float_clamp(x, 0.5f, (float)size - 0.5f);
    }
    x -= 0.5f;
    if (!(fabsf(x) < 1e9f)) return false;
    int lower = (int)x, wrap = cyclic ? size - 1 : -1; /* sizes are powers of two */
    lower -= x < (float)lower;
    float t = x - (float)lower;
    pair->weight[0] = 1 - t;
    pair->weight[1] = t;
    for (int i = 0; i < 2; i++) {
        uint32_t at = (uint32_t)((lower + i) & wrap);
        if (at >= (uint32_t)size) at = 0, pair->weight[i] = 0;
        pair->brick[i] = at / BRICK_SIDE;
        pair->place[i] = at % BRICK_SIDE;
    }
    return true;
}

static inline bool in_one_brick(const AxisPair *pair) {
    return pair->brick[0] == pair->brick[1] && pair->place[1] == pair->place[0] + 1;
}

static inline void set_corner(Corners *c, int i, const VoxelCode *code, bool exists, float weight) {
    c->diagonal[i] = code->diagonal;
    c->rest[i] = code->rest;
    c->weight[i] = exists ? weight : 0;
}

/* All eight in one brick. */
static inline bool gather_inside(const VoxelLevel *level, const VoxelBrick *brick, const AxisPair axes[3],
                                 Corners *c) {
    uint32_t at = axes[1].place[0] * BRICK_SIDE + axes[0].place[0], z = axes[2].place[0];
    if (!((brick->slice[z] | brick->slice[z + 1]) >> at & 0x303)) return false;
    for (int k = 0; k < 2; k++) {
        uint64_t slice = brick->slice[z + (uint32_t)k];
        uint32_t bits = (uint32_t)(slice >> at), below = count_bits(slice & (((uint64_t)1 << at) - 1));
        const VoxelCode *code = level->codes + brick->first[z + (uint32_t)k] + below;
        for (int j = 0; j < 2; j++) {
            float w = axes[1].weight[j] * axes[2].weight[k];
            set_corner(c, 4 * k + 2 * j, code, bits & 1, axes[0].weight[0] * w);
            set_corner(c, 4 * k + 2 * j + 1, code + (bits & 1), bits & 2, axes[0].weight[1] * w);
            if (j) break;
            code += count_bits_of_byte(bits & 0xff);
            bits >>= BRICK_SIDE;
        }
    }
    return true;
}

/* The voxels from bit `at` on of a slice of a brick; index −1: none. Returns the bits. */
static inline uint32_t find_row(const VoxelLevel *level, int32_t index, uint32_t z, uint32_t at,
                                const VoxelCode **code) {
    static const VoxelBrick nothing = {{0}, {0}};
    const VoxelBrick *brick = index < 0 ? &nothing : &level->bricks[index];
    uint64_t slice = brick->slice[z];
    *code = level->codes + brick->first[z] + count_bits(slice & (((uint64_t)1 << at) - 1));
    return (uint32_t)(slice >> at);
}

/* In more than one brick. */
static bool gather_across(const VoxelLevel *level, const AxisPair axes[3], Corners *c) {
    const AxisPair *x = &axes[0];
    bool together = in_one_brick(x);
    uint32_t any = 0;
    for (int i = 0; i < 4; i++) {
        const int j = i & 1, k = i >> 1;
        uint32_t z = axes[2].place[k], y = axes[1].place[j] * BRICK_SIDE;
        const int32_t *row =
            level->index + voxel_level_brick_at(level, 0, (int)axes[1].brick[j], (int)axes[2].brick[k]);
        const VoxelCode *code;
        float w = axes[1].weight[j] * axes[2].weight[k];
        uint32_t bits = find_row(level, row[x->brick[0]], z, y + x->place[0], &code);
        set_corner(c, 2 * i, code, bits & 1, x->weight[0] * w);
        any |= bits & 1;
        code += bits & 1;
        bits = together ? bits >> 1 : find_row(level, row[x->brick[1]], z, y + x->place[1], &code);
        set_corner(c, 2 * i + 1, code, bits & 1, x->weight[1] * w);
        any |= bits & 1;
    }
    return any;
}

/* False if nothing is there. */
static inline bool gather(const VoxelLevel *level, const bool cyclic[3], Vec3f p, Corners *c) {
    AxisPair axes[3];
    if (!pair_on_axis(p.x * level->per_side[0], level->size[0], cyclic[0], &axes[0]) ||
        !pair_on_axis(p.y * level->per_side[1], level->size[1], cyclic[1], &axes[1]) ||
        !pair_on_axis(p.z * level->per_side[2], level->size[2], cyclic[2], &axes[2]))
        return false;
    if (!in_one_brick(&axes[0]) || !in_one_brick(&axes[1]) || !in_one_brick(&axes[2]))
        return gather_across(level, axes, c);
    int32_t index = level->index[voxel_level_brick_at(level, (int)axes[0].brick[0], (int)axes[1].brick[0],
                                                      (int)axes[2].brick[0])];
    return index >= 0 && gather_inside(level, &level->bricks[index], axes, c);
}

/* Sums of weight·density, weight·density·gamma and weight·density·S. */
enum { SUM_DENSITY, SUM_GAMMA, SUM_SOLID, SUM_XX, SUM_YY, SUM_ZZ, SUM_XY, SUM_XZ, SUM_YZ, SUMS };
/* A voxel that is taken apart has its density behind what is summed with it. */
enum { PLAIN_DENSITY = SUMS };
_Static_assert((int)PLAIN_DENSITY < (int)PLAIN_FLOATS, "a voxel's sums do not fit");

/* What is summed of four voxels of density 1, side by side so that compilers vectorise it. */
static inline void decode_plain(const uint32_t diagonal[4], const uint32_t rest[4], float lanes[SUMS][4]) {
    for (int l = 0; l < 4; l++) {
        uint32_t d = diagonal[l], r = rest[l];
        float xx = voxel_code_diagonal(d, 0), yy = voxel_code_diagonal(d, 1), zz = voxel_code_diagonal(d, 2);
        float xy = voxel_code_mixed(d, 3), xz = voxel_code_mixed(r, 0), yz = voxel_code_mixed(r, 1);
        lanes[SUM_DENSITY][l] = 1;
        lanes[SUM_GAMMA][l] = voxel_code_gamma(r);
        lanes[SUM_SOLID][l] = voxel_code_solid(r);
        lanes[SUM_XX][l] = xx * xx + xy * xy + xz * xz;
        lanes[SUM_YY][l] = xy * xy + yy * yy + yz * yz;
        lanes[SUM_ZZ][l] = xz * xz + yz * yz + zz * zz;
        lanes[SUM_XY][l] = xx * xy + xy * yy + xz * yz;
        lanes[SUM_XZ][l] = xx * xz + xy * yz + xz * zz;
        lanes[SUM_YZ][l] = xy * xz + yy * yz + yz * zz;
    }
}

/* With their weights, and densities. */
static inline void decode_four(const uint32_t diagonal[4], const uint32_t rest[4], const float weight[4],
                               float lanes[SUMS][4]) {
    decode_plain(diagonal, rest, lanes);
    for (int l = 0; l < 4; l++) {
        const float w = weight[l] * voxel_code_density(rest[l]);
        for (int i = 0; i < SUMS; i++) lanes[i][l] *= w;
    }
}

static void add_corners(const Corners *c, float factor, float sums[SUMS]) {
    float lanes[SUMS][4], more[SUMS][4];
    decode_four(c->diagonal, c->rest, c->weight, lanes);
    decode_four(c->diagonal + 4, c->rest + 4, c->weight + 4, more);
    for (int i = 0; i < SUMS; i++)
        for (int l = 0; l < 4; l++) lanes[i][l] += more[i][l];
    for (int i = 0; i < SUMS; i++)
        sums[i] += factor * ((lanes[i][0] + lanes[i][1]) + (lanes[i][2] + lanes[i][3]));
}

/* ---- taken apart ---- */

/* The lower of the two voxels along an axis, and the weights of both. */
static inline bool plain_on_axis(float x, int size, bool cyclic, size_t *lower, float weight[2]) {
    if (!cyclic) {
        if (!(x >= 0 && x <= (float)size)) return false;
        x = float_clamp(x, 0.5f, (float)size - 0.5f);
    }
    x -= 0.5f;
    if (!(fabsf(x) < 1e9f)) return false;
    int whole = (int)x;
    whole -= x < (float)whole;
    weight[1] = x - (float)whole;
    weight[0] = 1 - weight[1];
    *lower = (size_t)(cyclic ? whole & (size - 1) : whole);
    return true;
}

static inline size_t plain_cell(const VoxelLevel *level, size_t x, size_t y, size_t z) {
    return (z * (size_t)(level->size[1] + 1) + y) * (size_t)(level->size[0] + 1) + x;
}

/* In the order in which add_corners() adds. */
static void add_plain(const VoxelLevel *level, const bool cyclic[3], Vec3f p, float factor, float sums[SUMS]) {
    size_t lower[3];
    float side[3][2], w[8], all[PLAIN_FLOATS];
    if (!plain_on_axis(p.x * level->per_side[0], level->size[0], cyclic[0], &lower[0], side[0]) ||
        !plain_on_axis(p.y * level->per_side[1], level->size[1], cyclic[1], &lower[1], side[1]) ||
        !plain_on_axis(p.z * level->per_side[2], level->size[2], cyclic[2], &lower[2], side[2]))
        return;
    const uint16_t *cell = level->plain_at + plain_cell(level, lower[0], lower[1], lower[2]);
    const size_t row = plain_cell(level, 0, 1, 0), slice = plain_cell(level, 0, 0, 1);
    const uint16_t at[8] = {cell[0], cell[1], cell[row], cell[row + 1], cell[slice], cell[slice + 1], cell[slice + row], cell[slice + row + 1]};
    if (!(at[0] | at[1] | at[2] | at[3] | at[4] | at[5] | at[6] | at[7])) return;
    const float(*v)[PLAIN_FLOATS] = (const float(*)[PLAIN_FLOATS])level->plain;
    for (int i = 0; i < 8; i++) w[i] = side[0][i & 1] * (side[1][i >> 1 & 1] * side[2][i >> 2]) * v[at[i]][PLAIN_DENSITY];
    for (int i = 0; i < PLAIN_FLOATS; i++)
        all[i] = ((w[0] * v[at[0]][i] + w[4] * v[at[4]][i]) + (w[1] * v[at[1]][i] + w[5] * v[at[5]][i])) +
                 ((w[2] * v[at[2]][i] + w[6] * v[at[6]][i]) + (w[3] * v[at[3]][i] + w[7] * v[at[7]][i]));
    for (int i = 0; i < SUMS; i++) sums[i] += factor * all[i];
}

static void take_apart(const VoxelCode *code, float out[PLAIN_FLOATS]) {
    const uint32_t diagonal[4] = {code->diagonal}, rest[4] = {code->rest};
    float lanes[SUMS][4];
    decode_plain(diagonal, rest, lanes);
    for (int i = 0; i < SUMS; i++) out[i] = lanes[i][0];
    out[PLAIN_DENSITY] = voxel_code_density(code->rest);
}

/* What lies one voxel beyond is the first again along cyclic axes, else nothing. */
static void number_cells(VoxelLevel *level, const bool cyclic[3]) {
    uint16_t *cell = level->plain_at;
    for (int z = 0; z <= level->size[2]; z++)
        for (int y = 0; y <= level->size[1]; y++)
            for (int x = 0; x <= level->size[0]; x++, cell++) {
                int at[3] = {x, y, z};
                bool within = true;
                for (int k = 0; k < 3; k++) {
                    within &= cyclic[k] || at[k] < level->size[k];
                    if (at[k] == level->size[k]) at[k] = 0;
                }
                const VoxelCode *code;
                const int32_t brick = level->index[voxel_level_brick_at(level, at[0] / BRICK_SIDE, at[1] / BRICK_SIDE, at[2] / BRICK_SIDE)];
                const uint32_t bit = (uint32_t)(at[1] % BRICK_SIDE * BRICK_SIDE + at[0] % BRICK_SIDE);
                if (within && find_row(level, brick, (uint32_t)(at[2] % BRICK_SIDE), bit, &code) & 1) *cell = (uint16_t)(code - level->codes + 1);
            }
}

void voxel_layer_unpack(VoxelLayer *layer) {
    enum { MOST_CELLS = UINT16_MAX };
    for (int i = 0; i < layer->levels; i++) {
        VoxelLevel *level = &layer->level[i];
        const size_t cells = plain_cell(level, 0, 0, (size_t)level->size[2] + 1);
        if (cells > MOST_CELLS || level->plain) continue;
        level->plain = calloc(level->code_count + 1, sizeof *level->plain);
        level->plain_at = calloc(cells, sizeof *level->plain_at);
        if (!level->plain || !level->plain_at) {
            voxel_layer_pack(layer);
            return;
        }
        for (size_t k = 0; k < level->code_count; k++) take_apart(&level->codes[k], level->plain[k + 1]);
        number_cells(level, layer->cyclic);
    }
}

void voxel_layer_pack(VoxelLayer *layer) {
    for (int i = 0; i < layer->levels; i++) {
        free(layer->level[i].plain);
        free(layer->level[i].plain_at);
        layer->level[i].plain = NULL;
        layer->level[i].plain_at = NULL;
    }
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
        .solid = k * sums[SUM_SOLID],
        .s = {s * sums[SUM_XX], s * sums[SUM_YY], s * sums[SUM_ZZ], s * sums[SUM_XY], s * sums[SUM_XZ],
              s * sums[SUM_YZ]},
    };
    return true;
}

/* Of a level of one voxel, which holds its value all over the layer. */
static void add_single(const VoxelLayer *layer, const VoxelLevel *level, Vec3f p, float factor, float sums[SUMS]) {
    const float at[3] = {p.x * level->per_side[0], p.y * level->per_side[1], p.z * level->per_side[2]};
    float lanes[SUMS][4];
    if (!level->code_count) return;
    for (int k = 0; k < 3; k++)
        if (layer->cyclic[k] ? !(fabsf(at[k]) < 1e9f) : !(at[k] >= 0 && at[k] <= 1)) return;
    const uint32_t diagonal[4] = {level->codes[0].diagonal}, rest[4] = {level->codes[0].rest};
    decode_four(diagonal, rest, (const float[4]){factor}, lanes);
    for (int i = 0; i < SUMS; i++) sums[i] += lanes[i][0];
}

static void add_level(const VoxelLayer *layer, int number, Vec3f p, float factor, float sums[SUMS]) {
    const VoxelLevel *level = &layer->level[number];
    if (level->size[0] == 1 && level->size[1] == 1 && level->size[2] == 1) {
        add_single(layer, level, p, factor * level->density_unit, sums);
        return;
    }
    Corners corners;
    if (level->plain) add_plain(level, layer->cyclic, p, factor * level->density_unit, sums);
    else if (gather(level, layer->cyclic, p, &corners)) add_corners(&corners, factor * level->density_unit, sums);
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

bool voxel_layer_nearest(const VoxelLayer *layer, int number, Vec3f p, uint32_t *voxel, Vec3f *middle) {
    const VoxelLevel *level = &layer->level[int_clamp(number, 0, layer->levels - 1)];
    const float at[3] = {p.x, p.y, p.z};
    AxisPair axes[3];
    float most = 0;
    for (int k = 0; k < 3; k++)
        if (!pair_on_axis(at[k] * level->per_side[k], level->size[k], layer->cyclic[k], &axes[k])) return false;
    for (int i = 0; i < 8; i++) {
        int x = i & 1, y = i >> 1 & 1, z = i >> 2;
        float weight = axes[0].weight[x] * axes[1].weight[y] * axes[2].weight[z];
        if (!(weight > most)) continue;
        const VoxelCode *code;
        int32_t brick = level->index[voxel_level_brick_at(level, (int)axes[0].brick[x], (int)axes[1].brick[y], (int)axes[2].brick[z])];
        if (!(find_row(level, brick, axes[2].place[z], axes[1].place[y] * BRICK_SIDE + axes[0].place[x], &code) & 1)) continue;
        most = weight;
        *voxel = (uint32_t)(code - level->codes);
        *middle = vec3f(((float)(axes[0].brick[x] * BRICK_SIDE + axes[0].place[x]) + 0.5f) * level->sides[0],
                        ((float)(axes[1].brick[y] * BRICK_SIDE + axes[1].place[y]) + 0.5f) * level->sides[1],
                        ((float)(axes[2].brick[z] * BRICK_SIDE + axes[2].place[z]) + 0.5f) * level->sides[2]);
    }
    return most > 0;
}
