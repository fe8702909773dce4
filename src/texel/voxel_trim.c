#include "texel/voxel_trim.h"

#include "base/random.h"
#include "texel/layer_views.h"
#include "texel/opacity.h"
#include "texel/voxel_lit.h"

#include <stdlib.h>

enum { TRIM_MOST_TRIANGLES = 12000000 };
/* Of many triangles every other direction is enough: it is much matter. */
enum { TRIM_MANY_TRIANGLES = 10000 };
/* And for finer voxels than those of so many levels, whose factors change less. */
enum { OFTEN_TRIMMED = 4 };
/* Rays through a level of so many voxels, per side and voxel, and at most, of a period half as many; their steps, in voxels, are as the
 * renderer's. */
enum { TRIM_RAYS_A_VOXEL = 3, TRIM_LEAST_RAYS = 16, TRIM_MOST_RAYS = 32 };
static const float TRIM_STEP = 0.8f;
enum { LEAST_TRIM_LEVELS = 4 };
static const float LEVELS_OF_TRIANGLES = 1.3f;
/* Ways along the layer are looked along from a little above. */
static const float TRIM_LOWEST = 0.3f;
/* How much of the view has to depend on a factor for it to be told from 1. */
static const double TRIM_INERTIA = 0.005;

typedef struct TrimWork {
    VoxelLayer *layer;
    const TexelMesh *mesh;
    Vec3f extent;
    bool contained;    /* nothing of it lies beyond the extent, but along cyclic axes */
    bool coarse;       /* many triangles */
    bool known[TRIM_DIRECTIONS];
    LayerViews *views;
} TrimWork;

/* Layers whose triangles stand among each other. */
typedef struct JoinWork {
    VoxelLayer *const *layers;
    LayerViews *const *views; /* those of the first become those of all */
    size_t count;
    Vec3f extent;
    float (*factor)[TRIM_DIRECTIONS]; /* by level */
} JoinWork;

/* The upper hemisphere as an octahedron's upper half, unfolded to a square: node (i, j) of TRIM_NODES each way. */
static Vec3f trim_direction(int node) {
    float a = 2 * (float)(node % TRIM_NODES) / (TRIM_NODES - 1) - 1,
          b = 2 * (float)(node / TRIM_NODES) / (TRIM_NODES - 1) - 1;
    float x = (a + b) / 2, z = (a - b) / 2;
    Vec3f d = vec3f_normalize(vec3f(x, 1 - fabsf(x) - fabsf(z), z));
    return vec3f_normalize(vec3f(d.x, float_max(d.y, TRIM_LOWEST), d.z));
}

static bool is_period(const VoxelLayer *layer) { return layer->cyclic[0] && layer->cyclic[2]; }

/* Of an even node, its number among those. */
static int even_number(int node) { return node / TRIM_NODES / 2 * TRIM_EVEN_SIDE + node % TRIM_NODES / 2; }

static bool is_even(int node) { return node % TRIM_NODES % 2 == 0 && node / TRIM_NODES % 2 == 0; }

/* What a view of a layer hangs on. */
typedef struct Seen {
    const VoxelLayer *layer;
    Vec3f extent, low; /* low: the least coordinates of the triangles */
    bool contained;
} Seen;

static Seen seen_of(const TrimWork *work) { return (Seen){work->layer, work->extent, work->views->low, work->contained}; }

static LayerView look_along(const Seen *work, Vec3f d, uint64_t number, bool cyclic) {
    uint64_t bits = random_hash(number, 0, 0, 0);
    LayerView v = {.d = d,
                   .extent = work->extent,
                   .slope_x = d.x / d.y,
                   .slope_z = d.z / d.y,
                   .contained = work->contained,
                   .shift = {random_unitf(bits), random_unitf(random_mix(bits))}};
    const float slope[2] = {v.slope_x, v.slope_z}, extent[2] = {work->extent.x, work->extent.z}, low[2] = {work->low.x, work->low.z};
    for (int k = 0; k < 2; k++) {
        v.cyclic[k] = cyclic || work->layer->cyclic[2 * k];
        float reach = -slope[k] * work->extent.y;
        v.origin[k] = v.cyclic[k] ? 0 : float_min(0, reach);
        v.size[k] = v.cyclic[k] ? extent[k] : extent[k] + fabsf(reach);
        v.turned[k] = v.cyclic[k] ? floorf(low[k] / extent[k]) * extent[k] : 0;
    }
    return v;
}

