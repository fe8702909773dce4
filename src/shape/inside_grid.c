#include "shape/inside_grid.h"

#include "base/random.h"
#include "shape/solid_field.h"

#include <stdlib.h>
#include <string.h>

/* ---- corners ---- */

static size_t corner_index(const InsideGrid *grid, uint32_t x, uint32_t y, uint32_t z) {
    return ((size_t)z * grid->size[1] + y) * grid->size[0] + x;
}

static Vec3 corner_at(const InsideGrid *grid, uint32_t x, uint32_t y, uint32_t z) {
    return vec3_add(grid->origin, vec3_mul(grid->step, vec3(x, y, z)));
}

typedef struct GridPlace {
    uint32_t at[3];
} GridPlace;

typedef struct CrossingSink {
    SolidSink base;
    Arena *arena;
    struct {
        double *items;
        size_t count, capacity;
    } crossings;
    struct {
        GridPlace *items;
        size_t count, capacity;
    } skipped; /* corners before which something begins and ends within one step */
} CrossingSink;

static void take_crossing(SolidSink *base, double t, const SolidTag *tag) {
    CrossingSink *sink = (CrossingSink *)(void *)base;
    (void)tag;
    *list_push(sink->arena, &sink->crossings) = t;
}

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Whether the corners from <x, y, z> - before to <x, y, z> + after are all alike: then what was seen between them is in no cell. */
static bool is_lost(const InsideGrid *grid, const uint32_t at[3], const uint32_t before[3], const uint32_t after[3]) {
    uint32_t lo[3], hi[3];
    for (int i = 0; i < 3; i++) {
        lo[i] = at[i] > before[i] ? at[i] - before[i] : 0;
        hi[i] = at[i] + after[i] < grid->size[i] ? at[i] + after[i] : grid->size[i] - 1;
    }
    uint8_t first = grid->inside[corner_index(grid, lo[0], lo[1], lo[2])];
    for (uint32_t z = lo[2]; z <= hi[2]; z++)
        for (uint32_t y = lo[1]; y <= hi[1]; y++)
            for (uint32_t x = lo[0]; x <= hi[0]; x++)
                if (grid->inside[corner_index(grid, x, y, z)] != first) return false;
    return true;
}

/* Between two crossings nothing changes: one question for each stretch of the row. */
static void fill_row_by_crossings(const ExactSurface *surface, InsideGrid *grid, CrossingSink *sink, uint32_t y, uint32_t z) {
    Vec3 start = corner_at(grid, 0, y, z);
    uint32_t count = grid->size[0], x = 0;
    const Ray ray = {start, {1, 0, 0}};
    double length = grid->step.x * (count - 1), from = 0;
    sink->base.t_min = -grid->step.x, sink->base.t_max = length + grid->step.x;
    sink->crossings.count = 0;
    surface->ops->cross(surface->data, &ray, &sink->base);
    if (sink->crossings.count) qsort(sink->crossings.items, sink->crossings.count, sizeof(double), by_value);
    for (size_t i = 0; i <= sink->crossings.count && x < count; i++) {
        double to = i < sink->crossings.count ? sink->crossings.items[i] : VTS_INFINITY;
        if (!(to > from)) continue;
        bool inside = solid_holds(surface, vec3_madd(start, ray.direction, (from + double_min(to, length + grid->step.x)) / 2));
        uint32_t first = x;
        while (x < count && grid->step.x * x < to) grid->inside[corner_index(grid, x++, y, z)] = inside;
        if (first == x && x > 0 && i > 0 && i < sink->crossings.count) *list_push(sink->arena, &sink->skipped) = (GridPlace){{x - 1, y, z}};
        from = to;
    }
}

/* Something sets it while a grid is filled, and all goes through unasked rows then. */
static bool given_up(const atomic_bool *interrupted) { return interrupted && *interrupted; }

