#include "texel/voxel_fill.h"

#include "texel/voxel_scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COPIES = 64 };
static const double FARTHEST = 0x1p26; /* voxels: beyond it a wall's place cannot be counted */

/* One pass over the solids' triangles: counts the walls of each column, or writes them down. */
typedef struct FillPass {
    VoxelFill *fill;
    bool cyclic[3];
    bool write;
} FillPass;

static int wrap_index(int at, int size) { return (at % size + size) % size; }

static void meet_column(const FillPass *pass, int x, int z, double depth, bool up) {
    VoxelFill *fill = pass->fill;
    int height = fill->size[1], wall = (int)ceil(double_clamp(depth - 0.5, -FARTHEST, FARTHEST)), copies = 0;
    if (pass->cyclic[1]) {
        copies = (wall - wrap_index(wall, height)) / height;
        wall = wrap_index(wall, height);
    }
    size_t column = (size_t)z * (size_t)fill->size[0] + (size_t)x;
    if (!pass->write) {
        fill->start[column + 1]++;
        return;
    }
    fill->walls[fill->start[column]++] = 2 * int_clamp(wall, 0, height) + up;
    fill->below[column] += up ? copies : -copies;
}

/* Lines of one row that the triangle crosses. */
static void meet_row(const FillPass *pass, const double t[3][3], const ScanOutline *outline,
                     const double slopes[2], int row, bool up) {
    double at = row + 0.5, lo, hi;
    int width = pass->fill->size[0], z = wrap_index(row, pass->fill->size[2]);
    scan_row(outline, at, &lo, &hi);
    int begin = (int)ceil(lo - 0.5), end = (int)ceil(hi - 0.5);
    if (!pass->cyclic[0]) begin = int_max(begin, 0), end = int_min(end, width);
    for (int column = begin; column < end; column++) {
        double depth = t[0][1] + slopes[0] * (column + 0.5 - t[0][0]) + slopes[1] * (at - t[0][2]);
        meet_column(pass, wrap_index(column, width), z, depth, up);
    }
}

static double smallest(const double t[3][3], int axis) {
    return double_min(t[0][axis], double_min(t[1][axis], t[2][axis]));
}
static double largest(const double t[3][3], int axis) {
    return double_max(t[0][axis], double_max(t[1][axis], t[2][axis]));
}

static void meet_triangle(const FillPass *pass, const double t[3][3]) {
    double ab[3], ac[3], n[3];
    for (int k = 0; k < 3; k++) {
        if (!(fabs(smallest(t, k)) < FARTHEST && fabs(largest(t, k)) < FARTHEST)) return;
        if (pass->cyclic[k] && largest(t, k) - smallest(t, k) > MOST_COPIES * (double)pass->fill->size[k])
            return;
        ab[k] = t[1][k] - t[0][k];
        ac[k] = t[2][k] - t[0][k];
    }
    for (int k = 0; k < 3; k++) n[k] = ab[(k + 1) % 3] * ac[(k + 2) % 3] - ab[(k + 2) % 3] * ac[(k + 1) % 3];
    if (n[1] == 0) return;
    const double slopes[2] = {-n[0] / n[1], -n[2] / n[1]};
    ScanOutline outline = scan_outline(t[0], t[1], t[2], 0, 2);
    int begin = (int)ceil(outline.lowest - 0.5), end = (int)ceil(outline.highest - 0.5);
    if (!pass->cyclic[2]) begin = int_max(begin, 0), end = int_min(end, pass->fill->size[2]);
    for (int row = begin; row < end; row++) meet_row(pass, t, &outline, slopes, row, n[1] > 0);
}

static void run_pass(const FillPass *pass, const TexelMesh *mesh, const VoxelLevel *finest) {
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        if (!mesh->solid[i]) continue;
        double t[3][3];
        bool known = true;
        for (int v = 0; v < 3; v++) {
            size_t vertex = mesh->triangles[i][v];
            known = known && vertex < mesh->vertex_count;
            const Vec3f at = known ? mesh->vertices[vertex] : vec3f(0, 0, 0);
            t[v][0] = (double)at.x * (double)finest->per_side[0];
            t[v][1] = (double)at.y * (double)finest->per_side[1];
            t[v][2] = (double)at.z * (double)finest->per_side[2];
            known = known && isfinite(t[v][0]) && isfinite(t[v][1]) && isfinite(t[v][2]);
        }
        if (known) meet_triangle(pass, (const double(*)[3])t);
    }
}

