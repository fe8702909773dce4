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
        voxel_raster_add(cells, &triangle, p->mesh->solid && p->mesh->solid[item->triangle], size,
                         finest->sides);
    }
}

/* Matter that is no triangles. */
static void add_field(const Pyramid *p, const int at[3], VoxelCell *cells) {
    const VoxelLevel *finest = &p->layer->level[0];
    const Vec3f sides = {finest->sides[0], finest->sides[1], finest->sides[2]};
    for (int i = 0; i < BRICK_VOXELS; i++) {
        const int voxel[3] = {at[0] * BRICK_SIDE + (i & 7), at[1] * BRICK_SIDE + (i >> 3 & 7), at[2] * BRICK_SIDE + (i >> 6)};
        if (voxel[0] >= finest->size[0] || voxel[1] >= finest->size[1] || voxel[2] >= finest->size[2]) continue;
        Vec3f lo = {(float)voxel[0] * sides.x, (float)voxel[1] * sides.y, (float)voxel[2] * sides.z};
        p->field->fill(p->field->context, lo, sides, &cells[i].sheet, cells[i].normals);
    }
}

/* Middles of voxels within solids. */
static void fill_finest(const Pyramid *p, const int at[3], VoxelCell *cells) {
    const VoxelLevel *finest = &p->layer->level[0];
    for (int z = 0; z < BRICK_SIDE && at[2] * BRICK_SIDE + z < finest->size[2]; z++)
        for (int x = 0; x < BRICK_SIDE && at[0] * BRICK_SIDE + x < finest->size[0]; x++) {
            uint32_t bits = voxel_fill_column(p->fill, at[0] * BRICK_SIDE + x, at[1] * BRICK_SIDE,
                                              at[2] * BRICK_SIDE + z);
            for (int y = 0; bits; y++, bits >>= 1)
                cells[(z * BRICK_SIDE + y) * BRICK_SIDE + x].fill = (float)(bits & 1);
        }
}

/* Whether the middle of a voxel lies within a solid; nothing does beyond the border. */
static bool is_filled(const Pyramid *p, const int voxel[3]) {
    int at[3];
    for (int k = 0; k < 3; k++) {
        int size = p->layer->level[0].size[k];
        at[k] = p->layer->cyclic[k] ? (voxel[k] + size) % size : voxel[k];
        if (at[k] < 0 || at[k] >= size) return false;
    }
    return voxel_fill_column(p->fill, at[0], at[1], at[2]) & 1;
}

/* Whether all is filled around a voxel, across the walls in it. */
static bool is_hidden(const Pyramid *p, const int voxel[3], const VoxelCell *cell) {
    static const float FACING = 0.02f; /* share of the area that turns to an axis */
    float trace = cell->normals[0] + cell->normals[1] + cell->normals[2];
    int reach[3], by[3];
    for (int k = 0; k < 3; k++) reach[k] = cell->normals[k] > FACING * trace;
    for (by[2] = -reach[2]; by[2] <= reach[2]; by[2]++)
        for (by[1] = -reach[1]; by[1] <= reach[1]; by[1]++)
            for (by[0] = -reach[0]; by[0] <= reach[0]; by[0]++)
                if (!is_filled(p, (const int[3]){voxel[0] + by[0], voxel[1] + by[1], voxel[2] + by[2]})) return false;
    return true;
}

/* Walls and sheets within solids, as where solids reach into each other or into their own copies: no ray comes there. */
static void drop_hidden(const Pyramid *p, const int at[3], VoxelCell *cells) {
    for (int i = 0; i < BRICK_VOXELS; i++) {
        const int voxel[3] = {at[0] * BRICK_SIDE + (i & 7), at[1] * BRICK_SIDE + (i >> 3 & 7), at[2] * BRICK_SIDE + (i >> 6)};
        if (cells[i].fill > 0 && !voxel_cell_is_empty(&cells[i]) && is_hidden(p, voxel, &cells[i])) cells[i] = (VoxelCell){.fill = 1};
    }
}

