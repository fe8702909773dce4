/* Lattice noises along straight pieces of lines, several pieces at once: what bounds of the second order are made of. */
#ifndef VTS_TAPE_NOISE_TAYLOR_H
#define VTS_TAPE_NOISE_TAYLOR_H

#include "tape/noise_lattice.h"

#include <string.h>

enum { TAYLOR_LANES = 8 };

/* Places at + s·way, s in [-1, 1], of TAYLOR_LANES pieces. */
typedef struct TaylorWay {
    double at[3][TAYLOR_LANES], way[3][TAYLOR_LANES];
} TaylorWay;

/* Of the noise there: value + first·s + second·s² and what follows. NaN where a coordinate is too large for cells of 32 bits. */
typedef struct TaylorTerms {
    double value[TAYLOR_LANES], first[TAYLOR_LANES], second[TAYLOR_LANES];
    double outside[TAYLOR_LANES]; /* how far the piece's ends lie beyond its middle's cell of the lattice, along each axis: the sum of the squares */
} TaylorTerms;

void noise_perlin_taylor(const TaylorWay *way, TaylorTerms *out);
/* Of POV-Ray's noise before it is clamped to [0, 1]. */
void noise_pov_taylor(const TaylorWay *way, TaylorTerms *out);

/* Bounds for the first and third derivatives along any unit direction, whatever the lattices hold: NOISE_…_CURVATURE in noise.h is that
 * of the second. Those of POV-Ray's noise hold within a cell; bench/prove_noise.c proves them. From one cell to the next its second derivative
 * along the axis across their wall jumps, by no more than NOISE_POV_JUMP: at the wall it is -6 times the difference between the corners' functions before it and
 * +6 times that behind it. The functions that belong to corners of the wall are the same; the other two are 1/2 + 1 + 1/2 + 1/2 at most, by half of a value
 * and by components in [-1, 1] of gradients along ways of 1 and, weighted by the curves, of 1/2 twice. No other second derivative jumps. */
#define NOISE_PERLIN_STEEPEST 3.76
#define NOISE_PERLIN_THIRD    151.0
#define NOISE_POV_STEEPEST    (5.01 * 0.48985582)
#define NOISE_POV_THIRD       (103.0 * 0.48985582)
#define NOISE_POV_JUMP        (30.0 * 0.48985582)

/* ---- for the files of the noises ---- */

/* The curve of a lattice at t with its first derivative, and half of the second. */
typedef void TaylorCurve(double t, double out[3]);

typedef struct TaylorAxis {
    double cell[TAYLOR_LANES], place[TAYLOR_LANES], curve[3][TAYLOR_LANES];
    double outside[TAYLOR_LANES]; /* the way, less that to the nearer border of the cell, or 0: squared */
} TaylorAxis;

static inline void taylor_locate(const double *restrict at, const double *restrict way, TaylorCurve *curve, TaylorAxis *restrict axis) {
    for (int l = 0; l < TAYLOR_LANES; l++) {
        double x = at[l], w = way[l], c[3], nearest = (x + 0x1.8p52) - 0x1.8p52, whole = nearest - (x < nearest ? 1.0 : 0.0);
        bool near = fabs(x) < LATTICE_FAR;
        double t = near ? x - whole : (double)NAN;
        curve(t, c);
        axis->cell[l] = near ? whole : 0, axis->place[l] = t;
        axis->curve[0][l] = c[0], axis->curve[1][l] = c[1] * w, axis->curve[2][l] = c[2] * w * w;
        double beyond = fabs(w) - (t < 0.5 ? t : 1 - t);
        axis->outside[l] = beyond > 0 ? beyond * beyond : 0;
    }
}

/* Four rows of four numbers into four columns: numbers[j][first + l] = rowl[j]. Compilers do not find the shuffles themselves, which pay
 * where a row is one vector. */
