#include "texel/voxel_raster.h"

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

/* Where the line v = at meets the triangle's outline; each edge is computed from its lower end, so that two triangles that
 * share it agree and a closed surface is met an even number of times. */
static bool cross_outline(const ClipPolygon *t, int u, int v, double at, double *lo, double *hi) {
    *lo = HUGE_VAL;
    *hi = -HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        const double *a = t->at[i], *b = t->at[(i + 1) % 3];
        if (a[v] > b[v]) {
            const double *swap = a;
            a = b;
            b = swap;
        }
        if (!(a[v] <= at && at < b[v])) continue;
        double x = a[u] + (at - a[v]) * ((b[u] - a[u]) / (b[v] - a[v]));
        *lo = fmin(*lo, x);
        *hi = fmax(*hi, x);
    }
    return *lo < *hi;
}

static void meet(VoxelCell *cell, int axis, uint64_t ray, bool solid) {
    cell->cover[axis] |= ray;
    if (!solid) return;
    cell->walls += 1;
    cell->inside[axis] ^= ray;
}

static void add_rays(VoxelCell *cells, const ClipPolygon *t, bool solid, const int size[3], int axis) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double facing = clip_projected_area(t, axis);
    if (facing == 0) return;
    double slope_u = -clip_projected_area(t, u) / facing, slope_v = -clip_projected_area(t, v) / facing;
    double v_lo = fmin(t->at[0][v], fmin(t->at[1][v], t->at[2][v])),
           v_hi = fmax(t->at[0][v], fmax(t->at[1][v], t->at[2][v]));
    int row_end = (int)ceil(double_min(8 * v_hi - 0.5, 8 * size[v]));
    for (int row = (int)ceil(double_max(8 * v_lo - 0.5, 0)); row < row_end; row++) {
        double at = (row + 0.5) / 8, lo, hi, offset = ray_offset(row);
        if (!cross_outline(t, u, v, at, &lo, &hi)) continue;
        int column_end = (int)ceil(double_min(8 * hi - offset, 8 * size[u]));
        double depth_at =
            t->at[0][axis] + slope_v * (at - t->at[0][v]) + slope_u * (offset / 8 - t->at[0][u]);
        for (int column = (int)ceil(double_max(8 * lo - offset, 0)); column < column_end; column++) {
            double depth = depth_at + slope_u * (column / 8.0);
            /* What lies in the very last plane belongs to the last cell; what only touches it, to the next brick. */
            if (!(depth >= 0 &&
                  (depth < size[axis] || (depth == size[axis] && slope_u == 0 && slope_v == 0))))
                continue;
            int cell[3];
            cell[axis] = int_min((int)depth, size[axis] - 1);
            cell[u] = column >> 3;
            cell[v] = row >> 3;
            meet(&cells[cell_index(cell)], axis, (uint64_t)1 << ((row & 7) * 8 + (column & 7)), solid);
        }
    }
}

void voxel_raster_add(VoxelCell cells[BRICK_VOXELS], const ClipPolygon *triangle, bool solid,
                      const int size[3], const float sides[3]) {
    add_areas(cells, triangle, solid, size, sides);
    for (int axis = 0; axis < 3; axis++) add_rays(cells, triangle, solid, size, axis);
}
