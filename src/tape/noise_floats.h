/* Lattice noises along straight pieces of lines as noise_taylor.h has them, in floats: eight pieces are one vector of AVX. Places in
 * their cells are taken in doubles, so that floats tell as much far from the origin as near it. */
#ifndef VTS_TAPE_NOISE_FLOATS_H
#define VTS_TAPE_NOISE_FLOATS_H

#include "tape/noise_taylor.h"

typedef float Floats __attribute__((vector_size(4 * TAYLOR_LANES)));

/* As TaylorTerms: value + first·s + second·s² and what follows. */
typedef struct FloatTerms {
    Floats value, first, second, outside;
} FloatTerms;

/* All of it, the ways into the noise among it, is off by less than this in a sum value + first + second: a corner's function is at most 3.5, on
 * some 30 roundings of 2⁻²⁴ each, and a way of 2⁻²⁵ into the lattice changes a noise by no more than 5 times that. */
#define NOISE_FLOAT_ERROR 0x1p-14

void noise_perlin_floats(const TaylorWay *way, FloatTerms *out);
void noise_pov_floats(const TaylorWay *way, FloatTerms *out);

/* ---- for the files of the noises ---- */

/* The curve of a lattice at *t with its first derivative, and half of the second. Vectors go by their addresses: processors without AVX have
 * no way to hand them over. */
typedef void FloatCurve(const Floats *t, Floats out[3]);

/* As LatticeCorners and LatticeFind. */
typedef const float *FloatCorners[8];
typedef void FloatFind(const int32_t cell[3], FloatCorners corners);

typedef struct FloatAxis {
    Floats place, way, curve[3];
    double cell[TAYLOR_LANES];
} FloatAxis;

static inline void floats_locate(const double *restrict at, const double *restrict way, FloatCurve *curve, FloatAxis *restrict axis) {
    typedef double Doubles __attribute__((vector_size(8 * TAYLOR_LANES)));
    double inside[TAYLOR_LANES];
    Doubles wide;
    for (int l = 0; l < TAYLOR_LANES; l++) {
        double x = at[l], nearest = (x + 0x1.8p52) - 0x1.8p52, whole = nearest - (x < nearest ? 1.0 : 0.0);
        bool near = fabs(x) < LATTICE_FAR;
        inside[l] = near ? x - whole : (double)NAN;
        axis->cell[l] = near ? whole : 0;
    }
    memcpy(&wide, inside, sizeof wide), axis->place = __builtin_convertvector(wide, Floats);
    memcpy(&wide, way, sizeof wide), axis->way = __builtin_convertvector(wide, Floats);
    curve(&axis->place, axis->curve);
    axis->curve[1] *= axis->way, axis->curve[2] *= axis->way * axis->way;
}

/* Of one corner, eight rows of four numbers into four columns. */
static inline void floats_columns(FloatCorners *const corners[TAYLOR_LANES], int corner, Floats out[4]) {
#if TAYLOR_SHUFFLES
    typedef float Four __attribute__((vector_size(16)));
    Floats half[4];
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++) {
        Four low, high;
        memcpy(&low, (*corners[k])[corner], sizeof low), memcpy(&high, (*corners[k + 4])[corner], sizeof high);
        half[k] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    Floats even = __builtin_shufflevector(half[0], half[1], 0, 8, 1, 9, 4, 12, 5, 13), odd = __builtin_shufflevector(half[0], half[1], 2, 10, 3, 11, 6, 14, 7, 15);
    Floats even_after = __builtin_shufflevector(half[2], half[3], 0, 8, 1, 9, 4, 12, 5, 13),
           odd_after = __builtin_shufflevector(half[2], half[3], 2, 10, 3, 11, 6, 14, 7, 15);
    out[0] = __builtin_shufflevector(even, even_after, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1] = __builtin_shufflevector(even, even_after, 2, 3, 10, 11, 6, 7, 14, 15);
    out[2] = __builtin_shufflevector(odd, odd_after, 0, 1, 8, 9, 4, 5, 12, 13);
    out[3] = __builtin_shufflevector(odd, odd_after, 2, 3, 10, 11, 6, 7, 14, 15);
#else
    for (int l = 0; l < TAYLOR_LANES; l++)
        for (int j = 0; j < 4; j++) out[j][l] = (*corners[l])[corner][j];
#endif
}