static void close_cells(VoxelCell *cells, int level, TexelFiltering filtering) {
    for (int i = 0; i < BRICK_VOXELS; i++) {
        if (voxel_cell_is_empty(&cells[i])) continue;
        if (level == 0)
            voxel_cell_close_finest(&cells[i]);
        else
            voxel_cell_close_merged(&cells[i], filtering);
    }
}

/* Where voxel i of brick `at` of a level is in the brick above it; corner as voxel_cell_merge() wants it. */
static int index_in_parent(const bool halved[3], const int at[3], int i, int corner[3]) {
    const int voxel[3] = {at[0] * BRICK_SIDE + (i & 7), at[1] * BRICK_SIDE + (i >> 3 & 7),
                          at[2] * BRICK_SIDE + (i >> 6)};
    int parent[3];
    for (int k = 0; k < 3; k++) {
        parent[k] = (halved[k] ? voxel[k] >> 1 : voxel[k]) & (BRICK_SIDE - 1);
        corner[k] = halved[k] ? voxel[k] & 1 : 0;
    }
    return (parent[2] * BRICK_SIDE + parent[1]) * BRICK_SIDE + parent[0];
}

static VoxelMerge step_to(const VoxelLayer *layer, int level) {
    const int *finest = layer->level[0].size, *size = layer->level[level].size;
    VoxelMerge step = {.level = level, .share = 1, .filtering = layer->filtering};
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        step.halved[k] = voxel_layer_halves(layer, level - 1, k);
        if (step.halved[k]) step.share /= 2;
        step.rays[k] = (float)(finest[u] / size[u]) * (float)(finest[v] / size[v]);
    }
    return step;
}

/* Adds the cells of brick `at` of level − 1 to those of its parent. */
static void merge_brick(const VoxelLayer *layer, int level, const int at[3], const VoxelCell *from,
                        VoxelCell *to) {
    VoxelMerge step = step_to(layer, level);
    for (int i = 0; i < BRICK_VOXELS; i++) {
        if (voxel_cell_is_empty(&from[i]) && !(from[i].fill > 0)) continue;
        int corner[3], parent = index_in_parent(step.halved, at, i, corner);
        voxel_cell_merge(&to[parent], &from[i], &step, corner);
    }
}

/* Adds a brick that lies within a solid as a whole. */
static void merge_inside(const VoxelLayer *layer, int level, const int at[3], VoxelCell *to) {
    VoxelMerge step = step_to(layer, level);
    for (int i = 0; i < BRICK_VOXELS; i++) {
        int corner[3];
        to[index_in_parent(step.halved, at, i, corner)].fill += step.share;
    }
}

/* The bricks of level − 1 under brick `at` of level that have any of these marks, and none of those. */
static int list_children(const Pyramid *p, int level, const int at[3], int with, int without,
                         int children[PYRAMID_CHILDREN][3]) {
    const VoxelLevel *below = &p->layer->level[level - 1];
    int first[3], end[3], c[3], count = 0;
    for (int k = 0; k < 3; k++) {
        bool halved = voxel_layer_halves(p->layer, level - 1, k);
        first[k] = halved ? 2 * at[k] : at[k];
        end[k] = int_min(below->brick_size[k], first[k] + (halved ? 2 : 1));
    }
    for (c[2] = first[2]; c[2] < end[2]; c[2]++)
        for (c[1] = first[1]; c[1] < end[1]; c[1]++)
            for (c[0] = first[0]; c[0] < end[0]; c[0]++) {
                int marks = p->marks[level - 1][voxel_level_brick_at(below, c[0], c[1], c[2])];
                if (marks & with && !(marks & without)) memcpy(children[count++], c, sizeof c);
            }
    return count;
}

/* Bricks of one level that are known together: those under one brick of the next. */
typedef struct BrickBlock {
    const int (*bricks)[3];
    const VoxelCell *cells; /* BRICK_VOXELS for each */
    int count;
    const VoxelLevel *level;
    const uint8_t *marks; /* of the level's bricks */
    bool cyclic[3], scattered;
    int first[3], end[3]; /* voxels of the block: outside nothing is known */
} BrickBlock;