static void fill_by_crossings(const ExactSurface *surface, InsideGrid *grid, const atomic_bool *interrupted, Arena *arena) {
    CrossingSink sink = {.base.take = take_crossing, .arena = arena};
    for (uint32_t z = 0; z < grid->size[2]; z++)
        for (uint32_t y = 0; y < grid->size[1] && !given_up(interrupted); y++) fill_row_by_crossings(surface, grid, &sink, y, z);
    for (size_t i = 0; i < sink.skipped.count; i++)
        grid->missed += is_lost(grid, sink.skipped.items[i].at, (const uint32_t[]){0, 1, 1}, (const uint32_t[]){1, 1, 1});
}

static void fill_by_inside(const ExactSurface *surface, InsideGrid *grid, const atomic_bool *interrupted) {
    for (uint32_t z = 0; z < grid->size[2]; z++)
        for (uint32_t y = 0; y < grid->size[1] && !given_up(interrupted); y++)
            for (uint32_t x = 0; x < grid->size[0]; x++)
                grid->inside[corner_index(grid, x, y, z)] = solid_holds(surface, corner_at(grid, x, y, z));
}

/* A cell with corners all alike whose middle differs holds something thin. It is looked at where the values say that the
 * surface may be near: none is further from 0 than they differ among each other. */
static void find_missed(const Solid *solid, InsideGrid *grid, const double *value) {
    size_t dx = 1, dy = grid->size[0], dz = (size_t)grid->size[0] * grid->size[1];
    const size_t offsets[8] = {0, dx, dy, dx + dy, dz, dx + dz, dy + dz, dx + dy + dz};
    for (uint32_t z = 0; z + 1 < grid->size[2]; z++)
        for (uint32_t y = 0; y + 1 < grid->size[1]; y++)
            for (uint32_t x = 0; x + 1 < grid->size[0]; x++) {
                const double *v = value + corner_index(grid, x, y, z);
                double lo = VTS_INFINITY, hi = -VTS_INFINITY;
                for (int k = 0; k < 8; k++) lo = double_min(lo, v[offsets[k]]), hi = double_max(hi, v[offsets[k]]);
                if ((lo < 0) != (hi < 0) || double_min(fabs(lo), fabs(hi)) > hi - lo || !isfinite(hi - lo)) continue;
                Vec3 middle = vec3_madd(corner_at(grid, x, y, z), grid->step, 0.5);
                const uint32_t at[3] = {x, y, z};
                if ((solid_isosurface_value(solid, middle) < 0) != (lo < 0))
                    grid->missed += is_lost(grid, at, (const uint32_t[]){1, 1, 1}, (const uint32_t[]){2, 2, 2});
            }
}

static void fill_by_values(const Solid *solid, InsideGrid *grid, const atomic_bool *interrupted, Arena *arena) {
    size_t row = grid->size[0], rows = (size_t)grid->size[1] * grid->size[2];
    double *value = arena_new_array(arena, double, row * rows), *in = arena_new_array(arena, double, 3 * row);
    for (uint32_t z = 0; z < grid->size[2]; z++)
        for (uint32_t y = 0; y < grid->size[1] && !given_up(interrupted); y++)
            solid_isosurface_row(solid, corner_at(grid, 0, y, z), vec3(grid->step.x, 0, 0), row, in,
                                 value + corner_index(grid, 0, y, z));
    for (size_t i = 0; i < row * rows; i++) grid->inside[i] = value[i] < 0;
    if (!given_up(interrupted)) find_missed(solid, grid, value);
}

