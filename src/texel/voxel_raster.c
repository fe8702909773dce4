#include "texel/voxel_raster.h"

#include "texel/voxel_scan.h"

#include <math.h>

typedef struct AreaSink {
    VoxelCell *cells;
    bool solid;
    int axis;             /* the one that the triangle faces most */
    double area_per_unit; /* true area for twice the area projected along `axis`, in voxels */
    double normal[3];
} AreaSink;

static int cell_index(const int cell[3]) { return (cell[2] * BRICK_SIDE + cell[1]) * BRICK_SIDE + cell[0]; }

static void add_area(void *context, const int cell[3], const ClipPolygon *piece) {
    const AreaSink *sink = context;
    VoxelCell *c = &sink->cells[cell_index(cell)];
    double area = fabs(clip_projected_area(piece, sink->axis)) * sink->area_per_unit;
    const double *n = sink->normal;
    *(sink->solid ? &c->solid : &c->sheet) += (float)area;
    const double squares[6] = {n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[0] * n[2], n[1] * n[2]};
    for (int i = 0; i < 6; i++) c->normals[i] += (float)(area * squares[i]);
}

static void add_areas(VoxelCell *cells, const ClipPolygon *triangle, bool solid, const int size[3],
                      const float sides[3]) {
    AreaSink sink = {.cells = cells, .solid = solid};
    double projected[3], area[3], length = 0; /* area: the vector of twice the area in texel space */
    for (int k = 0; k < 3; k++) {
        projected[k] = clip_projected_area(triangle, k);
        area[k] = projected[k] * (double)sides[(k + 1) % 3] * (double)sides[(k + 2) % 3];
        length += area[k] * area[k];
        if (fabs(projected[k]) > fabs(projected[sink.axis])) sink.axis = k;
    }
    length = sqrt(length);
    if (!(length > 0)) return;
    for (int k = 0; k < 3; k++) sink.normal[k] = area[k] / length;
    sink.area_per_unit = 0.5 * length / fabs(projected[sink.axis]);
    clip_to_cells(triangle, size, add_area, &sink);
}

/* Where in its column's eighth the rays of each row stand: spread so that the 64 rays of a voxel differ. */
static double ray_offset(int row) {
    static const double offsets[8] = {1 / 16., 9 / 16.,  5 / 16., 13 / 16.,
                                      3 / 16., 11 / 16., 7 / 16., 15 / 16.};
    return offsets[row & 7];
}

/* `count` rays meet the triangle; turn: +1 or −1, which way it faces. */
static void meet(VoxelCell *cell, int axis, uint64_t rays, int count, bool solid, float turn) {
    float met = (float)count;
    cell->cover[axis] |= rays;
    cell->met[axis] += met;
    if (!solid) return;
    cell->walls += met;
    cell->net[axis] += turn * met;
    cell->inside[axis] ^= rays;
}

/* A row of rays across the triangle; depth along them in units of 2⁻³² voxels. */
typedef struct RayRow {
    int row, begin, end; /* columns */
    int64_t depth, step; /* at column `begin`; per column */
    float turn;
} RayRow;

/* Planes so steep, or so far off, that they cannot be met within a brick but by rounding. */
static bool fits_depth(double x) { return x > -0x1p20 && x < 0x1p20; }

/* Columns `begin` to `end` of one voxel across, along which the depth goes from one voxel to another. first: the row's first bit. */
static void add_steep(VoxelCell *cells, const RayRow *r, int begin, int end, int64_t depth, uint64_t limit, uint64_t first, bool solid, int axis,
                      int along) {
    while (begin < end) {
        int64_t deep = depth >> 32;
        int column = begin;
        do column++, depth += r->step;
        while (column < end && depth >> 32 == deep);
        if ((uint64_t)deep < limit >> 32)
            meet(&cells[deep << along], axis, first * ((1u << (column - begin)) - 1) << (begin & 7), column - begin, solid, r->turn);
        begin = column;
    }
}

static void add_row(VoxelCell *cells, const RayRow *r, bool solid, const int size[3], int axis) {
    static const int shifts[3] = {0, 3, 6}; /* of a cell's index, along each axis */
    int along = shifts[axis], across = shifts[voxel_ray_columns(axis)];
    cells += r->row >> 3 << shifts[voxel_ray_rows(axis)];
    uint64_t first = (uint64_t)1 << ((r->row & 7) * 8), limit = (uint64_t)size[axis] << 32;
    int64_t depth = r->depth;
    for (int column = r->begin, end; column < r->end; depth += (end - column) * r->step, column = end) {
        VoxelCell *row = cells + (column >> 3 << across);
        end = int_min((column | 7) + 1, r->end);
        if (depth >> 32 != (depth + (end - column - 1) * r->step) >> 32)
            add_steep(row, r, column, end, depth, limit, first, solid, axis, along);
        else if ((uint64_t)depth < limit)
            meet(&row[depth >> 32 << along], axis, first * ((1u << (end - column)) - 1) << (column & 7), end - column, solid, r->turn);
    }
}

static void add_rays(VoxelCell *cells, const ClipPolygon *t, bool solid, const int size[3], int axis) {
    int u = voxel_ray_columns(axis), v = voxel_ray_rows(axis);
    double facing = clip_projected_area(t, axis);
    if (facing == 0) return;
    double slope_u = -clip_projected_area(t, u) / facing, slope_v = -clip_projected_area(t, v) / facing;
    bool flat = slope_u == 0 && slope_v == 0;
    if (!fits_depth(slope_u)) return;
    ScanOutline outline = scan_outline(t->at[0], t->at[1], t->at[2], u, v);
    double width = 8 * size[u];
    int row_end = scan_ceil(double_clamp(8 * outline.highest - 0.5, 0, 8 * size[v]));
    for (int row = scan_ceil(double_clamp(8 * outline.lowest - 0.5, 0, 8 * size[v])); row < row_end; row++) {
        double at = (row + 0.5) / 8, lo, hi, offset = ray_offset(row);
        scan_row(&outline, at, &lo, &hi);
        RayRow r = {.row = row,
                    .turn = facing > 0 ? 1.0f : -1.0f,
                    .begin = scan_ceil(double_clamp(8 * lo - offset, 0, width)),
                    .end = scan_ceil(double_clamp(8 * hi - offset, 0, width))};
        if (r.begin >= r.end) continue;
        double depth =
            t->at[0][axis] + slope_v * (at - t->at[0][v]) + slope_u * ((r.begin + offset) / 8 - t->at[0][u]);
        if (flat && depth == size[axis]) depth -= 0x1p-30; /* the very last plane belongs to the last cell */
        if (!fits_depth(depth)) continue;
        r.depth = (int64_t)(depth * 0x1p32);
        r.step = (int64_t)(slope_u * 0x1p29);
        add_row(cells, &r, solid, size, axis);
    }
}

void voxel_raster_add(VoxelCell cells[BRICK_VOXELS], const ClipPolygon *triangle, bool solid,
                      const int size[3], const float sides[3]) {
    add_areas(cells, triangle, solid, size, sides);
    for (int axis = 0; axis < 3; axis++) add_rays(cells, triangle, solid, size, axis);
}