/* The cell of a voxel; NULL where it is not known. */
static const VoxelCell *block_cell(const BrickBlock *block, const int voxel[3]) {
    static const VoxelCell nothing = {0};
    for (int k = 0; k < 3; k++) {
        if (!block->cyclic[k] && (voxel[k] < 0 || voxel[k] >= block->level->size[k])) return &nothing;
        if (voxel[k] < block->first[k] || voxel[k] >= block->end[k]) return NULL;
    }
    for (int i = 0; i < block->count; i++) {
        const int *b = block->bricks[i];
        if (b[0] == voxel[0] / BRICK_SIDE && b[1] == voxel[1] / BRICK_SIDE && b[2] == voxel[2] / BRICK_SIDE)
            return &block
                        ->cells[i * BRICK_VOXELS +
                                ((voxel[2] & 7) * BRICK_SIDE + (voxel[1] & 7)) * BRICK_SIDE + (voxel[0] & 7)];
    }
    return &nothing;
}

static VoxelSurround look_around(const BrickBlock *block, const int brick[3], const VoxelCell *cells, int i) {
    static const int strides[3] = {1, BRICK_SIDE, BRICK_SIDE * BRICK_SIDE};
    const int within[3] = {i & 7, i >> 3 & 7, i >> 6};
    VoxelSurround around;
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++) {
            int step = side ? 1 : -1, there = within[k] + step;
            if (there >= 0 && there < BRICK_SIDE) {
                around.near[k][side] = &cells[i + step * strides[k]];
                continue;
            }
            int voxel[3] = {brick[0] * BRICK_SIDE + within[0], brick[1] * BRICK_SIDE + within[1],
                            brick[2] * BRICK_SIDE + within[2]};
            voxel[k] += step;
            around.near[k][side] = block_cell(block, voxel);
        }
    return around;
}

/* Where a solid is so thin that no voxel lies within it as a whole, those that nearly do stand for its inside; their little area is
 * left out. At fine levels the share that is inside is known too roughly for that. */
enum { LEAST_LEVEL = 2 };
static const float NEARLY_INSIDE = 0.95f;

static bool is_inside(const BrickBlock *block, int level, const int brick[3], const VoxelCell *cells, int i) {
    if (voxel_cell_is_empty(&cells[i])) return voxel_cell_is_inside(&cells[i]);
    if (level < LEAST_LEVEL || cells[i].fill < NEARLY_INSIDE) return false;
    for (int side = 0; side < 27; side++) {
        const int at[3] = {brick[0] * BRICK_SIDE + (i & 7) + side % 3 - 1,
                           brick[1] * BRICK_SIDE + (i >> 3 & 7) + side / 3 % 3 - 1,
                           brick[2] * BRICK_SIDE + (i >> 6) + side / 9 - 1};
        const VoxelCell *near = block_cell(block, at);
        if (near && voxel_cell_is_inside(near)) return false;
    }
    return true;
}

/* Whether the wall of a solid has a voxel of its inside beside it, or may have one that is not known. */
static bool is_backed(const BrickBlock *block, int level, const int brick[3], const VoxelCell *cell, int i) {
    if (!(cell->solid > 0)) return false;
    for (int side = 0; side < 27; side++) {
        int at[3] = {brick[0] * BRICK_SIDE + (i & 7) + side % 3 - 1, brick[1] * BRICK_SIDE + (i >> 3 & 7) + side / 3 % 3 - 1,
                     brick[2] * BRICK_SIDE + (i >> 6) + side / 9 - 1};
        for (int k = 0; k < 3; k++)
            if (block->cyclic[k]) at[k] = (at[k] + block->level->size[k]) % block->level->size[k];
        const VoxelCell *near = block_cell(block, at);
        if (!near || voxel_cell_is_inside(near) || (level >= LEAST_LEVEL && near->fill >= NEARLY_INSIDE)) return true;
    }
    return false;
}