/* of[l]: the corners of lane l's cell, in `found` where neighbours share theirs. Returns whether all lanes do. */
static inline bool floats_find(const FloatAxis axes[3], FloatFind *find, FloatCorners found[TAYLOR_LANES], FloatCorners *of[TAYLOR_LANES]) {
    int32_t cells[TAYLOR_LANES][3];
    int count = 0;
    for (int l = 0; l < TAYLOR_LANES; l++)
        for (int k = 0; k < 3; k++) cells[l][k] = (int32_t)axes[k].cell[l];
    for (int l = 0; l < TAYLOR_LANES; l++) {
        const int32_t *cell = cells[l], *before = cells[l ? l - 1 : 0];
        if (l == 0 || cell[0] != before[0] || cell[1] != before[1] || cell[2] != before[2]) find(cell, found[count++]);
        of[l] = &found[count - 1];
    }
    return count == 1;
}

static inline void floats_mix(const Floats u[3], const Floats a[3], const Floats b[3], Floats out[3]) {
    Floats d0 = b[0] - a[0], d1 = b[1] - a[1], d2 = b[2] - a[2];
    out[0] = a[0] + u[0] * d0;
    out[1] = a[1] + (u[0] * d1 + u[1] * d0);
    out[2] = a[2] + (u[0] * d2 + u[1] * d1 + u[2] * d0);
}

/* Two linear functions have no second derivative. */
static inline void floats_mix_linear(const Floats u[3], const Floats a[2], const Floats b[2], Floats out[3]) {
    Floats d0 = b[0] - a[0], d1 = b[1] - a[1];
    out[0] = a[0] + u[0] * d0;
    out[1] = a[1] + (u[0] * d1 + u[1] * d0);
    out[2] = u[1] * d1 + u[2] * d0;
}

static inline void floats_absolute(Floats *x) {
    typedef uint32_t Bits __attribute__((vector_size(4 * TAYLOR_LANES)));
    Bits bits;
    memcpy(&bits, x, sizeof bits);
    bits &= 0x7FFFFFFF;
    memcpy(x, &bits, sizeof bits);
}

/* How far ends lie beyond the cell, squared: |way| less the way to the nearer wall, 1/2 - |place - 1/2|, if that is more than nothing. */
static inline void floats_beyond(const FloatAxis *axis, Floats *out) {
    Floats way = axis->way, off = axis->place - 0.5f;
    floats_absolute(&way), floats_absolute(&off);
    Floats past = way + off - 0.5f, size = past;
    floats_absolute(&size);
    past = (past + size) * 0.5f;
    *out = past * past;
}

static inline void floats_along(const TaylorWay *way, FloatFind *find, FloatCurve *curve, FloatTerms *restrict out) {
    FloatAxis axes[3];
    FloatCorners found[TAYLOR_LANES], *of[TAYLOR_LANES];
    for (int k = 0; k < 3; k++) floats_locate(way->at[k], way->way[k], curve, &axes[k]);
    bool one_cell = floats_find(axes, find, found, of);
    const Floats zero = {0};
    Floats value[8][2], row[4][3], plane[2][3], all[3];
    const Floats x[2] = {axes[0].place, axes[0].place - 1}, y[2] = {axes[1].place, axes[1].place - 1}, z[2] = {axes[2].place, axes[2].place - 1};
#pragma GCC unroll 8
    for (int c = 0; c < 8; c++) {
        Floats own[4];
        if (one_cell)
            for (int j = 0; j < 4; j++) own[j] = zero + found[0][c][j];
        else
            floats_columns(of, c, own);
        value[c][0] = own[0] * 0.5f + (own[1] * x[c & 1] + own[2] * y[c >> 1 & 1] + own[3] * z[c >> 2]);
        value[c][1] = own[1] * axes[0].way + own[2] * axes[1].way + own[3] * axes[2].way;
    }
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++) floats_mix_linear(axes[0].curve, value[2 * c], value[2 * c + 1], row[c]);
    floats_mix(axes[1].curve, row[0], row[1], plane[0]);
    floats_mix(axes[1].curve, row[2], row[3], plane[1]);
    floats_mix(axes[2].curve, plane[0], plane[1], all);
    out->value = all[0], out->first = all[1], out->second = all[2];
    Floats beyond[3];
    for (int k = 0; k < 3; k++) floats_beyond(&axes[k], &beyond[k]);
    out->outside = (beyond[0] + beyond[1]) + beyond[2];
}

#endif
