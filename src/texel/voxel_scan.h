/* Scanning a triangle by rows of parallel rays, so that a closed surface is met an even number of times. */
#ifndef VTS_TEXEL_VOXEL_SCAN_H
#define VTS_TEXEL_VOXEL_SCAN_H

#include "base/common.h"

/* An edge as a function of v, from its lower end, so that two triangles that share it agree. */
typedef struct ScanEdge {
    double u0, v0, slope;
} ScanEdge;

/* A triangle's outline: one edge from its lowest corner to its highest, two on the other side that meet at v = middle. */
typedef struct ScanOutline {
    ScanEdge whole, low, high;
    double lowest, middle, highest;
} ScanOutline;

static inline ScanEdge scan_edge(const double *a, const double *b, int u, int v) {
    return (ScanEdge){a[u], a[v], a[v] < b[v] ? (b[u] - a[u]) / (b[v] - a[v]) : 0};
}

static inline ScanOutline scan_outline(const double *a, const double *b, const double *c, int u, int v) {
    const double *swap;
    if (a[v] > b[v]) swap = a, a = b, b = swap;
    if (b[v] > c[v]) swap = b, b = c, c = swap;
    if (a[v] > b[v]) swap = a, a = b, b = swap;
    return (ScanOutline){
        scan_edge(a, c, u, v), scan_edge(a, b, u, v), scan_edge(b, c, u, v), a[v], b[v], c[v]};
}

/* Where the line v = at, lowest <= at < highest, meets the outline. */
static inline void scan_row(const ScanOutline *outline, double at, double *lo, double *hi) {
    const ScanEdge *e = at < outline->middle ? &outline->low : &outline->high, *w = &outline->whole;
    double x = e->u0 + (at - e->v0) * e->slope, y = w->u0 + (at - w->v0) * w->slope;
    *lo = double_min(x, y);
    *hi = double_max(x, y);
}

/* The least whole number that is not below x; |x| < 2³¹. */
static inline int scan_ceil(double x) {
    int whole = (int)x;
    return whole + ((double)whole < x);
}

#endif
