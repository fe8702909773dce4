#include "texel/voxel_bin.h"

#include "texel/grow_buffer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_COPIES = 64, CHUNK = 2048 };

typedef struct Reference {
    uint32_t brick;
    BinnedTriangle item;
} Reference;

bool bin_load_triangle(const TexelMesh *mesh, const VoxelLayer *layer, size_t triangle, ClipPolygon *out) {
    const VoxelLevel *finest = &layer->level[0];
    out->count = 3;
    for (int i = 0; i < 3; i++) {
        size_t vertex = mesh->triangles[triangle][i];
        if (vertex >= mesh->vertex_count) return false;
        const Vec3f *v = &mesh->vertices[vertex];
        const float at[3] = {v->x, v->y, v->z};
        for (int k = 0; k < 3; k++) {
            if (!isfinite(at[k])) return false;
            out->at[i][k] = (double)at[k] * (double)finest->per_side[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        if (!layer->cyclic[k]) continue;
        double lo = fmin(out->at[0][k], fmin(out->at[1][k], out->at[2][k])), size = finest->size[k];
        double down = floor(lo / size) * size;
        for (int i = 0; i < 3; i++) {
            out->at[i][k] -= down;
            if (out->at[i][k] > MAX_COPIES * size) return false;
        }
    }
    return clip_projected_area(out, 0) != 0 || clip_projected_area(out, 1) != 0 ||
           clip_projected_area(out, 2) != 0;
}

typedef struct Binning {
    const TexelMesh *mesh;
    const VoxelLayer *layer;
    GrowBuffer *chunks; /* of References, one for each CHUNK of triangles */
} Binning;

typedef struct Sink {
    GrowBuffer *buffer;
    const VoxelLevel *level;
    BinnedTriangle item;
} Sink;

static void add_reference(void *context, const int brick[3], const ClipPolygon *piece) {
    (void)piece;
    Sink *sink = context;
    Reference *r = grow_buffer_add(sink->buffer, 1, sizeof *r);
    if (r)
        *r = (Reference){(uint32_t)voxel_level_brick_at(sink->level, brick[0], brick[1], brick[2]),
                         sink->item};
}

/* The copy of the triangle that is moved down by `shift` extents, in bricks. */
static void bin_copy(const ClipPolygon *triangle, const int shift[3], Sink *sink) {
    ClipPolygon moved = {.count = 3};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            moved.at[i][k] = (triangle->at[i][k] - (double)shift[k] * sink->level->size[k]) / BRICK_SIDE;
    for (int k = 0; k < 3; k++) sink->item.shift[k] = (uint8_t)shift[k];
    clip_to_cells(&moved, sink->level->brick_size, add_reference, sink);
}

static void bin_triangle(const ClipPolygon *triangle, const bool cyclic[3], Sink *sink) {
    int copies[3] = {1, 1, 1}, shift[3];
    for (int k = 0; k < 3; k++) {
        if (!cyclic[k]) continue;
        double hi = fmax(triangle->at[0][k], fmax(triangle->at[1][k], triangle->at[2][k]));
        copies[k] = int_max(1, (int)ceil(hi / sink->level->size[k]));
    }
    for (shift[2] = 0; shift[2] < copies[2]; shift[2]++)
        for (shift[1] = 0; shift[1] < copies[1]; shift[1]++)
            for (shift[0] = 0; shift[0] < copies[0]; shift[0]++) bin_copy(triangle, shift, sink);
}

static void bin_chunk(void *context, size_t chunk, int worker) {
    (void)worker;
    Binning *b = context;
    Sink sink = {.buffer = &b->chunks[chunk], .level = &b->layer->level[0]};
    size_t end = size_min(b->mesh->triangle_count, (chunk + 1) * CHUNK);
    for (size_t t = chunk * CHUNK; t < end; t++) {
        ClipPolygon triangle;
        if (!bin_load_triangle(b->mesh, b->layer, t, &triangle)) continue;
        sink.item.triangle = (uint32_t)t;
        bin_triangle(&triangle, b->layer->cyclic, &sink);
    }
}

/* Counting sort by brick, which keeps the mesh's order within a brick. */
static bool sort_references(TriangleBins *bins, const GrowBuffer *chunks, size_t chunk_count,
                            MemoryBudget *memory) {
    size_t start_bytes = (bins->bricks + 1) * sizeof *bins->start,
           item_bytes = (bins->count + 1) * sizeof *bins->items;
    if (bins->count >= UINT32_MAX || !memory_budget_take(memory, start_bytes + item_bytes)) return false;
    bins->start = calloc(1, start_bytes);
    bins->items = calloc(1, item_bytes);
    if (!bins->start || !bins->items) {
        memory_budget_give_back(memory, start_bytes + item_bytes);
        free(bins->start);
        free(bins->items);
        *bins = (TriangleBins){0};
        return false;
    }
    for (size_t c = 0; c < chunk_count; c++) {
        const Reference *r = chunks[c].data;
        for (size_t i = 0; i < chunks[c].count; i++) bins->start[r[i].brick + 1]++;
    }
    for (size_t b = 0; b < bins->bricks; b++) bins->start[b + 1] += bins->start[b];
    for (size_t c = 0; c < chunk_count; c++) {
        const Reference *r = chunks[c].data;
        for (size_t i = 0; i < chunks[c].count; i++) bins->items[bins->start[r[i].brick]++] = r[i].item;
    }
    /* Each start has moved to the next one's place. */
    memmove(bins->start + 1, bins->start, bins->bricks * sizeof *bins->start);
    bins->start[0] = 0;
    return true;
}

bool triangle_bins_build(TriangleBins *bins, const TexelMesh *mesh, const VoxelLayer *layer,
                         const TexelBuildOptions *options) {
    *bins = (TriangleBins){.bricks = voxel_level_bricks(&layer->level[0])};
    size_t chunk_count = mesh->triangle_count / CHUNK + 1;
    Binning binning = {mesh, layer, calloc(chunk_count, sizeof(GrowBuffer))};
    if (!binning.chunks || mesh->triangle_count >= UINT32_MAX) {
        free(binning.chunks);
        return false;
    }
    for (size_t i = 0; i < chunk_count; i++) binning.chunks[i].memory = options->memory;
    bool ok = pool_run(options->pool, chunk_count, bin_chunk, &binning);
    for (size_t i = 0; i < chunk_count; i++) {
        ok = ok && !binning.chunks[i].failed;
        bins->count += binning.chunks[i].count;
    }
    ok = ok && sort_references(bins, binning.chunks, chunk_count, options->memory);
    for (size_t i = 0; i < chunk_count; i++) grow_buffer_free(&binning.chunks[i]);
    free(binning.chunks);
    return ok;
}

void triangle_bins_free(TriangleBins *bins, MemoryBudget *memory) {
    if (bins->start)
        memory_budget_give_back(memory, (bins->bricks + 1) * sizeof *bins->start +
                                            (bins->count + 1) * sizeof *bins->items);
    free(bins->start);
    free(bins->items);
    *bins = (TriangleBins){0};
}
