#include "pattern/tiling.h"

static const double height = 0.86602540378443865; /* of the triangle of side 1 */

static double part(double x) { return x - floor(x); }

/* Unit squares with a corner at the origin. */
static double squares(double x, double z) { return 2 * fmax(fabs(part(x) - 0.5), fabs(part(z) - 0.5)); }

/* Regular hexagons of side 1, an edge from the origin to x = 1: the nearest middle of two interleaved grids. */
static double hexagons(double x, double z) {
    double nearest = 1;
    for (int grid = 0; grid < 2; grid++) {
        double dx = 3 * (part((x - 0.5 - 1.5 * grid) / 3 + 0.5) - 0.5);
        double dz = 2 * height * (part((z - height - height * grid) / (2 * height) + 0.5) - 0.5);
        double across = fmax(fabs(dz), height * fabs(dx) + fabs(dz) / 2);
        nearest = fmin(nearest, across / height);
    }
    return nearest;
}

/* Triangles of side 1 between three families of lines; the numbers of the strips sum up to 0 or 1 short of a whole, which tells up from
 * down. */
static double triangles(double x, double z) {
    double a = part(z / height), b = part(x - z / (2 * height)), c = part(-x - z / (2 * height));
    bool up = a + b + c < 1.5;
    double rim = up ? fmin(a, fmin(b, c)) : 1 - fmax(a, fmax(b, c));
    return (1 - 3 * rim) / 2 + (up ? 0 : 0.5);
}

double tiling_number(int tiling, Vec3 p) {
    double value = tiling == 1   ? squares(p.x, p.z)
                   : tiling == 2 ? hexagons(p.x, p.z)
                   : tiling == 3 ? triangles(p.x, p.z)
                                 : 0.5;
    return value >= 0 && value <= 1 ? value : 0.5; /* of what is no number */
}
