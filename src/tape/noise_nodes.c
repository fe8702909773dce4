/* Noises made of points scattered in the cells of a lattice, one fixed set of points for each noise. */
#include "tape/noise.h"
#include "tape/noise_interval.h"

#include "base/random.h"

typedef struct Cell {
    int64_t x, y, z;
} Cell;

/* Whole numbers beyond 2⁵³ have no neighbours of their own: places that far are taken modulo 2⁵⁰, which keeps them exact. */
static double reduced(double a) { return fabs(a) < 0x1p50 ? a : fmod(a, 0x1p50); }

static Cell cell_of(Vec3 p) { return (Cell){(int64_t)floor(p.x), (int64_t)floor(p.y), (int64_t)floor(p.z)}; }

static uint64_t cell_bits(Cell c, uint64_t kind) {
    return random_hash((uint64_t)c.x, (uint64_t)c.y, (uint64_t)c.z, kind);
}

/* ---- Worley, A cellular texture basis function, SIGGRAPH 1996 ---- */

enum { WORLEY = 0x776F726C, MOST_NODES = 9 };

/* 1 to 9 nodes a cell by the paper's Poisson distribution of mean 3 (no cell is empty): Σ 3ᵏ/k! e⁻³, scaled to those. */
static int node_count(double u) {
    static const double below[MOST_NODES - 1] = {0.15737, 0.39342, 0.62948, 0.80652,
                                                 0.91274, 0.96586, 0.98862, 0.99715};
    int count = 1;
    while (count < MOST_NODES && u >= below[count - 1]) count++;
    return count;
}

typedef struct Distances {
    double squares[WORLEY_NODES]; /* of the nearest nodes, nearest first */
} Distances;

static void insert(Distances *d, double square) {
    int k = WORLEY_NODES - 1;
    if (!(square < d->squares[k])) return;
    for (; k > 0 && square < d->squares[k - 1]; k--) d->squares[k] = d->squares[k - 1];
    d->squares[k] = square;
}

static void add_nodes(Distances *d, Cell cell, Vec3 p) {
    uint64_t bits = cell_bits(cell, WORLEY);
    int count = node_count(random_unit(bits));
    for (int k = 0; k < count; k++) {
        uint64_t x = random_mix(bits + 3 * (uint64_t)k + 1), y = random_mix(x), z = random_mix(y);
        Vec3 node = vec3((double)cell.x + random_unit(x), (double)cell.y + random_unit(y),
                         (double)cell.z + random_unit(z));
        insert(d, vec3_length_squared(vec3_sub(node, p)));
    }
}

