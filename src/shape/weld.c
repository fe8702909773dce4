#include "shape/weld.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* ---- points ---- */

/* A hash grid of places: a cell's key finds the newest place in it, which links to older ones. */
typedef struct PlaceGrid {
    const Vec3 *points;
    double tolerance, cell_size; /* cell_size 0: coordinates themselves are the keys */
    uint32_t *heads;             /* place + 1; 0 = none */
    uint32_t *next;              /* per place, likewise */
    uint32_t *first_point;       /* per place */
    uint64_t mask;
    uint32_t place_count;
} PlaceGrid;

static double cell_of(const PlaceGrid *grid, double x) {
    return (grid->cell_size > 0 ? floor(x / grid->cell_size) : x) + 0.0; /* -0 and +0 are one */
}

static uint64_t slot_of(const PlaceGrid *grid, double x, double y, double z) {
    uint64_t bits[3];
    memcpy(&bits[0], &x, sizeof x);
    memcpy(&bits[1], &y, sizeof y);
    memcpy(&bits[2], &z, sizeof z);
    uint64_t mixed = bits[0] * 0x9E3779B97F4A7C15u + (bits[1] ^ bits[1] >> 29) * 0xC2B2AE3D27D4EB4Fu;
    return random_mix(mixed ^ (bits[2] ^ bits[2] >> 31) * 0x165667B19E3779F9u) & grid->mask;
}

static uint64_t grid_slot(const PlaceGrid *grid, Vec3 p) {
    return slot_of(grid, cell_of(grid, p.x), cell_of(grid, p.y), cell_of(grid, p.z));
}

static bool are_close(Vec3 a, Vec3 b, double tolerance) {
    return fabs(a.x - b.x) <= tolerance && fabs(a.y - b.y) <= tolerance && fabs(a.z - b.z) <= tolerance;
}

/* The oldest place near p in p's slot or `best`, whichever is older. */
static uint32_t oldest_near(const PlaceGrid *grid, uint64_t slot, Vec3 p, uint32_t best) {
    for (uint32_t i = grid->heads[slot]; i; i = grid->next[i - 1]) {
        if (i < best && are_close(grid->points[grid->first_point[i - 1]], p, grid->tolerance)) best = i;
    }
    return best;
}

/* Looks into every cell that the tolerance around p touches: nearly always one. */
static uint32_t find_place(const PlaceGrid *grid, Vec3 p) {
    const double at[3] = {p.x, p.y, p.z};
    double lo[3], hi[3];
    uint32_t best = UINT32_MAX;
    for (int k = 0; k < 3; k++) {
        lo[k] = cell_of(grid, at[k] - grid->tolerance);
        hi[k] = cell_of(grid, at[k] + grid->tolerance);
    }
    for (int corner = 0; corner < 8; corner++) {
        bool repeated = false;
        for (int k = 0; k < 3; k++) repeated |= (corner >> k & 1) && lo[k] == hi[k];
        if (repeated) continue;
        uint64_t slot =
            slot_of(grid, corner & 1 ? hi[0] : lo[0], corner & 2 ? hi[1] : lo[1], corner & 4 ? hi[2] : lo[2]);
        best = oldest_near(grid, slot, p, best);
    }
    return best;
}

static uint32_t add_place(PlaceGrid *grid, uint32_t point) {
    uint64_t slot = grid_slot(grid, grid->points[point]);
    uint32_t place = grid->place_count++;
    grid->first_point[place] = point;
    grid->next[place] = grid->heads[slot];
    grid->heads[slot] = place + 1;
    return place;
}

uint32_t weld_points(const Vec3 *points, size_t count, double tolerance, Arena *arena, uint32_t *place) {
    uint64_t slots = 16;
    while (slots < 2 * (uint64_t)count) slots *= 2;
    PlaceGrid grid = {
        .points = points, .tolerance = tolerance, .cell_size = 1024 * tolerance, .mask = slots - 1};
    grid.heads = arena_new_array(arena, uint32_t, slots);
    grid.next = arena_new_array(arena, uint32_t, count);
    grid.first_point = arena_new_array(arena, uint32_t, count);
    for (size_t i = 0; i < count; i++) {
        uint32_t found = find_place(&grid, points[i]);
        place[i] = found != UINT32_MAX ? found - 1 : add_place(&grid, (uint32_t)i);
    }
    return grid.place_count;
}

double weld_tolerance(const Vec3 *points, size_t count) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < count; i++) box = box3_add_point(box, points[i]);
    if (box3_is_empty(box)) return 0;
    Vec3 size = vec3_sub(box.max, box.min);
    return 1e-9 * double_max(size.x, double_max(size.y, size.z));
}

/* ---- edges ---- */

static int compare_edges(const void *a, const void *b) {
    const WeldEdge *x = a, *y = b;
    if (x->hi != y->hi) return x->hi < y->hi ? -1 : 1;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    return (int)x->edge - (int)y->edge;
}

void weld_sort_edges(WeldEdge *edges, size_t count, size_t vertex_count, Arena *scratch) {
    /* One counting pass by lo; then the few edges of each vertex. */
    size_t *start = arena_new_array(scratch, size_t, vertex_count + 2);
    WeldEdge *sorted = arena_new_array(scratch, WeldEdge, count);
    for (size_t i = 0; i < count; i++) start[edges[i].lo + 2]++;
    for (size_t v = 2; v < vertex_count + 2; v++) start[v] += start[v - 1];
    for (size_t i = 0; i < count; i++) sorted[start[edges[i].lo + 1]++] = edges[i];
    for (size_t v = 0; v < vertex_count; v++) {
        if (start[v + 1] - start[v] > 1)
            qsort(sorted + start[v], start[v + 1] - start[v], sizeof *sorted, compare_edges);
    }
    if (count) memcpy(edges, sorted, count * sizeof *edges);
}