/* Of a node; of a period place by place as of all others. */
static LayerView look_along_node(const Seen *work, int node) {
    return look_along(work, trim_direction(node), is_period(work->layer) ? 0 : (uint64_t)node, false);
}

static Vec3f kept_direction(int kept) {
    int spot = kept - PAIR_NODES;
    return spot < 0 ? pair_direction(kept) : pair_direction_beside(pair_direction(pair_spot_node(spot)), spot & 1);
}

/* ---- voxels ---- */

static float wrapped_length(float x, float size) { return x - size * floorf(x / size); }

/* The range of the factor t for which from + t·slope is between two bounds, within what is given. */
static void clip_range(float from, float slope, float least, float most, float range[2]) {
    float a = (least - from) / slope, b = (most - from) / slope;
    if (!(fabsf(slope) > 1e-6f)) {
        if (from < least || from > most) range[1] = range[0] - 1;
        return;
    }
    range[0] = float_max(range[0], float_min(a, b));
    range[1] = float_min(range[1], float_max(a, b));
}

/* The heights between which a ray may meet voxels: as far as interpolation reaches around the triangles. */
static void find_heights(const VoxelLayer *layer, const LayerViews *views, int level, const LayerView *v, float x, float z, float range[2]) {
    static const float REACH = 1.5f;
    const float *sides = layer->level[level].sides;
    range[0] = float_max(0, views->low.y - REACH * sides[1]);
    range[1] = float_min(v->extent.y, views->high.y + REACH * sides[1]);
    if (!v->cyclic[0]) clip_range(x, v->slope_x, views->low.x - REACH * sides[0], views->high.x + REACH * sides[0], range);
    if (!v->cyclic[1]) clip_range(z, v->slope_z, views->low.z - REACH * sides[2], views->high.z + REACH * sides[2], range);
}

static float ray_depth(const VoxelLayer *layer, const LayerViews *views, int level, const LayerView *v, float x, float z) {
    float h = 1 / layer->level[level].density_unit, step = TRIM_STEP * h * v->d.y, range[2];
    int steps = int_max(1, (int)ceilf(v->extent.y / step));
    float height = v->extent.y / (float)steps, depth = 0;
    Vec3f along = vec3f_scale(v->d, height / v->d.y);
    find_heights(layer, views, level, v, x, z, range);
    int first = int_max(0, (int)(range[0] / height - 0.5f)), end = range[1] < range[0] ? first : int_min(steps, (int)(range[1] / height + 1.5f));
    for (int i = first; i < end; i++) {
        float y = ((float)i + 0.5f) * height;
        Vec3f p = {x + y * v->slope_x, y, z + y * v->slope_z};
        VoxelSample s;
        if (v->cyclic[0]) p.x = wrapped_length(p.x, v->extent.x);
        if (v->cyclic[1]) p.z = wrapped_length(p.z, v->extent.z);
        if (voxel_layer_sample(layer, level, p, &s)) depth += opacity_depth(OPACITY_CORRELATED, &s, h, along);
    }
    return depth;
}

/* Of a view of `rays`: the depths along those that meet any matter. */
typedef struct TrimDepths {
    float depth[TRIM_MOST_RAYS * TRIM_MOST_RAYS];
    int count, rays;
} TrimDepths;

/* The share of the view that is hidden with all depths times `factor`; *rate: its derivative by the factor. */
static double hidden_by_depths(const TrimDepths *d, double factor, double *rate) {
    double sum = 0;
    *rate = 0;
    for (int i = 0; i < d->count; i++) {
        double through = exp(-factor * (double)d->depth[i]);
        sum += 1 - through;
        *rate += (double)d->depth[i] * through;
    }
    *rate /= d->rays;
    return sum / d->rays;
}

/* The share grows with the factor, ever more slowly: Newton's steps, and halves of what is left where they lead out of it. */
static float find_factor(const TrimDepths *d, double hidden) {
    static const double CLOSE = 1e-5;
    double low = (double)TRIM_LEAST, high = (double)TRIM_MOST, factor = 1, rate = 0;
    for (int i = 0; i < 20 && high - low > CLOSE; i++) {
        double off = hidden_by_depths(d, factor, &rate) - hidden, next;
        if (off < 0) low = factor;
        else high = factor;
        next = factor - off / rate;
        if (!(next > low && next < high)) next = (low + high) / 2;
        bool there = fabs(next - factor) < CLOSE;
        factor = next;
        if (there) break;
    }
    return (float)(1 + (factor - 1) * rate / (rate + TRIM_INERTIA)); /* of what is opaque in any case nothing is known */
}