bool inside_grid_fill(const ExactSurface *surface, Box3 box, uint32_t cells, const atomic_bool *interrupted, Arena *arena, InsideGrid *out) {
    Vec3 size = vec3_sub(box.max, box.min);
    double longest = double_max(size.x, double_max(size.y, size.z)), cell = longest / cells, count[3] = {size.x, size.y, size.z};
    if (!isfinite(longest) || !(longest > 0)) return false;
    *out = (InsideGrid){.origin = box.min};
    for (int i = 0; i < 3; i++) {
        count[i] = double_max(ceil(count[i] / cell - 1e-9), 1);
        out->size[i] = (uint32_t)count[i] + 1;
    }
    out->step = vec3(size.x / count[0], size.y / count[1], size.z / count[2]);
    out->inside = arena_new_array(arena, uint8_t, (size_t)out->size[0] * out->size[1] * out->size[2]);
    const Solid *solid = surface->object->kind == OBJECT_SOLID ? surface->object->as.solid : NULL;
    if (solid && solid->kind == SOLID_ISOSURFACE)
        fill_by_values(solid, out, interrupted, arena);
    else if (solid && (solid->kind == SOLID_JULIA || solid->kind == SOLID_SUPERELLIPSOID))
        fill_by_inside(surface, out, interrupted);
    else
        fill_by_crossings(surface, out, interrupted, arena);
    return !given_up(interrupted);
}

/* ---- the surface ---- */

