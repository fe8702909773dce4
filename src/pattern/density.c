/* Density files: numbers in the cells of the unit cube. Beyond the last cell comes the first. Before the first comes, in
 * POV-Ray, not the last but the cell 2⁶⁴ - 1 modulo the size. */
#include "pattern/numbers.h"

static float cell(const DensityGrid *grid, long x, long y, long z) {
    long at[3] = {x, y, z};
    for (int k = 0; k < 3; k++) {
        long size = grid->size[k];
        at[k] = at[k] < 0 ? (long)(UINT64_MAX % (uint64_t)size) : at[k] % size;
    }
    return grid->values[((size_t)at[2] * (size_t)grid->size[1] + (size_t)at[1]) * (size_t)grid->size[0] +
                        (size_t)at[0]];
}

static double linear(const DensityGrid *grid, const long at[3], const double t[3]) {
    double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        long to[3];
        for (int k = 0; k < 3; k++) {
            int far = corner >> k & 1;
            to[k] = at[k] + far;
            weight *= far ? t[k] : 1 - t[k];
        }
        sum += weight * (double)cell(grid, to[0], to[1], to[2]);
    }
    return sum;
}

/* The cubic through the middle two with the slopes that their neighbours give (Catmull-Rom). */
static double cubic_through(double t, const double v[4]) {
    double b = (v[2] - v[0]) / 2, d = (v[3] - v[1]) / 2, rise = v[1] - v[2];
    return (((2 * rise + b + d) * t - 3 * rise - 2 * b - d) * t + b) * t + v[1];
}

static double cubic(const DensityGrid *grid, const long at[3], const double t[3]) {
    double plane[4], row[4], column[4];
    for (int x = 0; x < 4; x++) {
        for (int y = 0; y < 4; y++) {
            for (int z = 0; z < 4; z++)
                column[z] = (double)cell(grid, at[0] + x - 1, at[1] + y - 1, at[2] + z - 1);
            row[y] = cubic_through(t[2], column);
        }
        plane[x] = cubic_through(t[1], row);
    }
    return cubic_through(t[0], plane);
}

double density_number(const Pigment *pigment, Vec3 p) {
    const DensityGrid *grid = pigment->density;
    const double place[3] = {p.x, p.y, p.z};
    long at[3];
    double t[3];
    for (int k = 0; k < 3; k++) {
        if (!grid || !(place[k] >= 0 && place[k] < 1)) return 0;
        double x = place[k] * grid->size[k];
        at[k] = (long)x;
        t[k] = x - (double)at[k];
    }
    double value = pigment->interpolation == 0   ? (double)cell(grid, at[0], at[1], at[2])
                   : pigment->interpolation == 1 ? linear(grid, at, t)
                                                 : cubic(grid, at, t);
    return fmax(value, 0);
}