/* Deep within a solid nothing is stored: no ray comes there. Where a voxel is not known, its brick may have walls. */
static bool is_beside_walls(const BrickBlock *block, const int brick[3], int i) {
    const int first[3] = {brick[0] * BRICK_SIDE + (i & 7), brick[1] * BRICK_SIDE + (i >> 3 & 7),
                          brick[2] * BRICK_SIDE + (i >> 6)};
    for (int side = 0; side < 27; side++) {
        int at[3] = {first[0] + side % 3 - 1, first[1] + side / 3 % 3 - 1, first[2] + side / 9 - 1};
        const VoxelCell *near = block_cell(block, at);
        if (near && !voxel_cell_is_empty(near)) return true;
        if (near) continue;
        for (int k = 0; k < 3; k++)
            at[k] = (at[k] + block->level->size[k]) % block->level->size[k] / BRICK_SIDE;
        if (block->marks[voxel_level_brick_at(block->level, at[0], at[1], at[2])] & BRICK_AREA) return true;
    }
    return false;
}

/* Thinness around a parent: over its neighbours too, as far as they are in its brick, since few pairs of walls are a bad sample. */
static float thinness_around(const VoxelCell *parents, int i, bool fine) {
    VoxelCell sum = {.walls = 0};
    const int first[3] = {i & 7, i >> 3 & 7, i >> 6};
    if (!(parents[i].walls > 0)) return 1;
    for (int side = 0; side < 27; side++) {
        const int at[3] = {first[0] + side % 3 - 1, first[1] + side / 3 % 3 - 1, first[2] + side / 9 - 1};
        if ((unsigned)at[0] >= BRICK_SIDE || (unsigned)at[1] >= BRICK_SIDE || (unsigned)at[2] >= BRICK_SIDE)
            continue;
        const VoxelCell *near = &parents[(at[2] * BRICK_SIDE + at[1]) * BRICK_SIDE + at[0]];
        sum.walls += near->walls;
        sum.apart += near->apart;
        sum.single += near->single;
    }
    return voxel_cell_thinness(&sum, fine);
}

static VoxelCode code_inside(const VoxelCell *parent) {
    Sym3f root = voxel_cell_root_inside(parent);
    return voxel_code_inside(&root);
}

static VoxelCode code_matter(const VoxelCell *cell, const VoxelSurround *around, const VoxelLevel *l,
                             bool scattered, float thin, bool backed) {
    VoxelMatter m = voxel_cell_matter(cell, around, l->sides, 1 / l->density_unit, thin, backed);
    VoxelCode code = voxel_code_pack(m.density, scattered ? 0 : m.gamma, &m.root);
    return m.wall ? voxel_code_wall(code) : code;
}

/* parent: the cells of the brick above; NULL for the topmost. */
static void code_brick(const BrickBlock *block, int level, const bool halved[3], int number,
                       const VoxelCell *parent, PyramidOutput *out) {
    const VoxelLevel *l = block->level;
    const int *at = block->bricks[number];
    const VoxelCell *cells = block->cells + number * BRICK_VOXELS;
    BuiltBrick brick = {.level = level,
                        .place = (uint32_t)voxel_level_brick_at(l, at[0], at[1], at[2]),
                        .first = out->codes.count};
    if (!parent) parent = cells;
    float thin[BRICK_VOXELS]; /* of parents, once known */
    for (int i = 0; i < BRICK_VOXELS; i++) thin[i] = -1;
    for (int i = 0; i < BRICK_VOXELS; i++) {
        bool inside = is_inside(block, level, at, cells, i);
        if (voxel_cell_is_empty(&cells[i]) && !inside) continue;
        int corner[3], above = index_in_parent(halved, at, i, corner);
        VoxelSurround around = look_around(block, at, cells, i);
        if (inside && voxel_cell_is_empty(&cells[i]) && voxel_cell_is_empty(&parent[above]) &&
            !is_beside_walls(block, at, i))
            continue;
        VoxelCode *code = grow_buffer_add(&out->codes, 1, sizeof *code);
        if (!code) return;
        if (!inside && thin[above] < 0) thin[above] = thinness_around(parent, above, level < LEAST_LEVEL);
        *code = inside ? code_inside(&parent[above]) : code_matter(&cells[i], &around, l, block->scattered, thin[above], is_backed(block, level, at, &cells[i], i));
        brick.slice[i >> 6] |= (uint64_t)1 << (i & 63);
    }
    brick.count = out->codes.count - brick.first;
    if (brick.count == 0) return;
    BuiltBrick *place = grow_buffer_add(&out->bricks, 1, sizeof *place);
    if (place) *place = brick;
}

