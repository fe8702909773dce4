#include "texel/voxel_pyramid.h"

#include "base/stopwatch.h"
#include "texel/layer_views.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { CACHE_LINE = 64, JOB_BRICKS_PER_AXIS = 8, SCRATCH_CELLS = BRICK_VOXELS * (1 + PYRAMID_CHILDREN * TEXEL_MAX_LEVELS) };

typedef struct Build {
    Pyramid pyramid;
    VoxelLayer *layer;
    const TexelBuildOptions *options;
    TriangleBins bins;
    VoxelFill fill;
    PyramidOutput *outputs; /* per job, and one more for the levels above */
    size_t jobs;
    VoxelCell **scratch; /* per worker */
    atomic_flag telling;
    atomic_size_t done;
} Build;

/* ---- marks ---- */

static bool field_touches(const Build *b, int x, int y, int z) {
    const TexelField *field = b->options->field;
    if (!field) return false;
    const float *sides = b->layer->level[0].sides;
    const Vec3f size = vec3f_scale(vec3f(sides[0], sides[1], sides[2]), BRICK_SIDE), at = {(float)x, (float)y, (float)z};
    Vec3f lo = vec3f_mul(at, size);
    return field->touches(field->context, lo, vec3f_add(lo, size));
}

static void mark_finest(const Build *b, uint8_t *marks) {
    const VoxelLevel *level = &b->layer->level[0];
    for (int z = 0; z < level->brick_size[2]; z++)
        for (int y = 0; y < level->brick_size[1]; y++)
            for (int x = 0; x < level->brick_size[0]; x++) {
                size_t i = voxel_level_brick_at(level, x, y, z);
                if (b->bins.start[i + 1] > b->bins.start[i] || field_touches(b, x, y, z))
                    marks[i] = BRICK_AREA | BRICK_BUILT;
                else if (voxel_fill_column(&b->fill, x * BRICK_SIDE, y * BRICK_SIDE, z * BRICK_SIDE) & 1)
                    marks[i] = BRICK_INSIDE;
            }
}

/* A level's marks from those of its bricks' children. */
static void mark_parents(const VoxelLayer *layer, int level, const uint8_t *below, uint8_t *marks) {
    const VoxelLevel *child = &layer->level[level - 1], *parent = &layer->level[level];
    size_t bricks = voxel_level_bricks(parent);
    for (size_t i = 0; i < bricks; i++) marks[i] = BRICK_INSIDE;
    for (int z = 0; z < child->brick_size[2]; z++)
        for (int y = 0; y < child->brick_size[1]; y++)
            for (int x = 0; x < child->brick_size[0]; x++) {
                int at[3] = {x, y, z};
                for (int k = 0; k < 3; k++)
                    if (voxel_layer_halves(layer, level - 1, k)) at[k] >>= 1;
                uint8_t from = below[voxel_level_brick_at(child, x, y, z)],
                        *to = &marks[voxel_level_brick_at(parent, at[0], at[1], at[2])];
                *to = (uint8_t)((*to & from & BRICK_INSIDE) | ((*to | from) & (BRICK_AREA | BRICK_BUILT)));
            }
}

/* What lies within a solid and next to its walls has voxels too. */
static void mark_beside(const VoxelLayer *layer, int level, uint8_t *marks) {
    const VoxelLevel *l = &layer->level[level];
    for (int z = 0; z < l->brick_size[2]; z++)
        for (int y = 0; y < l->brick_size[1]; y++)
            for (int x = 0; x < l->brick_size[0]; x++) {
                uint8_t *own = &marks[voxel_level_brick_at(l, x, y, z)];
                for (int side = 0; side < 6 && *own & BRICK_INSIDE; side++) {
                    int at[3] = {x, y, z}, k = side >> 1, size = l->brick_size[k];
                    at[k] += side & 1 ? 1 : -1;
                    if (layer->cyclic[k]) at[k] = (at[k] + size) % size;
                    if (at[k] < 0 || at[k] >= size) continue;
                    if (marks[voxel_level_brick_at(l, at[0], at[1], at[2])] & BRICK_AREA) *own |= BRICK_BUILT;
                }
            }
}

