#include "texel/voxel_trim.h"

#include "base/random.h"
#include "texel/opacity.h"
#include "texel/voxel_layer.h"

#include <stdlib.h>

/* Places at which the triangles are looked for, at most, per side of the picture; triangles that cover more than so many of them, over and
 * over, are no texel's. */
enum {
    TRIM_GRID = 256,
    TRIM_MOST_PLACES = 1 << 24,
    TRIM_MOST_TRIANGLES = 200000,
    TRIM_DIRECTIONS = TRIM_NODES * TRIM_NODES
};
/* Of some triangles half as many places each way are enough, of many every other direction as well: it is much matter. */
enum { TRIM_SOME_TRIANGLES = 2000, TRIM_MANY_TRIANGLES = 10000 };
/* Rays through a level of so many voxels, per side and voxel, and at most; their steps, in voxels, are as the renderer's. */
enum { TRIM_RAYS_A_VOXEL = 3, TRIM_LEAST_RAYS = 16, TRIM_MOST_RAYS = 24 };
static const float TRIM_STEP = 0.8f;
/* Ways along the layer are looked along from a little above. */
static const float TRIM_LOWEST = 0.3f;
/* How much of the view has to depend on a factor for it to be told from 1. */
static const double TRIM_INERTIA = 0.005;

/* The layer seen along d (d.y > 0), on the plane y = 0: from `origin`, `size` wide; a period of what is cyclic. */
typedef struct TrimView {
    Vec3f d, extent;
    float slope_x, slope_z; /* d / d.y */
    float origin[2], size[2];
    bool cyclic[2];
    int grid; /* places each way */
} TrimView;

typedef struct TrimWork {
    VoxelLayer *layer;
    const TexelMesh *mesh;
    Vec3f extent;
    bool coarse; /* many triangles */
    bool known[TRIM_DIRECTIONS];
} TrimWork;

/* The upper hemisphere as an octahedron's upper half, unfolded to a square: node (i, j) of TRIM_NODES each way. */
static Vec3f trim_direction(int node) {
    float a = 2 * (float)(node % TRIM_NODES) / (TRIM_NODES - 1) - 1,
          b = 2 * (float)(node / TRIM_NODES) / (TRIM_NODES - 1) - 1;
    float x = (a + b) / 2, z = (a - b) / 2;
    Vec3f d = vec3f_normalize(vec3f(x, 1 - fabsf(x) - fabsf(z), z));
    return vec3f_normalize(vec3f(d.x, float_max(d.y, TRIM_LOWEST), d.z));
}

static TrimView look_along(const TrimWork *work, Vec3f d) {
    TrimView v = {.d = d,
                  .extent = work->extent,
                  .slope_x = d.x / d.y,
                  .slope_z = d.z / d.y,
                  .grid = work->mesh->triangle_count > TRIM_SOME_TRIANGLES ? TRIM_GRID / 2 : TRIM_GRID};
    const float slope[2] = {v.slope_x, v.slope_z}, extent[2] = {work->extent.x, work->extent.z};
    for (int k = 0; k < 2; k++) {
        v.cyclic[k] = work->layer->cyclic[2 * k];
        float reach = -slope[k] * work->extent.y;
        v.origin[k] = v.cyclic[k] ? 0 : float_min(0, reach);
        v.size[k] = v.cyclic[k] ? extent[k] : extent[k] + fabsf(reach);
    }
    return v;
}

/* ---- triangles ---- */

static bool within(const TrimView *v, float at, float y, int k) {
    float x = at + y * (k ? v->slope_z : v->slope_x);
    return v->cyclic[k] || (x >= 0 && x <= (k ? v->extent.z : v->extent.x));
}

/* The grid is a power of two. */
static int wrapped_place(int i, int grid, bool cyclic) {
    return cyclic ? i & (grid - 1) : i >= 0 && i < grid ? i : -1;
}

