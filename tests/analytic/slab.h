/* Light in an even slab that scatters it evenly: the equation of transfer as an integral equation, solved. Lengths are optical depths. */
#ifndef VTS_TESTS_SLAB_H
#define VTS_TESTS_SLAB_H

#include <math.h>
#include <stdlib.h>

/* The exponential integral E2: by a series of E1 near 0, by a continued fraction of E1 beyond; E2 = exp(-x) - x E1. */
static inline double slab_e2(double x) {
    double e1;
    if (x <= 0) return 1;
    if (x > 1) {
        double fraction = 0;
        for (int k = 80; k >= 1; k--) fraction = (double)k * k / (x + 2 * k + 1 - fraction);
        e1 = exp(-x) / (x + 1 - fraction);
    } else {
        double term = 1;
        e1 = -0.57721566490153286 - log(x);
        for (int k = 1; k < 25; k++) {
            term *= -x / k;
            e1 -= term / k;
        }
    }
    return exp(-x) - x * e1;
}

enum { SLAB_CELLS = 400 };

/* The walls of cells that are finer towards both faces. */
static inline double slab_wall(double depth, int i) {
    double x = (double)i / SLAB_CELLS;
    return depth * x * x * (3 - 2 * x);
}

/* In place: Gauss' elimination of a matrix whose diagonal is the largest of its row. */
static inline void slab_solve(double (*m)[SLAB_CELLS], double *b) {
    for (int p = 0; p < SLAB_CELLS; p++)
        for (int r = p + 1; r < SLAB_CELLS; r++) {
            double f = m[r][p] / m[p][p];
            if (f == 0) continue;
            for (int c = p; c < SLAB_CELLS; c++) m[r][c] -= f * m[p][c];
            b[r] -= f * b[p];
        }
    for (int p = SLAB_CELLS - 1; p >= 0; p--) {
        for (int c = p + 1; c < SLAB_CELLS; c++) b[p] -= m[p][c] * b[c];
        b[p] /= m[p][p];
    }
}

/* What a slab, isotropic, of this albedo, sends back straight up, and straight on, when a lamp of colour 1 (irradiance pi) shines straight down on it. The source S obeys
 * S(x) = albedo/4 exp(-x) + albedo/2 int E1(|x - t|) S(t) dt; it is even within each cell, asked in the middle of each. */
static inline void slab_radiance(double depth, double albedo, double *back, double *on) {
    double(*m)[SLAB_CELLS] = malloc(sizeof(double[SLAB_CELLS][SLAB_CELLS])), source[SLAB_CELLS];
    for (int i = 0; i < SLAB_CELLS; i++) {
        double x = (slab_wall(depth, i) + slab_wall(depth, i + 1)) / 2;
        for (int j = 0; j < SLAB_CELLS; j++) {
            double a = slab_wall(depth, j) - x, b = slab_wall(depth, j + 1) - x;
            /* the integral of E1 from 0 to d is 1 - E2(d) */
            m[i][j] = -albedo / 2 * (copysign(1 - slab_e2(fabs(b)), b) - copysign(1 - slab_e2(fabs(a)), a)) + (i == j);
        }
        source[i] = albedo / 4 * exp(-x);
    }
    slab_solve(m, source);
    *back = *on = 0;
    for (int i = 0; i < SLAB_CELLS; i++) {
        double a = slab_wall(depth, i), b = slab_wall(depth, i + 1);
        *back += source[i] * (exp(-a) - exp(-b));
        *on += source[i] * (exp(b - depth) - exp(a - depth));
    }
    free(m);
}

#endif