/* Shell after shell of cells, until no node of the next can be among those that are wanted. */
double noise_worley(Vec3 p, int index) {
    if (!vec3_is_finite(p)) return (double)NAN;
    p = vec3(reduced(p.x), reduced(p.y), reduced(p.z));
    Cell home = cell_of(p);
    index = int_clamp(index, 0, WORLEY_NODES - 1);
    Distances d;
    for (int k = 0; k < WORLEY_NODES; k++) d.squares[k] = VTS_INFINITY;
    Vec3 in = vec3(p.x - floor(p.x), p.y - floor(p.y), p.z - floor(p.z));
    double border = fmin(fmin(fmin(in.x, 1 - in.x), fmin(in.y, 1 - in.y)), fmin(in.z, 1 - in.z));
    for (int shell = 0;; shell++) {
        for (int x = -shell; x <= shell; x++)
            for (int y = -shell; y <= shell; y++) {
                bool face = x == -shell || x == shell || y == -shell || y == shell;
                for (int z = -shell; z <= shell; z += face || shell == 0 ? 1 : 2 * shell)
                    add_nodes(&d, (Cell){home.x + x, home.y + y, home.z + z}, p);
            }
        double nearest_beyond = border + shell;
        if (d.squares[index] <= nearest_beyond * nearest_beyond) return sqrt(d.squares[index]);
    }
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
Interval interval_worley(const Interval box[3], int index) {
    const double most = 3.4642;
    Ball b = ball_around(box);
    if (!b.near || !(b.radius < most)) return (Interval){0, most, b.nan};
    double at = noise_worley(b.centre, index), off = b.radius + b.rounding;
    return (Interval){bound_max(0, at - off), bound_min(most, at + off), b.nan};
}

/* ---- Lewis, Algorithms for solid noise synthesis, SIGGRAPH 1989 ---- */

enum { SPARSE = 0x73706172 };

/* The kernel: a raised cosine of radius 1. */
static double kernel(double square) { return square < 1 ? (1 + cos(VTS_PI * sqrt(square))) / 2 : 0; }

static double impulses(Cell cell, Vec3 p, int count) {
    uint64_t bits = cell_bits(cell, SPARSE);
    double sum = 0;
    for (int k = 0; k < count; k++) {
        uint64_t x = random_mix(bits + 4 * (uint64_t)k + 1), y = random_mix(x), z = random_mix(y);
        Vec3 at = vec3((double)cell.x + random_unit(x), (double)cell.y + random_unit(y),
                       (double)cell.z + random_unit(z));
        double weight = 2 * random_unit(random_mix(z)) - 1;
        sum += weight * kernel(vec3_length_squared(vec3_sub(at, p)));
    }
    return sum;
}

double noise_sparse_convolution(Vec3 p, int count) {
    if (!vec3_is_finite(p)) return (double)NAN;
    p = vec3(reduced(p.x), reduced(p.y), reduced(p.z));
    Cell home = cell_of(p);
    count = int_clamp(count, 1, SPARSE_IMPULSES);
    double sum = 0;
    for (int k = 0; k < 27; k++)
        sum += impulses((Cell){home.x + k % 3 - 1, home.y + k / 3 % 3 - 1, home.z + k / 9 - 1}, p, count);
    return sum / sqrt(count);
}

/* Each impulse falls with the distance, which changes by no more than the way. */
static void add_spans(Cell cell, const Ball *b, int count, double *low, double *high) {
    uint64_t bits = cell_bits(cell, SPARSE);
    for (int k = 0; k < count; k++) {
        uint64_t x = random_mix(bits + 4 * (uint64_t)k + 1), y = random_mix(x), z = random_mix(y);
        Vec3 at = vec3((double)cell.x + random_unit(x), (double)cell.y + random_unit(y), (double)cell.z + random_unit(z));
        double weight = 2 * random_unit(random_mix(z)) - 1, way = vec3_length(vec3_sub(at, b->centre)), off = b->radius + b->rounding;
        double near = bound_max(0, way - off), far = way + off;
        double most = kernel(near * near), least = kernel(far * far);
        *low += weight * (weight > 0 ? least : most), *high += weight * (weight > 0 ? most : least);
    }
}

Interval interval_sparse_convolution(const Interval box[3], int count) {
    enum { MOST_CELLS = 125 };
    count = int_clamp(count, 1, SPARSE_IMPULSES);
    Ball b = ball_around(box);
    double whole = 27 * sqrt(count), low = 0, high = 0;
    if (!b.near) return (Interval){-whole, whole, b.nan};
    Cell first = cell_of(vec3(box[0].low - 1, box[1].low - 1, box[2].low - 1)), last = cell_of(vec3(box[0].high + 1, box[1].high + 1, box[2].high + 1));
    double cells = (double)(last.x - first.x + 1) * (double)(last.y - first.y + 1) * (double)(last.z - first.z + 1);
    if (!(cells <= MOST_CELLS)) return (Interval){-whole, whole, b.nan};
    for (int64_t i = first.x; i <= last.x; i++)
        for (int64_t j = first.y; j <= last.y; j++)
            for (int64_t k = first.z; k <= last.z; k++) add_spans((Cell){i, j, k}, &b, count, &low, &high);
    double root = sqrt(count), slack = 0x1p-40 * root;
    return (Interval){low / root - slack, high / root + slack, b.nan};
}