/* Marks the places of row `row` between the two edges that pass it. Corners are (column, row, height). */
static int mark_row(const TrimView *v, const Vec3f p[3], int row, uint8_t *seen) {
    float at = (float)row + 0.5f, x[2] = {INFINITY, -INFINITY}, y[2] = {0, 0};
    for (int i = 0; i < 3; i++) {
        const Vec3f *a = &p[i], *b = &p[(i + 1) % 3];
        if ((a->y <= at) == (b->y <= at)) continue;
        float t = (at - a->y) / (b->y - a->y), cross = a->x + t * (b->x - a->x),
              high = a->z + t * (b->z - a->z);
        if (cross < x[0]) x[0] = cross, y[0] = high;
        if (cross > x[1]) x[1] = cross, y[1] = high;
    }
    int line = wrapped_place(row, v->grid, v->cyclic[1]);
    if (!(x[0] <= x[1]) || line < 0) return 1;
    int first = (int)ceilf(x[0] - 0.5f), end = (int)ceilf(x[1] - 0.5f);
    float cell_x = v->size[0] / (float)v->grid, cell_z = v->size[1] / (float)v->grid;
    for (int i = first; i < end; i++) {
        float t = x[1] > x[0] ? ((float)i + 0.5f - x[0]) / (x[1] - x[0]) : 0, high = y[0] + t * (y[1] - y[0]);
        int column = wrapped_place(i, v->grid, v->cyclic[0]);
        if (column < 0 || high < 0 || high > v->extent.y) continue;
        if (!within(v, v->origin[0] + ((float)i + 0.5f) * cell_x, high, 0) ||
            !within(v, v->origin[1] + at * cell_z, high, 1))
            continue;
        seen[line * v->grid + column] = 1;
    }
    return 1 + end - first;
}

/* Whole turns along a cyclic axis that the triangle lies away from the extent. */
static float turns_away(const TrimView *v, const TexelMesh *mesh, size_t t, int k) {
    float least = INFINITY, size = k ? v->extent.z : v->extent.x;
    for (int i = 0; i < 3; i++) {
        Vec3f q = mesh->vertices[mesh->triangles[t][i]];
        least = float_min(least, k ? q.z : q.x);
    }
    return v->cyclic[k] ? floorf(least / size) * size : 0;
}

/* Returns how many places were looked at; TRIM_MOST_PLACES where there are too many. */
static int64_t mark_triangle(const TrimView *v, const TexelMesh *mesh, size_t t, uint8_t *seen) {
    Vec3f p[3];
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    float away_x = turns_away(v, mesh, t, 0), away_z = turns_away(v, mesh, t, 1);
    for (int i = 0; i < 3; i++) {
        Vec3f q = mesh->vertices[mesh->triangles[t][i]];
        q.x -= away_x, q.z -= away_z;
        p[i] = vec3f((q.x - q.y * v->slope_x - v->origin[0]) / v->size[0] * (float)v->grid,
                     (q.z - q.y * v->slope_z - v->origin[1]) / v->size[1] * (float)v->grid, q.y);
        low[0] = float_min(low[0], p[i].x), high[0] = float_max(high[0], p[i].x);
        low[1] = float_min(low[1], p[i].y), high[1] = float_max(high[1], p[i].y);
    }
    const float far = 64 * (float)v->grid;
    if (!(low[0] > -far && high[0] < far && low[1] > -far && high[1] < far)) return TRIM_MOST_PLACES;
    int64_t places = 1;
    for (int row = (int)floorf(low[1]); row <= (int)high[1]; row++) places += mark_row(v, p, row, seen);
    return places;
}

/* The share of the view that the triangles hide; < 0 where that is not known. */
static double hidden_by_triangles(const TrimView *v, const TexelMesh *mesh) {
    uint8_t *seen = calloc(TRIM_GRID * TRIM_GRID, 1);
    int64_t places = 0;
    size_t hidden = 0;
    for (size_t t = 0; seen && t < mesh->triangle_count && places < TRIM_MOST_PLACES; t++)
        places += mark_triangle(v, mesh, t, seen);
    for (size_t i = 0; seen && i < (size_t)(v->grid * v->grid); i++) hidden += seen[i];
    bool known = seen && places < TRIM_MOST_PLACES;
    free(seen);
    return known ? (double)hidden / (v->grid * v->grid) : -1;
}

