/* Scanning a triangle by rows of parallel rays, so that a closed surface is met an even number of times. */
#ifndef VTS_TEXEL_VOXEL_SCAN_H
#define VTS_TEXEL_VOXEL_SCAN_H

#include "base/common.h"

/* An edge as a function of v, from its lower end, so that two triangles that share it agree. */
typedef struct ScanEdge {
    double v0, v1, u0, slope;
} ScanEdge;

static inline ScanEdge scan_edge(const double *a, const double *b, int u, int v) {
    if (a[v] > b[v]) {
        const double *swap = a;
        a = b;
        b = swap;
    }
    return (ScanEdge){a[v], b[v], a[u], a[v] < b[v] ? (b[u] - a[u]) / (b[v] - a[v]) : 0};
}

/* Where the line v = at meets the triangle's outline. */
static inline bool scan_outline(const ScanEdge edges[3], double at, double *lo, double *hi) {
    int crossings = 0;
    double x[3];
    for (int i = 0; i < 3; i++)
        if (edges[i].v0 <= at && at < edges[i].v1)
            x[crossings++] = edges[i].u0 + (at - edges[i].v0) * edges[i].slope;
    if (crossings != 2) return false;
    *lo = double_min(x[0], x[1]);
    *hi = double_max(x[0], x[1]);
    return true;
}

#endif
