/* What the noises made of scattered points share: for noise_nodes.c and noise_nodes_forms.c (and what measures them) alone. */
#ifndef VTS_TAPE_NOISE_NODES_H
#define VTS_TAPE_NOISE_NODES_H

#include "base/random.h"
#include "base/vec.h"

typedef struct NodeCell {
    int64_t x, y, z;
} NodeCell;

static inline NodeCell node_cell_of(Vec3 p) {
    return (NodeCell){(int64_t)floor(p.x), (int64_t)floor(p.y), (int64_t)floor(p.z)};
}
static inline uint64_t node_cell_bits(NodeCell c, uint64_t kind) {
    return random_hash((uint64_t)c.x, (uint64_t)c.y, (uint64_t)c.z, kind);
}

/* The place that a node's bits say, in its cell; *last gets the bits that follow. */
static inline Vec3 node_place(NodeCell cell, uint64_t bits, uint64_t *last) {
    uint64_t x = random_mix(bits), y = random_mix(x), z = random_mix(y);
    *last = z;
    return vec3((double)cell.x + random_unit(x), (double)cell.y + random_unit(y),
                (double)cell.z + random_unit(z));
}

/* ---- Worley ---- */

enum { WORLEY_KIND = 0x776F726C, WORLEY_MOST_NODES = 9 /* in a cell */ };

/* 1 to 9 nodes a cell by Worley's Poisson distribution of mean 3 (no cell is empty): Σ 3ᵏ/k! e⁻³, scaled to those. */
static inline int worley_node_count(uint64_t cell_bits) {
    static const double below[WORLEY_MOST_NODES - 1] = {0.15737, 0.39342, 0.62948, 0.80652,
                                                        0.91274, 0.96586, 0.98862, 0.99715};
    double u = random_unit(cell_bits);
    int count = 1;
    while (count < WORLEY_MOST_NODES && u >= below[count - 1]) count++;
    return count;
}

static inline Vec3 worley_node(NodeCell cell, uint64_t cell_bits, int k) {
    uint64_t last;
    return node_place(cell, cell_bits + 3 * (uint64_t)k + 1, &last);
}

/* ---- sparse convolution ---- */

enum { SPARSE_KIND = 0x73706172 };

static inline Vec3 sparse_impulse(NodeCell cell, uint64_t cell_bits, int k, double *weight) {
    uint64_t last;
    Vec3 at = node_place(cell, cell_bits + 4 * (uint64_t)k + 1, &last);
    *weight = 2 * random_unit(random_mix(last)) - 1;
    return at;
}

/* The kernel, a raised cosine of radius 1, of the square of the distance below 1: Taylor's series of (1 + cos π√q)/2, to 10⁻¹⁶; and its
 * derivative by q, and half of the second. */
static inline double sparse_kernel_bent(double q, double *slope, double *bend) {
    static const double terms[] = {1,
                                   -2.4674011002723395,
                                   2.0293560632083842,
                                   -0.66763138442729475,
                                   0.1176653151794466,
                                   -0.012903445695007031,
                                   0.00096478715470196157,
                                   -5.2319052462422852e-05,
                                   2.1515347935164736e-06,
                                   -6.9394762311068857e-08,
                                   1.8023653987312506e-09,
                                   -3.8503535653006769e-11,
                                   6.8843236401887069e-13,
                                   -1.0453161676573842e-14,
                                   1.3646636307990981e-16,
                                   -1.5481253076484324e-18,
                                   1.540260519133547e-20};
    enum { LAST = sizeof terms / sizeof *terms - 1 };
    double value = terms[LAST], first = 0, second = 0;
#pragma GCC unroll 32
    for (int k = LAST; k-- > 0;) {
        second = second * q + first;
        first = first * q + value;
        value = value * q + terms[k];
    }
    *slope = first, *bend = second;
    return value;
}

/* Without the second derivative. */
static inline double sparse_kernel(double q, double *slope) {
    double bend;
    return sparse_kernel_bent(q, slope, &bend);
}

/* No derivative of the kernel along a line is larger: π/2 the first, π²/2 the second, which jumps by as much at the kernel's border, and within it
 * π³/2 the third. That is π³/2·(sin u·c³ + 3g·c(1 - c²)), u = πr, c the cosine between line and radius, g = (sin u - u·cos u)/u² below 0.437: at
 * c = 1 it is sin u; elsewhere its largest is 2g·c, below 0.88. */
#define SPARSE_STEEPEST  1.5707963267948968
#define SPARSE_CURVATURE 4.9348022005446799
#define SPARSE_THIRD     15.503138340149911
/* The largest sum of kernels about one place with an impulse where it counts most in each cell around: 8, at a corner of cells. */
#define SPARSE_MOST 8.01

#endif