/* ---- voxels ---- */

static float wrapped_length(float x, float size) { return x - size * floorf(x / size); }

static float ray_depth(const VoxelLayer *layer, int level, const TrimView *v, float x, float z) {
    float h = 1 / layer->level[level].density_unit, step = TRIM_STEP * h * v->d.y;
    int steps = int_max(1, (int)ceilf(v->extent.y / step));
    float height = v->extent.y / (float)steps, depth = 0;
    Vec3f along = vec3f_scale(v->d, height / v->d.y);
    for (int i = 0; i < steps; i++) {
        float y = ((float)i + 0.5f) * height;
        Vec3f p = {x + y * v->slope_x, y, z + y * v->slope_z};
        VoxelSample s;
        if (v->cyclic[0]) p.x = wrapped_length(p.x, v->extent.x);
        if (v->cyclic[1]) p.z = wrapped_length(p.z, v->extent.z);
        if (voxel_layer_sample(layer, level, p, &s)) depth += opacity_depth(OPACITY_CORRELATED, &s, h, along);
    }
    return depth;
}

/* The share of the view that is hidden with all depths times `factor`; *rate: its derivative by the factor. */
static double hidden_by_depths(const float *depths, int count, double factor, double *rate) {
    double sum = 0;
    *rate = 0;
    for (int i = 0; i < count; i++) {
        double through = exp(-factor * (double)depths[i]);
        sum += 1 - through;
        *rate += (double)depths[i] * through;
    }
    *rate /= count;
    return sum / count;
}

static float find_factor(const float *depths, int count, double hidden) {
    double low = (double)TRIM_LEAST, high = (double)TRIM_MOST, rate;
    for (int i = 0; i < 20; i++) {
        double middle = (low + high) / 2;
        if (hidden_by_depths(depths, count, middle, &rate) < hidden)
            low = middle;
        else
            high = middle;
    }
    double factor = (low + high) / 2;
    hidden_by_depths(depths, count, factor, &rate);
    return (float)(1 + (factor - 1) * rate /
                           (rate + TRIM_INERTIA)); /* of what is opaque in any case nothing is known */
}

static float trim_level(const VoxelLayer *layer, int level, const TrimView *v, double hidden) {
    float depths[TRIM_MOST_RAYS * TRIM_MOST_RAYS];
    int side =
        int_clamp(TRIM_RAYS_A_VOXEL * (int)layer->level[level].density_unit, TRIM_LEAST_RAYS, TRIM_MOST_RAYS);
    for (int i = 0; i < side * side; i++) {
        uint64_t bits = random_hash((uint64_t)i, (uint64_t)level, 0, 0);
        float a = ((float)(i % side) + random_unitf(bits)) / (float)side,
              b = ((float)(i / side) + random_unitf(random_mix(bits))) / (float)side;
        depths[i] = ray_depth(layer, level, v, v->origin[0] + a * v->size[0], v->origin[1] + b * v->size[1]);
    }
    return find_factor(depths, side * side, hidden);
}

static void look_through(void *context, size_t node, int worker) {
    (void)worker;
    TrimWork *work = context;
    VoxelLayer *layer = work->layer;
    work->known[node] = true;
    if (work->coarse && (node % TRIM_NODES % 2 || node / TRIM_NODES % 2)) return; /* between others */
    TrimView view = look_along(work, trim_direction((int)node));
    double hidden = hidden_by_triangles(&view, work->mesh);
    work->known[node] = hidden >= 0;
    if (!work->known[node]) return;
    for (int i = 0; i < TRIM_LEVELS && i < layer->levels; i++)
        layer->trim[i][node] = trim_level(layer, layer->levels - 1 - i, &view, hidden);
}

void voxel_layer_forget_trim(VoxelLayer *layer) {
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int node = 0; node < TRIM_DIRECTIONS; node++) layer->trim[i][node] = 1;
}