/* The factor on the depths of all layers by which they hide the share `hidden` of the view. */
static float trim_level(const JoinWork *work, int level, int node, const LayerView *v, double hidden) {
    const VoxelLayer *first = work->layers[0];
    int side = int_clamp(TRIM_RAYS_A_VOXEL * (int)first->level[level].density_unit, TRIM_LEAST_RAYS, TRIM_MOST_RAYS);
    if (is_period(first)) side /= 2;
    TrimDepths depths = {.rays = side * side};
    for (int i = 0; i < side * side; i++) {
        uint64_t bits = random_hash((uint64_t)i, (uint64_t)level, 0, 0);
        float a = ((float)(i % side) + random_unitf(bits)) / (float)side,
              b = ((float)(i / side) + random_unitf(random_mix(bits))) / (float)side, depth = 0;
        for (size_t k = 0; k < work->count; k++)
            depth += ray_depth(work->layers[k], work->views[k], level, v, v->origin[0] + a * v->size[0], v->origin[1] + b * v->size[1]) *
                     work->layers[k]->trim[first->levels - 1 - level][node];
        if (depth > 0) depths.depth[depths.count++] = depth;
    }
    return find_factor(&depths, hidden);
}

static void look_and_keep(const TrimWork *work, const LayerView *view, int kept) {
    LayerViews *views = work->views;
    bool known = layer_view_hidden(view, work->mesh, views->tops[kept], views->normals[kept]) >= 0;
    views->views[kept] = (PairView){view->slope_x, view->slope_z, views->normals[kept], known ? views->tops[kept] : NULL};
}

static void keep_hidden(uint64_t hidden[VIEW_PLACES / 64], const float *top) {
    for (int i = 0; i < VIEW_PLACES / 64; i++) hidden[i] = 0;
    for (int i = 0; i < VIEW_PLACES; i++) hidden[i / 64] |= (uint64_t)(top[i] >= 0) << i % 64;
}

static void look_at_node(TrimWork *work, int node) {
    VoxelLayer *layer = work->layer;
    const Seen of = seen_of(work);
    const JoinWork alone = {.layers = &work->layer, .views = &work->views, .count = 1, .extent = work->extent};
    work->known[node] = true;
    if (work->coarse && !is_even(node)) return; /* between others */
    LayerView view = look_along_node(&of, node);
    float *top = malloc(VIEW_PLACES * sizeof *top);
    double hidden = top ? layer_view_hidden(&view, work->mesh, top, NULL) : -1;
    work->known[node] = hidden >= 0;
    if (top && is_even(node)) keep_hidden(work->views->hidden[even_number(node)], top);
    free(top);
    int levels = is_even(node) ? work->views->levels : int_min(work->views->levels, OFTEN_TRIMMED);
    for (int i = 0; work->known[node] && i < levels; i++)
        layer->trim[i][node] = trim_level(&alone, layer->levels - 1 - i, node, &view, hidden);
}

static void look_through(void *context, size_t number, int worker) {
    TrimWork *work = context;
    const Seen of = seen_of(work);
    (void)worker;
    if (number < TRIM_DIRECTIONS) {
        look_at_node(work, (int)number);
        return;
    }
    int kept = (int)number - TRIM_DIRECTIONS;
    LayerView view = look_along(&of, kept_direction(kept), 0, true); /* copies side by side */
    look_and_keep(work, &view, kept);
}

void voxel_layer_forget_trim(VoxelLayer *layer) {
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int node = 0; node < TRIM_DIRECTIONS; node++) layer->trim[i][node] = 1;
}

/* The odd nodes of a row, whose nodes are `stride` apart, by the cubic through the nearest four even ones. */
static void fill_row(float *f, int stride) {
    const int last = TRIM_NODES - 1;
    for (int i = 1; i < last; i += 2) {
        int first = int_clamp(i - 3, 0, last - 6);
        float t = 0.5f * (float)(i - first), sum = 0; /* even nodes are at 0, 1, 2, 3 */
        for (int k = 0; k < 4; k++) {
            float weight = 1;
            for (int j = 0; j < 4; j++)
                if (j != k) weight *= (t - (float)j) / (float)(k - j);
            sum += weight * f[(first + 2 * k) * stride];
        }
        f[i * stride] = float_clamp(sum, TRIM_LEAST, TRIM_MOST);
    }
}