/* Corner k of a cell lies at (k & 1, k >> 1 & 1, k >> 2). */
static const uint8_t edge_ends[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
/* Edges round each face; edge i runs from corner i of the face to the next. */
static const uint8_t face_corners[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
static const uint8_t face_edges[6][4] = {{4, 10, 6, 8}, {5, 11, 7, 9}, {0, 9, 2, 8}, {1, 11, 3, 10}, {0, 5, 1, 4}, {2, 7, 3, 6}};

typedef struct CellVertices {
    uint64_t key; /* cell + 1; 0: free */
    uint32_t vertex[12]; /* per edge that is crossed */
} CellVertices;

typedef struct Contour {
    const InsideGrid *grid;
    Arena *arena;
    TriangleSoup *out;
    CellVertices *slots;
    uint64_t mask;
} Contour;

static unsigned corners_of(const InsideGrid *grid, uint32_t x, uint32_t y, uint32_t z) {
    unsigned bits = 0;
    for (uint32_t k = 0; k < 8; k++)
        bits |= (unsigned)grid->inside[corner_index(grid, x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))] << k;
    return bits;
}

static bool is_crossed(unsigned corners, int edge) {
    return (corners >> edge_ends[edge][0] & 1) != (corners >> edge_ends[edge][1] & 1);
}

static void join(uint8_t sheet[12], int a, int b) {
    uint8_t from = sheet[a], to = sheet[b];
    for (int i = 0; i < 12; i++)
        if (sheet[i] == from) sheet[i] = to;
}

/* Which edges are crossed by the same sheet: those that follow each other on a face. Where four of a face are crossed, its inside
 * corners are apart; both its cells see it so. */
static void find_sheets(unsigned corners, uint8_t sheet[12]) {
    for (uint8_t i = 0; i < 12; i++) sheet[i] = i;
    for (int f = 0; f < 6; f++) {
        int crossed[4], count = 0;
        for (int i = 0; i < 4; i++)
            if (is_crossed(corners, face_edges[f][i])) crossed[count++] = face_edges[f][i];
        if (count == 2) join(sheet, crossed[0], crossed[1]);
        if (count < 4) continue;
        for (int i = 0; i < 4; i++)
            if (corners >> face_corners[f][i] & 1) join(sheet, face_edges[f][(i + 3) % 4], face_edges[f][i]);
    }
}

static Vec3 middle_of_edge(const InsideGrid *grid, uint32_t x, uint32_t y, uint32_t z, int edge) {
    double at[3] = {0, 0, 0};
    for (int end = 0; end < 2; end++)
        for (int axis = 0; axis < 3; axis++) at[axis] += 0.5 * (edge_ends[edge][end] >> axis & 1);
    return vec3_add(grid->origin, vec3_mul(grid->step, vec3(x + at[0], y + at[1], z + at[2])));
}

static CellVertices *cell_slot(const Contour *c, uint64_t key) {
    uint64_t i = random_mix(key) & c->mask;
    while (c->slots[i].key && c->slots[i].key != key) i = (i + 1) & c->mask;
    return &c->slots[i];
}

static uint64_t cell_key(const Contour *c, uint32_t x, uint32_t y, uint32_t z) { return corner_index(c->grid, x, y, z) + 1; }

static void put_cell(Contour *c, uint32_t x, uint32_t y, uint32_t z, unsigned corners) {
    CellVertices *cell = cell_slot(c, cell_key(c, x, y, z));
    uint8_t sheet[12];
    cell->key = cell_key(c, x, y, z);
    find_sheets(corners, sheet);
    for (uint8_t s = 0; s < 12; s++) {
        Vec3 sum = {0, 0, 0};
        int count = 0;
        for (int e = 0; e < 12; e++)
            if (sheet[e] == s && is_crossed(corners, e)) sum = vec3_add(sum, middle_of_edge(c->grid, x, y, z, e)), count++;
        if (!count) continue;
        uint32_t vertex = soup_vertex(c->arena, c->out, vec3_scale(sum, 1.0 / count), vec3_splat(0), (double)NAN, (double)NAN);
        for (int e = 0; e < 12; e++)
            if (sheet[e] == s) cell->vertex[e] = vertex;
    }
}

static size_t count_cells(const InsideGrid *grid) {
    size_t count = 0;
    for (uint32_t z = 0; z + 1 < grid->size[2]; z++)
        for (uint32_t y = 0; y + 1 < grid->size[1]; y++)
            for (uint32_t x = 0; x + 1 < grid->size[0]; x++) {
                unsigned corners = corners_of(grid, x, y, z);
                count += corners != 0 && corners != 255;
            }
    return count;
}

/* Around an edge along `axis`, in the order of a left turn about it: offsets of the four cells in the two other axes, and which
 * of its edges it is in each. */
static const uint8_t around_edge[3][4] = {{3, 1, 0, 2}, {7, 6, 4, 5}, {11, 9, 8, 10}};

static void put_edge(Contour *c, const uint32_t at[3], int axis) {
    uint32_t next[3] = {at[0], at[1], at[2]}, v[4];
    next[axis]++;
    bool a = c->grid->inside[corner_index(c->grid, at[0], at[1], at[2])],
         b = c->grid->inside[corner_index(c->grid, next[0], next[1], next[2])];
    if (a == b) return;
    for (int k = 0; k < 4; k++) {
        int edge = around_edge[axis][k];
        uint32_t cell[3];
        for (int i = 0; i < 3; i++) {
            uint32_t offset = edge_ends[edge][0] >> i & 1;
            cell[i] = at[i] - offset;
            if (at[i] < offset || cell[i] + 1 >= c->grid->size[i]) return; /* at the border of the grid */
        }
        v[k] = cell_slot(c, cell_key(c, cell[0], cell[1], cell[2]))->vertex[edge];
    }
    bool turned = !a;
    soup_triangle(c->arena, c->out, v[0], v[turned ? 1 : 2], v[turned ? 2 : 1], false);
    soup_triangle(c->arena, c->out, v[0], v[turned ? 2 : 3], v[turned ? 3 : 2], false);
}

void inside_grid_surface(const InsideGrid *grid, Arena *arena, TriangleSoup *out) {
    size_t slots = 16, cells = count_cells(grid);
    while (slots < 2 * cells) slots *= 2;
    Contour c = {grid, arena, out, arena_new_array(arena, CellVertices, slots), slots - 1};
    for (uint32_t z = 0; z + 1 < grid->size[2]; z++)
        for (uint32_t y = 0; y + 1 < grid->size[1]; y++)
            for (uint32_t x = 0; x + 1 < grid->size[0]; x++) {
                unsigned corners = corners_of(grid, x, y, z);
                if (corners != 0 && corners != 255) put_cell(&c, x, y, z, corners);
            }
    for (uint32_t z = 0; z < grid->size[2]; z++)
        for (uint32_t y = 0; y < grid->size[1]; y++)
            for (uint32_t x = 0; x < grid->size[0]; x++)
                for (int axis = 0; axis < 3; axis++) {
                    const uint32_t at[3] = {x, y, z};
                    if (at[axis] + 1 < grid->size[axis]) put_edge(&c, at, axis);
                }
}
