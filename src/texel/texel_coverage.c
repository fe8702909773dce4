#include "texel/texel_coverage.h"

#include "texel/voxel_layer.h"

enum { MOST_RAYS = 32, STEPS_PER_VOXEL = 2 };

static float component(const float v[3], int axis, int want) { return axis == want ? v[want] : 0; }

static double transmittance(const VoxelLayer *layer, int index, OpacityModel model, int axis, float at[3]) {
    const VoxelLevel *level = &layer->level[index];
    float side = cbrtf(level->sides[0] * level->sides[1] * level->sides[2]);
    float half[3] = {level->sides[0] / STEPS_PER_VOXEL, level->sides[1] / STEPS_PER_VOXEL,
                     level->sides[2] / STEPS_PER_VOXEL};
    Vec3f step = vec3f(component(half, axis, 0), component(half, axis, 1), component(half, axis, 2));
    double through = 1;
    for (int i = 0; i < level->size[axis] * STEPS_PER_VOXEL; i++) {
        VoxelSample sample;
        at[axis] = ((float)i + 0.5f) * half[axis];
        if (voxel_layer_sample(layer, index, vec3f(at[0], at[1], at[2]), &sample))
            through *= (double)opacity_transmittance(model, &sample, side, step);
    }
    return through;
}

double voxel_layer_coverage(const VoxelLayer *layer, int index, int axis, OpacityModel model) {
    const VoxelLevel *level = &layer->level[index];
    int u = (axis + 1) % 3, v = (axis + 2) % 3, columns = int_min(level->size[u], MOST_RAYS),
        rows = int_min(level->size[v], MOST_RAYS);
    double hidden = 0;
    for (int i = 0; i < columns; i++)
        for (int j = 0; j < rows; j++) {
            float at[3];
            at[u] = ((float)i + 0.5f) / (float)columns * level->sides[u] * (float)level->size[u];
            at[v] = ((float)j + 0.5f) / (float)rows * level->sides[v] * (float)level->size[v];
            hidden += 1 - transmittance(layer, index, model, axis, at);
        }
    return hidden / (columns * rows);
}