/* Directions between those that were looked along. */
static void fill_between(float (*trim)[TRIM_DIRECTIONS], int first) {
    for (int i = first; i < TRIM_LEVELS; i++) {
        for (int row = 0; row < TRIM_NODES; row += 2) fill_row(trim[i] + row * TRIM_NODES, 1);
        for (int column = 0; column < TRIM_NODES; column++) fill_row(trim[i] + column, TRIM_NODES);
    }
}

bool voxel_layer_is_trimmed(const VoxelLayer *layer) {
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int node = 0; node < TRIM_DIRECTIONS; node++)
            if (layer->trim[i][node] != 1) return true;
    return false;
}

/* The nodes on the rim are horizontal: opposite ones are one direction. */
static void join_horizon(float (*trim)[TRIM_DIRECTIONS]) {
    for (int node = 0; node < TRIM_DIRECTIONS / 2; node++) {
        int column = node % TRIM_NODES, row = node / TRIM_NODES, other = TRIM_DIRECTIONS - 1 - node;
        if (column > 0 && column < TRIM_NODES - 1 && row > 0) continue;
        for (int i = 0; i < TRIM_LEVELS; i++)
            trim[i][node] = trim[i][other] = (trim[i][node] + trim[i][other]) / 2;
    }
}

/* False if triangles have no vertices. */
static bool find_bounds(TrimWork *work) {
    Vec3f low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    const TexelMesh *mesh = work->mesh;
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            if (mesh->triangles[t][i] >= mesh->vertex_count) return false;
            Vec3f q = mesh->vertices[mesh->triangles[t][i]];
            low = vec3f(float_min(low.x, q.x), float_min(low.y, q.y), float_min(low.z, q.z));
            high = vec3f(float_max(high.x, q.x), float_max(high.y, q.y), float_max(high.z, q.z));
        }
    const bool *cyclic = work->layer->cyclic;
    work->views->low = low, work->views->high = high;
    work->contained = low.y >= 0 && high.y <= work->extent.y && (cyclic[0] || (low.x >= 0 && high.x <= work->extent.x)) &&
                      (cyclic[2] || (low.z >= 0 && high.z <= work->extent.z));
    return true;
}

/* Voxels that are not much larger than triangles need no factors; of N triangles in a layer they are about so many levels below the coarsest. */
static int levels_to_trim(const VoxelLayer *layer, size_t triangles) {
    int levels = (int)ceilf(0.5f * log2f((float)triangles + 1) - LEVELS_OF_TRIANGLES);
    return int_min(layer->levels, int_clamp(levels, LEAST_TRIM_LEVELS, TRIM_LEVELS));
}

void voxel_layer_trim(VoxelLayer *layer, const TexelMesh *mesh, Vec3f extent, LayerViews *views, Pool *pool) {
    voxel_layer_forget_trim(layer);
    voxel_layer_forget_pairs(layer);
    views->known = false;
    if (layer->cyclic[1] || layer->scattered || !mesh->triangle_count ||
        mesh->triangle_count > TRIM_MOST_TRIANGLES || voxel_layer_is_empty(layer))
        return;
    TrimWork work = {.layer = layer, .mesh = mesh, .extent = extent, .coarse = mesh->triangle_count > TRIM_MANY_TRIANGLES, .views = views};
    views->triangles = mesh->triangle_count;
    views->levels = levels_to_trim(layer, mesh->triangle_count);
    voxel_layer_unpack(layer);
    bool known = find_bounds(&work) && pool_run(pool, TRIM_DIRECTIONS + VIEWS_KEPT, look_through, &work);
    voxel_layer_pack(layer);
    for (int node = 0; node < TRIM_DIRECTIONS; node++) known &= work.known[node];
    if (known) fill_between(layer->trim, work.coarse ? 0 : OFTEN_TRIMMED);
    if (known) join_horizon(layer->trim);
    else voxel_layer_forget_trim(layer);
    views->known = known;
}

/* ---- layers among each other ---- */

