/* What lattice noises share: every corner of a unit cell has a value and a gradient, and a place in the cell gets the eight
 * corners' linear functions, mixed along x, then y, then z. Over arrays, neighbours that lie in the same cell share the look-up
 * of its corners and are computed together; bits do not depend on that. */
#ifndef VTS_TAPE_NOISE_LATTICE_H
#define VTS_TAPE_NOISE_LATTICE_H

#include "base/vec.h"

/* A corner's numbers: twice its value, its gradient. The eight corners of a cell: x changes fastest. */
typedef const double *LatticeCorners[8];

/* Finds the corners of a cell by its lowest corner. */
typedef void LatticeFind(const int32_t cell[3], LatticeCorners corners);
/* How far the far side counts at t in [0, 1]. */
typedef double LatticeCurve(double t);
/* The noise at one place, for places that are alone or far away. */
typedef double LatticeNoise(Vec3 p);

static inline double lattice_mix(double t, double a, double b) { return a + t * (b - a); }

static inline double lattice_at_corner(const double *w, double x, double y, double z) {
    return w[0] * 0.5 + w[1] * x + w[2] * y + w[3] * z;
}

/* At (x, y, z) in the cell, whose curves are u, v and w. The corners' numbers begin `skip` numbers further. */
static inline double lattice_between(const double *const corners[8], int skip, double x, double y, double z,
                                     double u, double v, double w) {
    double near_low = lattice_mix(u, lattice_at_corner(corners[0] + skip, x, y, z),
                                  lattice_at_corner(corners[1] + skip, x - 1, y, z));
    double near_high = lattice_mix(u, lattice_at_corner(corners[2] + skip, x, y - 1, z),
                                   lattice_at_corner(corners[3] + skip, x - 1, y - 1, z));
    double far_low = lattice_mix(u, lattice_at_corner(corners[4] + skip, x, y, z - 1),
                                 lattice_at_corner(corners[5] + skip, x - 1, y, z - 1));
    double far_high = lattice_mix(u, lattice_at_corner(corners[6] + skip, x, y - 1, z - 1),
                                  lattice_at_corner(corners[7] + skip, x - 1, y - 1, z - 1));
    return lattice_mix(w, lattice_mix(v, near_low, near_high), lattice_mix(v, far_low, far_high));
}

/* The same, with its gradient; du, dv and dw are the curves' slopes. */
static inline double lattice_gradient(const double *const corners[8], const double place[3], const double curve[3], const double slope[3],
                                      double gradient[3]) {
    double value[8], mixed[4], along[2][4];
    for (int c = 0; c < 8; c++)
        value[c] = lattice_at_corner(corners[c], place[0] - (c & 1), place[1] - (c >> 1 & 1), place[2] - (c >> 2));
    double u = curve[0], v = curve[1], w = curve[2];
    for (int k = 0; k < 4; k++) {
        mixed[k] = lattice_mix(u, value[2 * k], value[2 * k + 1]);
        along[0][k] = slope[0] * (value[2 * k + 1] - value[2 * k]) + lattice_mix(u, corners[2 * k][1], corners[2 * k + 1][1]);
        along[1][k] = lattice_mix(u, corners[2 * k][2], corners[2 * k + 1][2]);
    }
    double low = lattice_mix(v, mixed[0], mixed[1]), high = lattice_mix(v, mixed[2], mixed[3]), far[4];
    for (int k = 0; k < 4; k++) far[k] = lattice_mix(u, corners[2 * k][3], corners[2 * k + 1][3]);
    gradient[0] = lattice_mix(w, lattice_mix(v, along[0][0], along[0][1]), lattice_mix(v, along[0][2], along[0][3]));
    gradient[1] = lattice_mix(w, slope[1] * (mixed[1] - mixed[0]) + lattice_mix(v, along[1][0], along[1][1]),
                              slope[1] * (mixed[3] - mixed[2]) + lattice_mix(v, along[1][2], along[1][3]));
    gradient[2] = slope[2] * (high - low) + lattice_mix(w, lattice_mix(v, far[0], far[1]), lattice_mix(v, far[2], far[3]));
    return lattice_mix(w, low, high);
}

/* ---- along pieces of lines ---- */