static bool mark_bricks(Build *b) {
    for (int i = 0; i < b->layer->levels; i++) {
        uint8_t *marks = b->pyramid.marks[i] = calloc(voxel_level_bricks(&b->layer->level[i]), 1);
        if (!marks) return false;
        if (i == 0)
            mark_finest(b, marks);
        else
            mark_parents(b->layer, i, b->pyramid.marks[i - 1], marks);
        if (b->fill.start) mark_beside(b->layer, i, marks);
    }
    return true;
}

static int choose_job_level(const VoxelLayer *layer) {
    int level = 0;
    while (level + 1 < layer->levels &&
           int_max(layer->level[level].brick_size[0],
                   int_max(layer->level[level].brick_size[1], layer->level[level].brick_size[2])) >
               JOB_BRICKS_PER_AXIS)
        level++;
    return level;
}

static bool take_scratch(Build *b) {
    size_t workers = (size_t)pool_threads(b->options->pool), bytes = SCRATCH_CELLS * sizeof(VoxelCell);
    b->jobs = voxel_level_bricks(&b->layer->level[b->pyramid.job_level]);
    b->scratch = calloc(workers, sizeof *b->scratch);
    b->outputs = calloc(b->jobs + 1, sizeof *b->outputs);
    b->pyramid.job_cells = calloc(b->jobs, sizeof *b->pyramid.job_cells);
    if (!b->scratch || !b->outputs || !b->pyramid.job_cells) return false;
    for (size_t i = 0; i <= b->jobs; i++)
        b->outputs[i].bricks.memory = b->outputs[i].codes.memory = b->options->memory;
    for (size_t i = 0; i < workers; i++)
        if (!(b->scratch[i] = aligned_alloc(CACHE_LINE, bytes))) return false;
    return true;
}

static void release(Build *b) {
    for (size_t i = 0; b->outputs && i <= b->jobs; i++) {
        grow_buffer_free(&b->outputs[i].bricks);
        grow_buffer_free(&b->outputs[i].codes);
    }
    for (size_t i = 0; b->pyramid.job_cells && i < b->jobs; i++) free(b->pyramid.job_cells[i]);
    for (int i = 0; b->scratch && i < pool_threads(b->options->pool); i++) free(b->scratch[i]);
    for (int i = 0; i < b->layer->levels; i++) free(b->pyramid.marks[i]);
    free(b->scratch);
    free(b->outputs);
    free(b->pyramid.job_cells);
    triangle_bins_free(&b->bins, b->options->memory);
    voxel_fill_free(&b->fill, b->options->memory);
}

static void tell_progress(Build *b) {
    size_t done = atomic_fetch_add(&b->done, 1) + 1;
    if (atomic_flag_test_and_set(&b->telling))
        return; /* another worker is telling; this step is told with the next */
    progress_update(b->options->progress, b->options->name ? b->options->name : "texel", done, b->jobs);
    atomic_flag_clear(&b->telling);
}

static void run_job(void *context, size_t job, int worker) {
    Build *b = context;
    Pyramid *p = &b->pyramid;
    const VoxelLevel *level = &b->layer->level[p->job_level];
    if (p->marks[p->job_level][job] & BRICK_BUILT) {
        size_t x = (size_t)level->brick_size[0], y = (size_t)level->brick_size[1];
        const int at[3] = {(int)(job % x), (int)(job / x % y), (int)(job / x / y)};
        VoxelCell *cells = p->job_cells[job] = calloc(BRICK_VOXELS, sizeof *cells);
        if (cells)
            pyramid_build_brick(p, p->job_level, at, false, cells, b->scratch[worker], &b->outputs[job]);
        else
            b->outputs[job].bricks.failed = true;
    }
    tell_progress(b);
}

/* The levels above the jobs', and the topmost brick itself, which has no parent. */
static void build_top(Build *b) {
    const int origin[3] = {0, 0, 0};
    int top = b->layer->levels - 1;
    if (!(b->pyramid.marks[top][0] & BRICK_BUILT)) return;
    VoxelCell *cells = b->scratch[0];
    memset(cells, 0, BRICK_VOXELS * sizeof *cells);
    pyramid_build_brick(&b->pyramid, top, origin, true, cells, cells + BRICK_VOXELS, &b->outputs[b->jobs]);
    pyramid_code_top(&b->pyramid, cells, &b->outputs[b->jobs]);
}

