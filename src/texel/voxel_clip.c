#include "texel/voxel_clip.h"

#include <math.h>

static void add_vertex(ClipPolygon *p, const double v[3]) {
    if (p->count == CLIP_VERTICES) return; /* rounding only: a triangle cut by six planes has at most nine */
    for (int i = 0; i < 3; i++) p->at[p->count][i] = v[i];
    p->count++;
}

/* The parts of `p` on both sides of the plane x[axis] = at. */
static void split(const ClipPolygon *p, int axis, double at, ClipPolygon *below, ClipPolygon *above) {
    below->count = above->count = 0;
    for (int i = 0; i < p->count; i++) {
        const double *a = p->at[i], *b = p->at[i + 1 == p->count ? 0 : i + 1];
        if (a[axis] <= at) add_vertex(below, a);
        if (a[axis] >= at) add_vertex(above, a);
        if ((a[axis] < at) == (b[axis] < at) || a[axis] == at || b[axis] == at) continue;
        double t = (at - a[axis]) / (b[axis] - a[axis]), v[3];
        for (int k = 0; k < 3; k++) v[k] = a[k] + t * (b[k] - a[k]);
        v[axis] = at;
        add_vertex(below, v);
        add_vertex(above, v);
    }
}

static void range(const ClipPolygon *p, int axis, double *lo, double *hi) {
    *lo = *hi = p->at[0][axis];
    for (int i = 1; i < p->count; i++) {
        *lo = double_min(*lo, p->at[i][axis]);
        *hi = double_max(*hi, p->at[i][axis]);
    }
}

/* Cuts along `axis` and passes each slab on to the next axis. */
static void cut_axis(const ClipPolygon *polygon, int axis, int cell[3], const int size[3], ClipPiece *piece,
                     void *context) {
    if (axis == 3) {
        piece(context, cell, polygon);
        return;
    }
    double lo, hi;
    range(polygon, axis, &lo, &hi);
    if (!(hi >= 0 && lo <= size[axis])) return;
    ClipPolygon parts[2], slab;
    const ClipPolygon *rest = polygon;
    int next = 0;
    if (lo < 0) {
        split(rest, axis, 0, &slab, &parts[next]);
        rest = &parts[next];
        next = 1;
        lo = 0;
    }
    /* What lies in the very last plane belongs to the last cell. */
    for (int i = int_min((int)lo, size[axis] - 1); i < size[axis] && rest->count >= 3; i++) {
        cell[axis] = i;
        if (hi <= i + 1) {
            cut_axis(rest, axis + 1, cell, size, piece, context);
            return;
        }
        split(rest, axis, i + 1, &slab, &parts[next]);
        rest = &parts[next];
        next = 1 - next;
        if (slab.count >= 3) cut_axis(&slab, axis + 1, cell, size, piece, context);
    }
}

void clip_to_cells(const ClipPolygon *polygon, const int size[3], ClipPiece *piece, void *context) {
    int cell[3] = {0, 0, 0};
    cut_axis(polygon, 0, cell, size, piece, context);
}

double clip_projected_area(const ClipPolygon *p, int axis) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double sum = 0;
    for (int i = 2; i < p->count; i++)
        sum += (p->at[i - 1][u] - p->at[0][u]) * (p->at[i][v] - p->at[0][v]) -
               (p->at[i][u] - p->at[0][u]) * (p->at[i - 1][v] - p->at[0][v]);
    return sum;
}