#if defined(__AVX__) && defined(__has_builtin)
#define TAYLOR_SHUFFLES __has_builtin(__builtin_shufflevector)
#else
#define TAYLOR_SHUFFLES 0
#endif
#if TAYLOR_SHUFFLES
static inline void taylor_columns(const double *row0, const double *row1, const double *row2, const double *row3,
                                  double numbers[4][TAYLOR_LANES], int first) {
    typedef double Four __attribute__((vector_size(32)));
    Four a, b, c, d;
    memcpy(&a, row0, sizeof a), memcpy(&b, row1, sizeof b), memcpy(&c, row2, sizeof c), memcpy(&d, row3, sizeof d);
    Four even = __builtin_shufflevector(a, b, 0, 4, 2, 6), odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    Four even_after = __builtin_shufflevector(c, d, 0, 4, 2, 6), odd_after = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    Four values = __builtin_shufflevector(even, even_after, 0, 1, 4, 5), along_y = __builtin_shufflevector(even, even_after, 2, 3, 6, 7);
    Four along_x = __builtin_shufflevector(odd, odd_after, 0, 1, 4, 5), along_z = __builtin_shufflevector(odd, odd_after, 2, 3, 6, 7);
    memcpy(&numbers[0][first], &values, sizeof values), memcpy(&numbers[1][first], &along_x, sizeof along_x);
    memcpy(&numbers[2][first], &along_y, sizeof along_y), memcpy(&numbers[3][first], &along_z, sizeof along_z);
}
#else
static inline void taylor_columns(const double *row0, const double *row1, const double *row2, const double *row3,
                                  double numbers[4][TAYLOR_LANES], int first) {
    for (int j = 0; j < 4; j++)
        numbers[j][first] = row0[j], numbers[j][first + 1] = row1[j], numbers[j][first + 2] = row2[j], numbers[j][first + 3] = row3[j];
}
#endif

static inline void taylor_along(const TaylorWay *way, LatticeFind *find, TaylorCurve *curve, TaylorTerms *restrict out) {
    TaylorAxis axes[3];
    double numbers[8][4][TAYLOR_LANES];
    int32_t cells[TAYLOR_LANES][4];
    LatticeCorners corners[TAYLOR_LANES];
    int from[TAYLOR_LANES]; /* the lane whose corners are those of this one */
    for (int k = 0; k < 3; k++) taylor_locate(way->at[k], way->way[k], curve, &axes[k]);
    for (int l = 0; l < TAYLOR_LANES; l++)
        for (int k = 0; k < 3; k++) cells[l][k] = (int32_t)axes[k].cell[l];
    for (int l = 0; l < TAYLOR_LANES; l++) {
        const int32_t *cell = cells[l], *before = cells[l ? l - 1 : 0];
        bool same = l > 0 && cell[0] == before[0] && cell[1] == before[1] && cell[2] == before[2];
        from[l] = same ? from[l - 1] : l;
        if (!same) find(cell, corners[l]);
    }
    for (int l = 0; l < TAYLOR_LANES; l += 4) {
        for (int c = 0; c < 8; c++)
            taylor_columns(corners[from[l]][c], corners[from[l + 1]][c], corners[from[l + 2]][c], corners[from[l + 3]][c], numbers[c], l);
    }
    for (int l = 0; l < TAYLOR_LANES; l++) out->outside[l] = (axes[0].outside[l] + axes[1].outside[l]) + axes[2].outside[l];
    for (int l = 0; l < TAYLOR_LANES; l++) {
        double value[8][3], row[4][3], plane[2][3], all[3];
        const double x[2] = {axes[0].place[l], axes[0].place[l] - 1}, y[2] = {axes[1].place[l], axes[1].place[l] - 1},
                     z[2] = {axes[2].place[l], axes[2].place[l] - 1};
        const double ux[3] = {axes[0].curve[0][l], axes[0].curve[1][l], axes[0].curve[2][l]},
                     uy[3] = {axes[1].curve[0][l], axes[1].curve[1][l], axes[1].curve[2][l]},
                     uz[3] = {axes[2].curve[0][l], axes[2].curve[1][l], axes[2].curve[2][l]};
#pragma GCC unroll 8
        for (int c = 0; c < 8; c++) {
            double gx = numbers[c][1][l], gy = numbers[c][2][l], gz = numbers[c][3][l];
            value[c][0] = numbers[c][0][l] * 0.5 + (gx * x[c & 1] + gy * y[c >> 1 & 1] + gz * z[c >> 2]);
            value[c][1] = gx * way->way[0][l] + gy * way->way[1][l] + gz * way->way[2][l];
            value[c][2] = 0;
        }
#pragma GCC unroll 4
        for (int c = 0; c < 4; c++) lattice_taylor_mix(ux, value[2 * c], value[2 * c + 1], row[c]);
        lattice_taylor_mix(uy, row[0], row[1], plane[0]);
        lattice_taylor_mix(uy, row[2], row[3], plane[1]);
        lattice_taylor_mix(uz, plane[0], plane[1], all);
        out->value[l] = all[0], out->first[l] = all[1], out->second[l] = all[2];
    }
}

#endif
