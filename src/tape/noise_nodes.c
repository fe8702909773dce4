/* Noises made of points scattered in the cells of a lattice, one fixed set of points for each noise. */
#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/noise_nodes.h"

/* Whole numbers beyond 2⁵³ have no neighbours of their own: places that far are taken modulo 2⁵⁰, which keeps them exact. */
static double reduced(double a) { return fabs(a) < 0x1p50 ? a : fmod(a, 0x1p50); }

/* ---- Worley, A cellular texture basis function, SIGGRAPH 1996 ---- */

typedef struct Distances {
    double squares[WORLEY_NODES]; /* of the nearest nodes, nearest first */
    Vec3 ways[WORLEY_NODES];      /* from them */
} Distances;

static void insert(Distances *d, Vec3 way) {
    int k = WORLEY_NODES - 1;
    double square = vec3_length_squared(way);
    if (!(square < d->squares[k])) return;
    for (; k > 0 && square < d->squares[k - 1]; k--) d->squares[k] = d->squares[k - 1], d->ways[k] = d->ways[k - 1];
    d->squares[k] = square, d->ways[k] = way;
}

static void add_nodes(Distances *d, NodeCell cell, Vec3 p) {
    uint64_t bits = node_cell_bits(cell, WORLEY_KIND);
    int count = worley_node_count(bits);
    for (int k = 0; k < count; k++) insert(d, vec3_sub(p, worley_node(cell, bits, k)));
}

/* From a place `in` the unit cell to one `off` cells away, along an axis. */
static double gap(double in, int off) { return off > 0 ? off - in : off < 0 ? in - off - 1 : 0; }

/* Shell after shell of cells, until no node of the next can be among those that are wanted. */
static void find_nearest(Vec3 p, int last, Distances *out) {
    Distances d;
    for (int k = 0; k < WORLEY_NODES; k++) d.squares[k] = VTS_INFINITY, d.ways[k] = vec3(0, 0, 0);
    p = vec3(reduced(p.x), reduced(p.y), reduced(p.z));
    NodeCell home = node_cell_of(p);
    Vec3 in = vec3(p.x - floor(p.x), p.y - floor(p.y), p.z - floor(p.z));
    /* Places of nodes are rounded. */
    double slack = 0x1p-20 + 0x1p-48 * (fabs(p.x) + fabs(p.y) + fabs(p.z));
    double border = fmin(fmin(fmin(in.x, 1 - in.x), fmin(in.y, 1 - in.y)), fmin(in.z, 1 - in.z));
    for (int shell = 0;; shell++) {
        for (int x = -shell; x <= shell; x++)
            for (int y = -shell; y <= shell; y++) {
                bool face = x == -shell || x == shell || y == -shell || y == shell;
                double gx = gap(in.x, x), gy = gap(in.y, y);
                for (int z = -shell; z <= shell; z += face || shell == 0 ? 1 : 2 * shell) {
                    double gz = gap(in.z, z);
                    if (gx * gx + gy * gy + gz * gz > d.squares[last] + slack) continue;
                    add_nodes(&d, (NodeCell){home.x + x, home.y + y, home.z + z}, p);
                }
            }
        double nearest_beyond = border + shell;
        if (d.squares[last] <= nearest_beyond * nearest_beyond) break;
    }
    *out = d;
}

void noise_worley_nearest(Vec3 p, int last, double *out) {
    Distances d;
    bool finite = vec3_is_finite(p);
    last = int_clamp(last, 0, WORLEY_NODES - 1);
    if (finite) find_nearest(p, last, &d);
    for (int k = 0; k <= last; k++) out[k] = finite ? sqrt(d.squares[k]) : (double)NAN;
}

void noise_worley_gradients(Vec3 p, int last, Vec3 *out) {
    Distances d;
    bool finite = vec3_is_finite(p);
    last = int_clamp(last, 0, WORLEY_NODES - 1);
    if (finite) find_nearest(p, last, &d);
    for (int k = 0; k <= last; k++) {
        out[k] = vec3_splat(finite ? 0 : (double)NAN);
        if (finite && d.squares[k] > 0) out[k] = vec3_scale(d.ways[k], 1 / sqrt(d.squares[k]));
    }
}

double noise_worley(Vec3 p, int index) {
    double out[WORLEY_NODES];
    index = int_clamp(index, 0, WORLEY_NODES - 1);
    noise_worley_nearest(p, index, out);
    return out[index];
}

/* ---- over boxes ---- */

/* Places beyond are taken modulo a number, which tears boxes. */
static const double FAR = 0x1p49;

typedef struct Ball {
    Vec3 centre;
    double radius, rounding;
    bool nan, near;
} Ball;

/* The ball around a box. */
static Ball ball_around(const Interval box[3]) {
    Ball b = {.near = true};
    double centre[3], square = 0, size = 1;
    for (int k = 0; k < 3; k++) {
        b.nan |= box[k].nan || interval_has_infinity(box[k]);
        b.near &= fabs(box[k].low) < FAR && fabs(box[k].high) < FAR;
        centre[k] = box[k].low / 2 + box[k].high / 2;
        double half = round_up(bound_max(box[k].high - centre[k], centre[k] - box[k].low));
        square += half * half, size += fabs(centre[k]) + half;
    }
    b.centre = vec3(centre[0], centre[1], centre[2]);
    b.radius = sqrt(square) * (1 + 0x1p-50);
    b.rounding = size * 0x1p-48;
    return b;
}

