#include "texel/voxel_layer.h"

#include "texel/voxel_pairs.h"
#include "texel/voxel_trim.h"

#include <stdlib.h>

void *voxel_layer_allocate(VoxelLayer *layer, size_t count, size_t size) {
    if (count != 0 && size > SIZE_MAX / count) return NULL;
    size_t bytes = count * size;
    if (!memory_budget_take(layer->memory, bytes)) return NULL;
    void *block = calloc(count ? count : 1, size ? size : 1);
    if (block)
        layer->bytes += bytes;
    else
        memory_budget_give_back(layer->memory, bytes);
    return block;
}

static int round_up_to_power(int n) {
    int power = 1;
    while (power < n) power *= 2;
    return power;
}

/* The power of two nearest to x by ratio, at least 1. */
static int nearest_power(float x) {
    int power = 1;
    while (x > (float)power * 1.41421356f && power < TEXEL_LARGEST_RESOLUTION) power *= 2;
    return power;
}

static void set_sizes(VoxelLayer *layer, const TexelBuildOptions *options) {
    int resolution = round_up_to_power(int_clamp(options->resolution, 1, TEXEL_LARGEST_RESOLUTION));
    const float extent[3] = {options->extent.x, options->extent.y, options->extent.z};
    int size[3];
    for (int i = 0; i < 3; i++) size[i] = nearest_power((float)resolution * extent[i]);
    int longest = int_max(size[0], int_max(size[1], size[2]));
    for (layer->levels = 0; longest >> layer->levels; layer->levels++) {
        VoxelLevel *level = &layer->level[layer->levels];
        for (int i = 0; i < 3; i++) {
            level->size[i] = int_max(1, size[i] >> layer->levels);
            level->brick_size[i] = (level->size[i] + BRICK_SIDE - 1) / BRICK_SIDE;
            level->sides[i] = extent[i] / (float)level->size[i];
            level->per_side[i] = (float)level->size[i] / extent[i];
        }
        level->density_unit = (float)(longest >> layer->levels);
    }
}

VoxelLayer *voxel_layer_create(const TexelBuildOptions *options) {
    if (!memory_budget_take(options->memory, sizeof(VoxelLayer))) return NULL;
    VoxelLayer *layer = calloc(1, sizeof *layer);
    if (!layer) {
        memory_budget_give_back(options->memory, sizeof(VoxelLayer));
        return NULL;
    }
    layer->owners = 1;
    layer->memory = options->memory;
    layer->bytes = sizeof *layer;
    layer->filtering = options->filtering;
    layer->scattered = options->field != NULL;
    for (int i = 0; i < 3; i++) layer->cyclic[i] = options->cyclic >> i & 1;
    voxel_layer_forget_trim(layer);
    voxel_layer_forget_pairs(layer);
    set_sizes(layer, options);
    return layer;
}

VoxelLayer *voxel_layer_share(VoxelLayer *layer) {
    layer->owners++;
    return layer;
}

void voxel_layer_destroy(VoxelLayer *layer) {
    if (!layer || --layer->owners > 0) return;
    for (int i = 0; i < layer->levels; i++) {
        free(layer->level[i].index);
        free(layer->level[i].support.index);
        free(layer->level[i].support.bits);
        free(layer->level[i].bricks);
        free(layer->level[i].codes);
    }
    memory_budget_give_back(layer->memory, layer->bytes);
    free(layer);
}

int voxel_layer_levels(const VoxelLayer *layer) { return layer->levels; }

void voxel_layer_size(const VoxelLayer *layer, int level, int size[3]) {
    const VoxelLevel *l = &layer->level[int_clamp(level, 0, layer->levels - 1)];
    for (int i = 0; i < 3; i++) size[i] = l->size[i];
}

size_t voxel_layer_voxels(const VoxelLayer *layer, int level) { return layer->level[level].code_count; }
size_t voxel_layer_bricks(const VoxelLayer *layer, int level) { return layer->level[level].brick_count; }
size_t voxel_layer_bytes(const VoxelLayer *layer) { return layer->bytes; }

bool voxel_layer_is_empty(const VoxelLayer *layer) { return layer->level[layer->levels - 1].code_count == 0; }

Hash128 voxel_layer_hash(const VoxelLayer *layer) {
    Hash128 hash = hash_begin((uint64_t)layer->levels);
    hash_add(&hash, layer->trim, sizeof layer->trim);
    hash_add(&hash, &layer->pairs, sizeof layer->pairs);
    for (int i = 0; i < layer->levels; i++) {
        const VoxelLevel *l = &layer->level[i];
        hash_add(&hash, l->size, sizeof l->size);
        hash_add(&hash, l->index, voxel_level_bricks(l) * sizeof *l->index);
        hash_add(&hash, l->support.bits, l->support.count * sizeof *l->support.bits);
        hash_add(&hash, l->bricks, l->brick_count * sizeof *l->bricks);
        hash_add(&hash, l->codes, l->code_count * sizeof *l->codes);
    }
    return hash;
}
