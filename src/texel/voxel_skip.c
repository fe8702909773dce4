#include "texel/voxel_layer.h"

#include <math.h>

/* Marks the bricks from which interpolation reaches the occupied voxel at the end of the walk: its own brick and, where it
 * lies at a face, edge or corner, those beyond. */
static void reach(VoxelLevel *level, const bool cyclic[3], const int voxel[3]) {
    int bricks[3][2], counts[3];
    for (int k = 0; k < 3; k++) {
        int brick = voxel[k] / BRICK_SIDE, place = voxel[k] % BRICK_SIDE, n = level->brick_size[k],
            next = brick;
        if (place == 0) next = brick - 1;
        if (place == BRICK_SIDE - 1 || voxel[k] == level->size[k] - 1)
            next = place == 0 && n > 1 ? next : brick + 1;
        if (cyclic[k]) next = (next + n) % n;
        bricks[k][0] = brick;
        bricks[k][1] = next;
        counts[k] = next != brick && next >= 0 && next < n ? 2 : 1;
    }
    for (int z = 0; z < counts[2]; z++)
        for (int y = 0; y < counts[1]; y++)
            for (int x = 0; x < counts[0]; x++)
                level->reached[voxel_level_brick_at(level, bricks[0][x], bricks[1][y], bricks[2][z])] = 1;
}

void voxel_level_mark_reached(VoxelLevel *level, const bool cyclic[3]) {
    size_t count = voxel_level_bricks(level);
    for (size_t i = 0; i < count; i++) level->reached[i] = 0;
    for (size_t i = 0; i < count; i++) {
        if (level->index[i] < 0) continue;
        const VoxelBrick *brick = &level->bricks[level->index[i]];
        size_t nx = (size_t)level->brick_size[0], ny = (size_t)level->brick_size[1];
        const int corner[3] = {(int)(i % nx) * BRICK_SIDE, (int)(i / nx % ny) * BRICK_SIDE,
                               (int)(i / nx / ny) * BRICK_SIDE};
        for (int v = 0; v < BRICK_VOXELS; v++) {
            if (!(brick->mask[v >> 3] >> (v & 7) & 1)) continue;
            const int voxel[3] = {corner[0] + (v & 7), corner[1] + (v >> 3 & 7), corner[2] + (v >> 6)};
            reach(level, cyclic, voxel);
        }
    }
}

/* A walk through a level's bricks along a ray. */
typedef struct BrickWalk {
    int at[3], step[3];
    float next[3], per_brick[3]; /* where the ray leaves the brick along each axis; length between two such */
} BrickWalk;

static bool start_walk(const VoxelLevel *level, const float p[3], const float d[3], BrickWalk *walk) {
    for (int k = 0; k < 3; k++) {
        float per_brick = level->per_side[k] / BRICK_SIDE, x = p[k] * per_brick, speed = d[k] * per_brick;
        if (!(x >= 0 && x <= (float)level->brick_size[k])) return false;
        walk->at[k] = int_min((int)x, level->brick_size[k] - 1);
        walk->step[k] = speed > 0 ? 1 : -1;
        float edge = speed > 0 ? (float)(walk->at[k] + 1) : (float)walk->at[k];
        walk->per_brick[k] = speed != 0 ? fabsf(1 / speed) : INFINITY;
        walk->next[k] = speed != 0 ? float_max(0, (edge - x) / speed) : INFINITY;
    }
    return true;
}

/* To where the first brick is entered from which anything is within reach, at most limit. */
static float skip_level(const VoxelLayer *layer, int index, const float p[3], const float d[3], float limit) {
    const VoxelLevel *level = &layer->level[index];
    BrickWalk walk;
    if (!start_walk(level, p, d, &walk)) return 0;
    float t = 0;
    while (t < limit && !level->reached[voxel_level_brick_at(level, walk.at[0], walk.at[1], walk.at[2])]) {
        int k = walk.next[0] <= walk.next[1] ? (walk.next[0] <= walk.next[2] ? 0 : 2)
                                             : (walk.next[1] <= walk.next[2] ? 1 : 2);
        t = walk.next[k];
        if (!(t < limit)) return limit;
        walk.next[k] += walk.per_brick[k];
        walk.at[k] += walk.step[k];
        if (walk.at[k] >= 0 && walk.at[k] < level->brick_size[k]) continue;
        if (!layer->cyclic[k]) return t;
        walk.at[k] = walk.at[k] < 0 ? level->brick_size[k] - 1 : 0;
    }
    return float_min(t, limit);
}

float voxel_layer_skip(const VoxelLayer *layer, float lod, Vec3f p, Vec3f d, float limit) {
    const float at[3] = {p.x, p.y, p.z}, along[3] = {d.x, d.y, d.z};
    lod = lod > 0 ? float_min(lod, (float)(layer->levels - 1)) : 0;
    int level = (int)lod;
    float skip = skip_level(layer, level, at, along, float_max(limit, 0));
    if (lod > (float)level && skip > 0) skip = skip_level(layer, level + 1, at, along, skip);
    return skip;
}