/* Directions between those that were looked along. */
static void fill_between(VoxelLayer *layer) {
    for (int i = 0; i < TRIM_LEVELS; i++) {
        float *f = layer->trim[i];
        for (int row = 0; row < TRIM_NODES; row += 2)
            for (int column = 1; column < TRIM_NODES; column += 2) {
                float *at = &f[row * TRIM_NODES + column];
                *at = (at[-1] + at[1]) / 2;
            }
        for (int row = 1; row < TRIM_NODES; row += 2)
            for (int column = 0; column < TRIM_NODES; column++) {
                float *at = &f[row * TRIM_NODES + column];
                *at = (at[-TRIM_NODES] + at[TRIM_NODES]) / 2;
            }
    }
}

bool voxel_layer_is_trimmed(const VoxelLayer *layer) {
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int node = 0; node < TRIM_DIRECTIONS; node++)
            if (layer->trim[i][node] != 1) return true;
    return false;
}

/* The nodes on the rim are horizontal: opposite ones are one direction. */
static void join_horizon(VoxelLayer *layer) {
    for (int node = 0; node < TRIM_DIRECTIONS / 2; node++) {
        int column = node % TRIM_NODES, row = node / TRIM_NODES, other = TRIM_DIRECTIONS - 1 - node;
        if (column > 0 && column < TRIM_NODES - 1 && row > 0) continue;
        for (int i = 0; i < TRIM_LEVELS; i++)
            layer->trim[i][node] = layer->trim[i][other] = (layer->trim[i][node] + layer->trim[i][other]) / 2;
    }
}

void voxel_layer_trim(VoxelLayer *layer, const TexelMesh *mesh, Vec3f extent, Pool *pool) {
    voxel_layer_forget_trim(layer);
    if (layer->cyclic[1] || layer->scattered || !mesh->triangle_count ||
        mesh->triangle_count > TRIM_MOST_TRIANGLES || voxel_layer_is_empty(layer))
        return;
    TrimWork work = {
        .layer = layer, .mesh = mesh, .extent = extent, .coarse = mesh->triangle_count > TRIM_MANY_TRIANGLES};
    bool known = pool_run(pool, TRIM_DIRECTIONS, look_through, &work);
    for (int node = 0; node < TRIM_DIRECTIONS; node++) known &= work.known[node];
    if (known && work.coarse) fill_between(layer);
    if (known)
        join_horizon(layer);
    else
        voxel_layer_forget_trim(layer);
}

/* ---- reading ---- */

static float trim_of_level(const VoxelLayer *layer, int level, int node, float a, float b) {
    int i = layer->levels - 1 - level;
    if (i >= TRIM_LEVELS) return 1;
    const float *row = layer->trim[i] + node, *next = row + TRIM_NODES;
    float upper = row[0] + a * (row[1] - row[0]), lower = next[0] + a * (next[1] - next[0]);
    return upper + b * (lower - upper);
}

float voxel_layer_trim_at(const VoxelLayer *layer, float lod, Vec3f step) {
    float top = (float)(layer->levels - 1);
    lod = lod > 0 ? float_min(lod, top) : 0;
    int level = (int)lod;
    if (layer->levels - 2 - level >= TRIM_LEVELS) return 1;
    float sum = fabsf(step.x) + fabsf(step.y) + fabsf(step.z), per = (step.y < 0 ? -1 : 1) / sum;
    if (!(sum > 0)) return 1;
    float x = step.x * per, z = step.z * per, a = (x + z + 1) * 0.5f * (TRIM_NODES - 1),
          b = (x - z + 1) * 0.5f * (TRIM_NODES - 1);
    int column = int_clamp((int)a, 0, TRIM_NODES - 2), row = int_clamp((int)b, 0, TRIM_NODES - 2),
        node = row * TRIM_NODES + column;
    float t = lod - (float)level,
          factor = trim_of_level(layer, level, node, a - (float)column, b - (float)row);
    return t > 0 ? factor +
                       t * (trim_of_level(layer, level + 1, node, a - (float)column, b - (float)row) - factor)
                 : factor;
}