static int compare_walls(const void *a, const void *b) {
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* A column whose walls do not come in pairs is taken for open. */
static void close_column(VoxelFill *fill, size_t column) {
    int32_t *walls = fill->walls + fill->start[column];
    size_t count = fill->start[column + 1] - fill->start[column];
    int sum = 0;
    for (size_t i = 0; i < count; i++) sum += walls[i] & 1 ? 1 : -1;
    if (sum) {
        memset(walls, 0, count * sizeof *walls);
        fill->below[column] = 0;
    } else if (count > 1) {
        qsort(walls, count, sizeof *walls, compare_walls);
    }
}

static bool has_solids(const TexelMesh *mesh) {
    for (size_t i = 0; mesh->solid && i < mesh->triangle_count; i++)
        if (mesh->solid[i]) return true;
    return false;
}

/* Takes the memory for `count` more numbers. */
static void *take(VoxelFill *fill, size_t count, MemoryBudget *memory) {
    if (!memory_budget_take(memory, count * sizeof(int32_t))) return NULL;
    void *block = calloc(count, sizeof(int32_t));
    if (block)
        fill->bytes += count * sizeof(int32_t);
    else
        memory_budget_give_back(memory, count * sizeof(int32_t));
    return block;
}

bool voxel_fill_build(VoxelFill *fill, const TexelMesh *mesh, const VoxelLayer *layer, MemoryBudget *memory) {
    const VoxelLevel *finest = &layer->level[0];
    size_t columns = (size_t)finest->size[0] * (size_t)finest->size[2], count = 0;
    *fill = (VoxelFill){.size = {finest->size[0], finest->size[1], finest->size[2]}};
    if (!has_solids(mesh)) return true;
    fill->start = take(fill, columns + 1, memory);
    fill->below = take(fill, columns, memory);
    FillPass pass = {.fill = fill};
    memcpy(pass.cyclic, layer->cyclic, sizeof pass.cyclic);
    if (fill->start && fill->below) run_pass(&pass, mesh, finest);
    for (size_t i = 0; fill->start && i < columns; i++) {
        count += fill->start[i + 1];
        if (count < UINT32_MAX) fill->start[i + 1] = (uint32_t)count;
    }
    if (count < UINT32_MAX && fill->start && fill->below) fill->walls = take(fill, count + 1, memory);
    if (!fill->walls) {
        voxel_fill_free(fill, memory);
        return false;
    }
    pass.write = true;
    run_pass(&pass, mesh, finest);
    /* Each start has moved to the next one's place. */
    memmove(fill->start + 1, fill->start, columns * sizeof *fill->start);
    fill->start[0] = 0;
    for (size_t i = 0; i < columns; i++) close_column(fill, i);
    return true;
}

void voxel_fill_free(VoxelFill *fill, MemoryBudget *memory) {
    memory_budget_give_back(memory, fill->bytes);
    free(fill->start);
    free(fill->walls);
    free(fill->below);
    *fill = (VoxelFill){0};
}

uint32_t voxel_fill_column(const VoxelFill *fill, int x, int y, int z) {
    if (!fill->start) return 0;
    size_t column = (size_t)z * (size_t)fill->size[0] + (size_t)x;
    const int32_t *walls = fill->walls + fill->start[column], *end = fill->walls + fill->start[column + 1];
    uint32_t bits = 0;
    int inside = fill->below[column]; /* walls above a voxel that face up, less those that face down */
    if (walls == end && !inside) return 0;
    for (const int32_t *w = walls; w < end; w++) inside += *w & 1 ? 1 : -1;
    for (int i = 0; i < BRICK_SIDE; i++) {
        for (; walls < end && *walls >> 1 <= y + i; walls++) inside -= *walls & 1 ? 1 : -1;
        bits |= (uint32_t)(inside != 0 && y + i < fill->size[1]) << i;
    }
    return bits;
}