/* A distance changes by no more than the way. No place of a cell is further from a node of it or of its 26 neighbours, which all have
 * one, than 2√3. */
void interval_worley_nearest(const Interval box[3], int last, Interval *out) {
    const double most = 3.4642;
    Ball b = ball_around(box);
    bool known = b.near && b.radius < most;
    double at[WORLEY_NODES] = {0}, off = b.radius + b.rounding;
    if (known) noise_worley_nearest(b.centre, last, at);
    for (int k = 0; k <= last; k++)
        out[k] = known ? (Interval){bound_max(0, at[k] - off), bound_min(most, at[k] + off), b.nan} : (Interval){0, most, b.nan};
}

Interval interval_worley(const Interval box[3], int index) {
    Interval out[WORLEY_NODES];
    index = int_clamp(index, 0, WORLEY_NODES - 1);
    interval_worley_nearest(box, index, out);
    return out[index];
}

/* ---- Lewis, Algorithms for solid noise synthesis, SIGGRAPH 1989 ---- */

static double kernel(double square) {
    double slope;
    return square < 1 ? sparse_kernel(square, &slope) : 0;
}

typedef struct Sum {
    double value;
    Vec3 gradient;
} Sum;

static void add_impulses(NodeCell cell, Vec3 p, int count, Sum *sum) {
    uint64_t bits = node_cell_bits(cell, SPARSE_KIND);
    double weight, slope;
    for (int k = 0; k < count; k++) {
        Vec3 way = vec3_sub(p, sparse_impulse(cell, bits, k, &weight));
        double square = vec3_length_squared(way);
        if (!(square < 1)) continue;
        sum->value += weight * sparse_kernel(square, &slope);
        sum->gradient = vec3_madd(sum->gradient, way, 2 * weight * slope);
    }
}

/* Cells beyond the impulses' radius hold nothing that counts. */
static Sum sum_impulses(Vec3 p, int count) {
    p = vec3(reduced(p.x), reduced(p.y), reduced(p.z));
    NodeCell home = node_cell_of(p);
    Vec3 in = vec3(p.x - floor(p.x), p.y - floor(p.y), p.z - floor(p.z));
    Sum sum = {0, {0, 0, 0}};
    for (int k = 0; k < 27; k++) {
        int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
        double gx = gap(in.x, x), gy = gap(in.y, y), gz = gap(in.z, z);
        if (gx * gx + gy * gy + gz * gz > 1 + 0x1p-20) continue;
        add_impulses((NodeCell){home.x + x, home.y + y, home.z + z}, p, count, &sum);
    }
    return sum;
}

double noise_sparse_convolution(Vec3 p, int count) {
    count = int_clamp(count, 1, SPARSE_IMPULSES);
    return vec3_is_finite(p) ? sum_impulses(p, count).value / sqrt(count) : (double)NAN;
}

Vec3 noise_sparse_gradient(Vec3 p, int count) {
    count = int_clamp(count, 1, SPARSE_IMPULSES);
    return vec3_is_finite(p) ? vec3_scale(sum_impulses(p, count).gradient, 1 / sqrt(count)) : vec3_splat((double)NAN);
}

/* Each impulse falls with the distance, which changes by no more than the way. */
static void add_spans(NodeCell cell, const Ball *b, int count, double *low, double *high) {
    uint64_t bits = node_cell_bits(cell, SPARSE_KIND);
    for (int k = 0; k < count; k++) {
        double weight;
        Vec3 at = sparse_impulse(cell, bits, k, &weight);
        double way = vec3_length(vec3_sub(at, b->centre)), off = b->radius + b->rounding;
        double near = bound_max(0, way - off), far = way + off;
        double most = kernel(near * near), least = kernel(far * far);
        *low += weight * (weight > 0 ? least : most), *high += weight * (weight > 0 ? most : least);
    }
}

static const double LONGEST_BOX = 0.9; /* half of its diagonal */

Interval interval_sparse_convolution(const Interval box[3], int count) {
    count = int_clamp(count, 1, SPARSE_IMPULSES);
    Ball b = ball_around(box);
    double whole = SPARSE_MOST * sqrt(count), low = 0, high = 0;
    /* Over larger boxes what each impulse may do adds up to more than all can. */
    if (!b.near || !(b.radius < LONGEST_BOX)) return (Interval){-whole, whole, b.nan};
    NodeCell first = node_cell_of(vec3(box[0].low - 1, box[1].low - 1, box[2].low - 1)),
             last = node_cell_of(vec3(box[0].high + 1, box[1].high + 1, box[2].high + 1));
    for (int64_t i = first.x; i <= last.x; i++)
        for (int64_t j = first.y; j <= last.y; j++)
            for (int64_t k = first.z; k <= last.z; k++)
                add_spans((NodeCell){i, j, k}, &b, count, &low, &high);
    double root = sqrt(count), slack = 0x1p-40 * root;
    return (Interval){bound_max(low / root - slack, -whole), bound_min(high / root + slack, whole), b.nan};
}