/* Taylor's coefficients, to the second order, of the mixture of two linear functions a and b (value, slope) by a curve u. */
static inline void lattice_taylor_mix(const double u[3], const double a[3], const double b[3], double out[3]) {
    double d0 = b[0] - a[0], d1 = b[1] - a[1], d2 = b[2] - a[2];
    out[0] = a[0] + u[0] * d0;
    out[1] = a[1] + (u[0] * d1 + u[1] * d0);
    out[2] = a[2] + (u[0] * d2 + u[1] * d1 + u[2] * d0);
}

/* ---- arrays ---- */

enum { LATTICE_LANES = 64, LATTICE_RUN = 4 /* shorter runs in one cell are not worth a vector loop */ };
#define LATTICE_FAR 0x1p30 /* places beyond have cells that are no int32_t */

/* Of some lanes, along one axis. */
typedef struct LatticeAxis {
    double cell[LATTICE_LANES], place[LATTICE_LANES], curve[LATTICE_LANES];
} LatticeAxis;

static inline void lattice_locate(LatticeAxis *axis, const double *restrict at, size_t lanes,
                                  LatticeCurve *curve) {
    for (size_t l = 0; l < lanes; l++) {
        double x = at[l], nearest = (x + 0x1.8p52) - 0x1.8p52, whole = nearest - (x < nearest ? 1.0 : 0.0);
        axis->cell[l] = whole;
        axis->place[l] = x - whole;
        axis->curve[l] = curve(x - whole);
    }
}

static inline void lattice_run(const LatticeAxis axes[3], size_t begin, size_t end, LatticeFind *find,
                               double *restrict out) {
    LatticeCorners found, corners;
    double numbers[8][4];
    int32_t cell[3];
    for (int k = 0; k < 3; k++) cell[k] = (int32_t)axes[k].cell[begin];
    find(cell, found);
    for (int k = 0; k < 8; k++) {
        for (int j = 0; j < 4; j++) numbers[k][j] = found[k][j];
        corners[k] = numbers[k];
    }
    for (size_t l = begin; l < end; l++)
        out[l] = lattice_between(corners, 0, axes[0].place[l], axes[1].place[l], axes[2].place[l],
                                 axes[0].curve[l], axes[1].curve[l], axes[2].curve[l]);
}

/* first[l]: lane l is not in the cell of the lane before it. */
static inline void lattice_mark_runs(const LatticeAxis axes[3], size_t lanes, uint64_t *restrict first) {
    const double *x = axes[0].cell, *y = axes[1].cell, *z = axes[2].cell;
    first[0] = 1;
    for (size_t l = 1; l < lanes; l++) {
        double moved = fabs(x[l] - x[l - 1]) + fabs(y[l] - y[l - 1]) + fabs(z[l] - z[l - 1]);
        first[l] = moved > 0 ? 1 : 0;
    }
}

static inline bool lattice_all_near(const double *restrict at, size_t lanes) {
    uint64_t far = 0;
    for (size_t l = 0; l < lanes; l++) far |= fabs(at[l]) < LATTICE_FAR ? 0 : 1;
    return !far;
}

/* out[l] = one((x[l], y[l], z[l])) for at most LATTICE_LANES lanes. */
static inline void lattice_rows(double *restrict out, const double *restrict x, const double *restrict y,
                                const double *restrict z, size_t lanes, LatticeFind *find,
                                LatticeCurve *curve, LatticeNoise *one) {
    bool near = lattice_all_near(x, lanes) && lattice_all_near(y, lanes) && lattice_all_near(z, lanes);
    LatticeAxis axes[3];
    uint64_t first[LATTICE_LANES];
    if (near) {
        lattice_locate(&axes[0], x, lanes, curve);
        lattice_locate(&axes[1], y, lanes, curve);
        lattice_locate(&axes[2], z, lanes, curve);
        lattice_mark_runs(axes, lanes, first);
    }
    for (size_t begin = 0, end; begin < lanes; begin = end) {
        end = begin + 1;
        while (near && end < lanes && !first[end]) end++;
        if (end - begin >= LATTICE_RUN)
            lattice_run(axes, begin, end, find, out);
        else
            for (size_t l = begin; l < end; l++) out[l] = one(vec3(x[l], y[l], z[l]));
    }
}

#endif
