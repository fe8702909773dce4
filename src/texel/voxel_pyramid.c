#include "texel/voxel_pyramid.h"

#include "texel/voxel_raster.h"

#include <string.h>

static void build_finest(const Pyramid *p, const int at[3], VoxelCell *cells) {
    const VoxelLevel *finest = &p->layer->level[0];
    size_t place = voxel_level_brick_at(finest, at[0], at[1], at[2]);
    int size[3];
    for (int k = 0; k < 3; k++) size[k] = int_min(BRICK_SIDE, finest->size[k] - at[k] * BRICK_SIDE);
    for (uint32_t i = p->bins->start[place]; i < p->bins->start[place + 1]; i++) {
        const BinnedTriangle *item = &p->bins->items[i];
        ClipPolygon triangle;
        if (!bin_load_triangle(p->mesh, p->layer, item->triangle, &triangle)) continue;
        for (int v = 0; v < 3; v++)
            for (int k = 0; k < 3; k++)
                triangle.at[v][k] -= (double)item->shift[k] * finest->size[k] + at[k] * BRICK_SIDE;
        voxel_raster_add(cells, &triangle, p->mesh->solid && p->mesh->solid[item->triangle], size, finest->sides);
    }
}

/* Adds the cells of brick `at` of level − 1 to those of its parent. */
static void merge_brick(const VoxelLayer *layer, int level, const int at[3], const VoxelCell *from, VoxelCell *to) {
    const int *finest = layer->level[0].size, *size = layer->level[level].size;
    VoxelMerge step = {.level = level};
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        step.halved[k] = voxel_layer_halves(layer, level - 1, k);
        step.rays[k] = (float)(finest[u] / size[u]) * (float)(finest[v] / size[v]);
    }
    for (int i = 0; i < BRICK_VOXELS; i++) {
        if (voxel_cell_is_empty(&from[i])) continue;
        const int voxel[3] = {at[0] * BRICK_SIDE + (i & 7), at[1] * BRICK_SIDE + (i >> 3 & 7), at[2] * BRICK_SIDE + (i >> 6)};
        int parent[3], corner[3];
        for (int k = 0; k < 3; k++) {
            parent[k] = (step.halved[k] ? voxel[k] >> 1 : voxel[k]) & (BRICK_SIDE - 1);
            corner[k] = step.halved[k] ? voxel[k] & 1 : 0;
        }
        voxel_cell_merge(&to[(parent[2] * BRICK_SIDE + parent[1]) * BRICK_SIDE + parent[0]], &from[i], &step, corner);
    }
}

static void build_from_children(const Pyramid *p, int level, const int at[3], bool from_top, VoxelCell *cells,
                                VoxelCell *scratch, PyramidOutput *out) {
    const VoxelLevel *below = &p->layer->level[level - 1];
    int first[3], end[3], child[3];
    for (int k = 0; k < 3; k++) {
        bool halved = voxel_layer_halves(p->layer, level - 1, k);
        first[k] = halved ? 2 * at[k] : at[k];
        end[k] = int_min(below->brick_size[k], first[k] + (halved ? 2 : 1));
    }
    for (child[2] = first[2]; child[2] < end[2]; child[2]++)
        for (child[1] = first[1]; child[1] < end[1]; child[1]++)
            for (child[0] = first[0]; child[0] < end[0]; child[0]++) {
                if (!p->present[level - 1][voxel_level_brick_at(below, child[0], child[1], child[2])]) continue;
                memset(scratch, 0, BRICK_VOXELS * sizeof *scratch);
                pyramid_build_brick(p, level - 1, child, from_top, scratch, scratch + BRICK_VOXELS, out);
                merge_brick(p->layer, level, child, scratch, cells);
            }
}

static void code_brick(const VoxelLayer *layer, int level, const int at[3], const VoxelCell *cells, PyramidOutput *out) {
    const VoxelLevel *l = &layer->level[level];
    BuiltBrick brick = {.level = level, .place = (uint32_t)voxel_level_brick_at(l, at[0], at[1], at[2]), .first = out->codes.count};
    for (int i = 0; i < BRICK_VOXELS; i++) {
        if (voxel_cell_is_empty(&cells[i])) continue;
        VoxelMatter m = voxel_cell_matter(&cells[i], l->sides, 1 / l->density_unit);
        VoxelCode *code = grow_buffer_add(&out->codes, 1, sizeof *code);
        if (!code) return;
        *code = voxel_code_pack(m.density, m.gamma, &m.root);
        brick.mask[i >> 3] |= (uint8_t)(1u << (i & 7));
    }
    brick.count = out->codes.count - brick.first;
    if (brick.count == 0) return;
    BuiltBrick *place = grow_buffer_add(&out->bricks, 1, sizeof *place);
    if (place) *place = brick;
}

void pyramid_build_brick(const Pyramid *p, int level, const int at[3], bool from_top, VoxelCell *cells, VoxelCell *scratch,
                         PyramidOutput *out) {
    if (from_top && level == p->job_level) {
        const VoxelCell *kept = p->job_cells[voxel_level_brick_at(&p->layer->level[level], at[0], at[1], at[2])];
        if (kept) memcpy(cells, kept, BRICK_VOXELS * sizeof *cells);
        return; /* already coded by its job */
    }
    if (level == 0) build_finest(p, at, cells);
    else build_from_children(p, level, at, from_top, cells, scratch, out);
    code_brick(p->layer, level, at, cells, out);
}