static double hidden_by_all(const JoinWork *work, int even) {
    size_t hidden = 0;
    for (int i = 0; i < VIEW_PLACES / 64; i++) {
        uint64_t any = 0;
        for (size_t k = 0; k < work->count; k++) any |= work->views[k]->hidden[even][i];
        hidden += count_bits(any);
    }
    return (double)hidden / VIEW_PLACES;
}

static void join_node(void *context, size_t even, int worker) {
    const JoinWork *work = context;
    int node = (int)even / TRIM_EVEN_SIDE * 2 * TRIM_NODES + (int)even % TRIM_EVEN_SIDE * 2;
    const Seen of = {work->layers[0], work->extent, work->views[0]->low, false};
    LayerView view = look_along_node(&of, node);
    double hidden = hidden_by_all(work, (int)even);
    (void)worker;
    for (int i = 0; i < work->views[0]->levels; i++)
        work->factor[i][node] = trim_level(work, work->layers[0]->levels - 1 - i, node, &view, hidden);
}

/* Each hides what it hides alone; what stands behind the other is then hidden twice. */
static bool trim_all(const JoinWork *work, Pool *pool) {
    float factor[TRIM_LEVELS][TRIM_DIRECTIONS];
    JoinWork all = *work;
    all.factor = factor;
    for (int i = 0; i < TRIM_LEVELS; i++)
        for (int node = 0; node < TRIM_DIRECTIONS; node++) factor[i][node] = 1;
    if (!pool_run(pool, TRIM_EVEN, join_node, &all)) return false;
    fill_between(factor, 0);
    join_horizon(factor);
    for (size_t k = 0; k < work->count; k++)
        for (int i = 0; i < TRIM_LEVELS; i++)
            for (int node = 0; node < TRIM_DIRECTIONS; node++)
                work->layers[k]->trim[i][node] = float_clamp(work->layers[k]->trim[i][node] * factor[i][node], TRIM_LEAST, TRIM_MOST);
    return true;
}

/* What is met first of all layers, into the views of the first. */
static void see_all(const JoinWork *work) {
    LayerViews *all = work->views[0];
    for (size_t k = 1; k < work->count; k++)
        for (int kept = 0; kept < VIEWS_KEPT; kept++) {
            const LayerViews *other = work->views[k];
            if (!other->views[kept].top) all->views[kept].top = NULL;
            for (int i = 0; i < VIEW_PLACES; i++) {
                if (!(other->tops[kept][i] > all->tops[kept][i])) continue;
                all->tops[kept][i] = other->tops[kept][i];
                all->normals[kept][i] = other->normals[kept][i];
            }
        }
    for (size_t k = 1; k < work->count; k++) all->triangles += work->views[k]->triangles;
}

static void compare_views(const JoinWork *work, VoxelLayer *layer, Pool *pool) {
    const LayerViews *all = work->views[0];
    PairBeside beside;
    const float size[2] = {work->extent.x, work->extent.z};
    for (int i = 0; i < VIEWS_KEPT; i++)
        if (!all->views[i].top) return;
    PairShade *shades = malloc(PAIR_NODES * PAIR_NODES * sizeof *shades);
    if (shades && voxel_layer_pair(layer, all->views, VIEW_GRID, size, shades, pool) && pair_beside(layer, all->views, VIEW_GRID, size, &beside)) {
        voxel_layer_find_peaks(layer, &beside);
        const LitTruth truth = {all->views, VIEW_GRID, shades, &beside, all->triangles};
        const LitLayers among = {(const VoxelLayer *const *)work->layers, work->count, work->extent};
        voxel_layer_find_powers(layer, &truth, &among, all->levels, pool);
    }
    free(shades);
}

void voxel_layers_join(VoxelLayer *const *layers, LayerViews *const *views, size_t count, Vec3f extent, Pool *pool) {
    const JoinWork work = {.layers = layers, .views = views, .count = count, .extent = extent};
    VoxelLayer *most = layers[0];
    for (size_t k = 0; k < count; k++) {
        if (!views[k]->known) return;
        if (layers[k]->level[0].code_count > most->level[0].code_count) most = layers[k];
        views[0]->levels = int_max(views[0]->levels, views[k]->levels);
    }
    for (size_t k = 0; k < count; k++) voxel_layer_unpack(layers[k]);
    if (count == 1 || trim_all(&work, pool)) {
        see_all(&work);
        compare_views(&work, most, pool);
    }
    for (size_t k = 0; k < count; k++) voxel_layer_pack(layers[k]);
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