static BrickBlock make_block(const Pyramid *p, int level, const int (*bricks)[3], int count,
                             const VoxelCell *cells) {
    BrickBlock block = {.bricks = bricks,
                        .cells = cells,
                        .count = count,
                        .level = &p->layer->level[level],
                        .marks = p->marks[level],
                        .scattered = p->layer->scattered};
    memcpy(block.cyclic, p->layer->cyclic, sizeof block.cyclic);
    return block;
}

/* Codes the bricks under brick `at` of level + 1, whose cells are `parent`. */
static void code_children(const Pyramid *p, int level, const int at[3], const int (*bricks)[3], int count,
                          const VoxelCell *cells, const VoxelCell *parent, PyramidOutput *out) {
    BrickBlock block = make_block(p, level, bricks, count, cells);
    bool halved[3];
    for (int k = 0; k < 3; k++) {
        halved[k] = voxel_layer_halves(p->layer, level, k);
        int bricks_wide = halved[k] ? 2 : 1;
        block.first[k] = at[k] * bricks_wide * BRICK_SIDE;
        block.end[k] = int_min(block.first[k] + bricks_wide * BRICK_SIDE, block.level->size[k]);
    }
    for (int i = 0; i < count; i++) code_brick(&block, level, halved, i, parent, out);
}

void pyramid_code_top(const Pyramid *p, const VoxelCell *cells, PyramidOutput *out) {
    static const int origin[1][3] = {{0, 0, 0}};
    int top = p->layer->levels - 1;
    BrickBlock block = make_block(p, top, origin, 1, cells);
    const bool halved[3] = {false, false, false};
    for (int k = 0; k < 3; k++) block.end[k] = block.level->size[k];
    code_brick(&block, top, halved, 0, NULL, out);
}

static void build_from_children(const Pyramid *p, int level, const int at[3], bool from_top, VoxelCell *cells,
                                VoxelCell *scratch, PyramidOutput *out) {
    int children[PYRAMID_CHILDREN][3],
        count = list_children(p, level, at, BRICK_INSIDE, BRICK_BUILT, children);
    for (int i = 0; i < count; i++) merge_inside(p->layer, level, children[i], cells);
    count = list_children(p, level, at, BRICK_BUILT, 0, children);
    VoxelCell *deeper = scratch + PYRAMID_CHILDREN * BRICK_VOXELS;
    memset(scratch, 0, (size_t)count * BRICK_VOXELS * sizeof *scratch);
    for (int i = 0; i < count; i++) {
        VoxelCell *child = scratch + i * BRICK_VOXELS;
        pyramid_build_brick(p, level - 1, children[i], from_top, child, deeper, out);
        merge_brick(p->layer, level, children[i], child, cells);
    }
    close_cells(cells, level, p->layer->filtering);
    code_children(p, level - 1, at, (const int(*)[3])children, count, scratch, cells, out);
}

void pyramid_build_brick(const Pyramid *p, int level, const int at[3], bool from_top, VoxelCell *cells,
                         VoxelCell *scratch, PyramidOutput *out) {
    if (from_top && level == p->job_level) {
        size_t place = voxel_level_brick_at(&p->layer->level[level], at[0], at[1], at[2]);
        if (p->job_cells[place]) memcpy(cells, p->job_cells[place], BRICK_VOXELS * sizeof *cells);
    } else if (level == 0) {
        build_finest(p, at, cells);
        if (p->field) add_field(p, at, cells);
        if (p->fill->start) {
            fill_finest(p, at, cells);
            drop_hidden(p, at, cells);
        }
        close_cells(cells, 0, p->layer->filtering);
    } else {
        build_from_children(p, level, at, from_top, cells, scratch, out);
    }
}