static bool allocate_level(VoxelLayer *layer, VoxelLevel *level) {
    size_t bricks = voxel_level_bricks(level);
    level->index = voxel_layer_allocate(layer, bricks, sizeof *level->index);
    level->bricks = voxel_layer_allocate(layer, level->brick_count, sizeof *level->bricks);
    level->codes = voxel_layer_allocate(layer, level->code_count + 2, sizeof *level->codes);
    level->brick_count = level->code_count = 0;
    if (!level->index || !level->bricks || !level->codes) return false;
    for (size_t i = 0; i < bricks; i++) level->index[i] = -1;
    return true;
}

static void place_brick(VoxelLevel *level, const BuiltBrick *built, const VoxelCode *codes) {
    VoxelBrick *brick = &level->bricks[level->brick_count];
    level->index[built->place] = (int32_t)level->brick_count++;
    memcpy(level->codes + level->code_count, codes + built->first, built->count * sizeof *codes);
    for (int z = 0; z < BRICK_SIDE; z++) {
        brick->slice[z] = built->slice[z];
        brick->first[z] = (uint32_t)level->code_count;
        level->code_count += count_bits(built->slice[z]);
    }
}

/* Puts the jobs' bricks into the layer, in the order of the jobs, whoever ran them. */
static bool assemble(Build *b) {
    VoxelLayer *layer = b->layer;
    for (size_t j = 0; j <= b->jobs; j++) {
        const BuiltBrick *built = b->outputs[j].bricks.data;
        if (b->outputs[j].bricks.failed || b->outputs[j].codes.failed) return false;
        for (size_t i = 0; i < b->outputs[j].bricks.count; i++) {
            layer->level[built[i].level].brick_count++;
            layer->level[built[i].level].code_count += built[i].count;
        }
    }
    for (int i = 0; i < layer->levels; i++)
        if (layer->level[i].code_count >= UINT32_MAX || !allocate_level(layer, &layer->level[i]))
            return false;
    for (size_t j = 0; j <= b->jobs; j++) {
        const BuiltBrick *built = b->outputs[j].bricks.data;
        for (size_t i = 0; i < b->outputs[j].bricks.count; i++)
            place_brick(&layer->level[built[i].level], &built[i], b->outputs[j].codes.data);
        grow_buffer_free(&b->outputs[j].codes);
    }
    for (int i = 0; i < layer->levels; i++)
        if (!voxel_level_mark_support(layer, &layer->level[i])) return false;
    return true;
}

static bool build(Build *b, const TexelMesh *mesh) {
    if (!triangle_bins_build(&b->bins, mesh, b->layer, b->options)) return false;
    if (!voxel_fill_build(&b->fill, mesh, b->layer, b->options->memory)) return false;
    b->pyramid = (Pyramid){.mesh = mesh,
                           .layer = b->layer,
                           .bins = &b->bins,
                           .fill = &b->fill,
                           .field = b->options->field,
                           .job_level = choose_job_level(b->layer)};
    if (!mark_bricks(b) || !take_scratch(b)) return false;
    if (!pool_run(b->options->pool, b->jobs, run_job, b)) return false;
    build_top(b);
    return assemble(b);
}

static void fill_stats(const VoxelLayer *layer, double seconds, TexelBuildStats *stats) {
    *stats = (TexelBuildStats){.levels = layer->levels, .bytes = layer->bytes, .seconds = seconds};
    voxel_layer_size(layer, 0, stats->size);
    for (int i = 0; i < layer->levels; i++) stats->voxels[i] = layer->level[i].code_count;
}

VoxelLayer *voxel_layer_build(const TexelMesh *mesh, const TexelBuildOptions *options,
                              TexelBuildStats *stats) {
    double start = stopwatch_wall();
    Build b = {.options = options, .layer = voxel_layer_create(options), .telling = ATOMIC_FLAG_INIT};
    if (!b.layer) return NULL;
    bool ok = build(&b, mesh);
    release(&b);
    if (!ok) {
        voxel_layer_destroy(b.layer);
        return NULL;
    }
    LayerViews *views = options->views ? options->views : malloc(sizeof *views); /* without room it is neither trimmed nor paired */
    if (views) voxel_layer_trim(b.layer, mesh, options->extent, views, options->pool);
    if (views && !options->views) voxel_layers_join(&b.layer, &views, 1, options->extent, options->pool);
    if (!options->views) free(views);
    if (stats) fill_stats(b.layer, stopwatch_wall() - start, stats);
    return b.layer;
}
