/* Noises made of scattered points along short pieces of lines. */
#include "tape/noise_nodes_forms.h"

#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/node_cache.h"

enum { MOST_PIECES = 8, MOST_CELLS = 64, MOST_POINTS = 640 };

/* Pieces together if they lie within so much of each axis; all points within a unit of them are known then. */
static const double MOST_SPAN = 1;
/* So near places of points are rounded by no more than SLACK. */
static const double FAR = 0x1p30, SLACK = 0x1p-20;

typedef struct Piece {
    Vec3 centre, way;   /* the places are centre + s·way, */
    double length, off; /* off by so much at most */
    bool known;         /* near and short enough for points to be gathered */
} Piece;

enum { TOGETHER = 8 };

/* Points, or nodes, which weigh nothing. */
typedef struct Points {
    double x[MOST_POINTS + TOGETHER], y[MOST_POINTS + TOGETHER], z[MOST_POINTS + TOGETHER], weight[MOST_POINTS + TOGETHER];
    int count;
} Points;

static Piece piece_of(const AffineForm *place, int count, int i) {
    const AffineForm x = place[i], y = place[count + i], z = place[2 * count + i];
    Piece p = {vec3(x.centre, y.centre, z.centre), vec3(x.slope, y.slope, z.slope), 0,
               x.error + y.error + z.error, true};
    p.length = vec3_length(p.way) * (1 + 0x1p-50);
    double size = fabs(x.centre) + fabs(y.centre) + fabs(z.centre) + p.length + 1;
    p.off += size * 0x1p-48;
    p.known = !x.nan && !y.nan && !z.nan && size < FAR && 2 * (p.length + p.off) < MOST_SPAN;
    return p;
}

static Box3 box_of(const Piece *p) {
    Vec3 half = vec3(fabs(p->way.x) + p->off, fabs(p->way.y) + p->off, fabs(p->way.z) + p->off);
    return (Box3){vec3_sub(p->centre, half), vec3_add(p->centre, half)};
}

static Box3 hull(Box3 a, Box3 b) {
    return (Box3){
        vec3(bound_min(a.min.x, b.min.x), bound_min(a.min.y, b.min.y), bound_min(a.min.z, b.min.z)),
        vec3(bound_max(a.max.x, b.max.x), bound_max(a.max.y, b.max.y), bound_max(a.max.z, b.max.z))};
}

static bool is_small(const Box3 *b) {
    return b->max.x - b->min.x < MOST_SPAN && b->max.y - b->min.y < MOST_SPAN &&
           b->max.z - b->min.z < MOST_SPAN;
}

/* How many pieces from the first one on can share their points; *box gets the box around them. */
static int group_of(const Piece *pieces, int count, Box3 *box) {
    int n = 1;
    *box = box_of(&pieces[0]);
    for (; n < count && pieces[n].known; n++) {
        Box3 more = hull(*box, box_of(&pieces[n]));
        if (!is_small(&more)) break;
        *box = more;
    }
    return n;
}

/* ---- the cells within a unit of a box ---- */

typedef struct NearCell {
    NodeCell cell;
    double square; /* of the distance from the box */
} NearCell;

enum { MOST_ASIDE = 4 };

/* Along an axis: the cells within a unit of [low, high], from *first on, and the squares of their distances. */
static int cells_aside(double low, double high, int64_t *first, double squares[MOST_ASIDE]) {
    double begin = floor(low - 1);
    int count = int_min((int)(floor(high + 1) - begin) + 1, MOST_ASIDE);
    *first = (int64_t)begin;
    for (int k = 0; k < count; k++) {
        double cell = begin + k, gap = bound_max(0, bound_max(cell - high, low - (cell + 1)));
        squares[k] = gap * gap;
    }
    return count;
}

static int cells_near(const Box3 *box, NearCell *out) {
    NodeCell first;
    double x[MOST_ASIDE], y[MOST_ASIDE], z[MOST_ASIDE];
    int nx = cells_aside(box->min.x, box->max.x, &first.x, x), ny = cells_aside(box->min.y, box->max.y, &first.y, y),
        nz = cells_aside(box->min.z, box->max.z, &first.z, z), count = 0;
    for (int i = 0; i < nx; i++)
        for (int j = 0; j < ny; j++)
            for (int k = 0; k < nz; k++) {
                double square = x[i] + y[j] + z[k];
                out[count] = (NearCell){{first.x + i, first.y + j, first.z + k}, square};
                count += square <= 1;
            }
    return count;
}

/* To a multiple of TOGETHER, with points that are near nothing. */
static void fill_up(Points *all) {
    int end = all->count;
    for (int i = end; i < end + TOGETHER; i++) all->x[i] = all->y[i] = all->z[i] = 0x1p40, all->weight[i] = 0;
}

static double beyond(double low, double high, double x) { return bound_max(0, bound_max(low - x, x - high)); }

/* Those that are no further from the box than `reach`. */
static void keep_near(Points *restrict all, const Box3 *box, double reach, Points *restrict near) {
    const Vec3 low = box->min, high = box->max;
    int count = 0;
    fill_up(all);
    for (int i = 0; i < all->count; i += TOGETHER) {
        double square[TOGETHER];
        for (int k = 0; k < TOGETHER; k++) {
            double x = beyond(low.x, high.x, all->x[i + k]), y = beyond(low.y, high.y, all->y[i + k]), z = beyond(low.z, high.z, all->z[i + k]);
            square[k] = x * x + y * y + z * z;
        }
        for (int k = 0; k < TOGETHER; k++) {
            near->x[count] = all->x[i + k], near->y[count] = all->y[i + k], near->z[count] = all->z[i + k];
            near->weight[count] = all->weight[i + k];
            count += square[k] <= reach * reach;
        }
    }
    near->count = count;
}

static void add_point(Points *all, Vec3 at, double weight) {
    int i = all->count;
    if (i == MOST_POINTS) return;
    all->x[i] = at.x, all->y[i] = at.y, all->z[i] = at.z, all->weight[i] = weight;
    all->count = i + 1;
}

/* ---- Worley ---- */

/* The least `count` numbers, in order; more is put in its place. */
static void keep_least(double *least, int count, double more) {
    int k = count - 1;
    if (!(more < least[k])) return;
    for (; k > 0 && more < least[k - 1]; k--) least[k] = least[k - 1];
    least[k] = more;
}

static void find_nodes(NodeCell cell, NodePoints *out) {
    uint64_t bits = node_cell_bits(cell, WORLEY_KIND);
    out->count = worley_node_count(bits);
    for (int k = 0; k < out->count; k++) out->points[k].at = worley_node(cell, bits, k);
}

static void add_nodes(Points *points, NodeCell cell, NodeCache *cells) {
    NodePoints own, *here = &own;
    bool known = false;
    if (cells) here = node_cache_at(cells, cell, WORLEY_KIND, &known);
    if (!known) find_nodes(cell, here);
    for (int k = 0; k < here->count; k++) add_point(points, here->points[k].at, 0);
}

/* The squares of the distances from the piece's centre to the nearest nodes, number 0 … last. */
static void nearest(const Points *restrict points, const Piece *p, int last, double *restrict squares) {
    double all[MOST_POINTS + TOGETHER];
    const Vec3 c = p->centre;
    for (int i = 0; i < points->count; i++) {
        double x = points->x[i] - c.x, y = points->y[i] - c.y, z = points->z[i] - c.z;
        all[i] = x * x + y * y + z * z;
    }
    for (int k = 0; k <= last; k++) squares[k] = HUGE_VAL;
    for (int i = 0; i < points->count; i++) keep_least(squares, last + 1, all[i]);
}

/* Of each piece all nodes that may be among the nearest up to `last` from any of its places, if they are less than a unit away: the
 * distance changes by no more than the way. */
static void gather_nodes(Points *near, const Piece *pieces, int count, const Box3 *box, int last, NodeCache *cache) {
    Points all;
    NearCell cells[MOST_CELLS + 1];
    int cell_count = cells_near(box, cells);
    double reach = 0, squares[WORLEY_NODES];
    all.count = 0;
    for (int c = 0; c < cell_count; c++)
        if (cells[c].square == 0) add_nodes(&all, cells[c].cell, cache);
    for (int i = 0; i < count; i++) {
        nearest(&all, &pieces[i], last, squares);
        reach = bound_max(reach, sqrt(squares[last]) + 2 * (pieces[i].length + pieces[i].off) + SLACK);
    }
    for (int c = 0; c < cell_count; c++)
        if (cells[c].square > 0 && cells[c].square <= reach * reach) add_nodes(&all, cells[c].cell, cache);
    keep_near(&all, box, bound_min(reach, 1), near);
}

enum { MOST_RIVALS = 10 };

/* Along a piece the square of the distance to a node is a linear function of s, and s²·|way|², which is the same for all nodes. */
typedef struct Rival {
    double middle, slope;
} Rival;

static double level_at(const Rival *rivals, int count, int index, double s) {
    double least[WORLEY_NODES];
    for (int k = 0; k <= index; k++) least[k] = HUGE_VAL;
    for (int i = 0; i < count; i++) keep_least(least, index + 1, rivals[i].middle + s * rivals[i].slope);
    return least[index];
}

/* The number-`index` least of linear functions on [-1, 1] as a chord, and how far below and above it gets; its corners are where two of
 * the functions cross. */
static AffineForm level_of(const Rival *rivals, int count, int index) {
    double left = level_at(rivals, count, index, -1), right = level_at(rivals, count, index, 1), below = 0,
           above = 0;
    double middle = (left + right) / 2, slope = (right - left) / 2;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < i; j++) {
            double steeper = rivals[i].slope - rivals[j].slope, higher = rivals[j].middle - rivals[i].middle;
            if (!(fabs(higher) < fabs(steeper))) continue;
            double s = higher / steeper, off = level_at(rivals, count, index, s) - (middle + s * slope);
            below = bound_min(below, off), above = bound_max(above, off);
        }
    return (AffineForm){middle + (below + above) / 2, slope, (above - below) / 2 + 0x1p-46, false};
}

/* √ between its chord and the tangent parallel to that. */
static AffineForm root_of(AffineForm a) {
    double radius = fabs(a.slope) + a.error, low = sqrt((a.centre - radius) * (1 - 0x1p-50)),
           high = sqrt((a.centre + radius) * (1 + 0x1p-50));
    double slope = 1 / (low + high), gap_ = (high - low) * (high - low) * slope / 4;
    return (AffineForm){slope * a.centre + low * high * slope + gap_ / 2, slope * a.slope,
                        slope * a.error + gap_ / 2 + 0x1p-46, false};
}

/* Of all nodes the squares of their distances from the piece's centre, and how these change along it. */
typedef struct Squares {
    double middle[MOST_POINTS + TOGETHER], slope[MOST_POINTS + TOGETHER];
    int count;
} Squares;

static void find_squares(const Points *restrict points, const Piece *p, Squares *restrict out) {
    const Vec3 c = p->centre, way = p->way;
    out->count = points->count;
    for (int i = 0; i < points->count; i++) {
        double x = c.x - points->x[i], y = c.y - points->y[i], z = c.z - points->z[i];
        out->middle[i] = x * x + y * y + z * z, out->slope[i] = 2 * (x * way.x + y * way.y + z * way.z);
    }
}

/* squares[k]: of the centre, to node number k; highest[k]: above all that this may be along the piece. */
static void find_least(const Squares *s, int last, double *restrict squares, double *restrict highest) {
    for (int k = 0; k <= last; k++) squares[k] = highest[k] = HUGE_VAL;
    for (int i = 0; i < s->count; i++) {
        keep_least(squares, last + 1, s->middle[i]);
        keep_least(highest, last + 1, s->middle[i] + fabs(s->slope[i]));
    }
}

static AffineForm along_nodes(const Squares *s, const Piece *p, int index, double highest) {
    Rival rivals[MOST_RIVALS];
    double square = p->length * p->length;
    int count = 0;
    for (int i = 0; i < s->count; i++) {
        if (s->middle[i] - fabs(s->slope[i]) > highest + 0x1p-40) continue;
        if (count == MOST_RIVALS) return affine_unknown(false);
        rivals[count++] = (Rival){s->middle[i], s->slope[i]};
    }
    AffineForm level = level_of(rivals, count, index);
    level.centre += square / 2, level.error += square / 2;
    if (!(level.centre - fabs(level.slope) - level.error > 0x1p-20)) return affine_unknown(false);
    return root_of(level);
}

static void worley_group(const Piece *pieces, int count, const Box3 *box, int last, AffineForm *out, int stride, NodeCache *cells) {
    Points points;
    Squares all;
    gather_nodes(&points, pieces, count, box, last, cells);
    for (int i = 0; i < count; i++) {
        const Piece *p = &pieces[i];
        double squares[WORLEY_NODES], highest[WORLEY_NODES], off = p->length + p->off;
        find_squares(&points, p, &all);
        find_least(&all, last, squares, highest);
        for (int k = 0; k <= last; k++) {
            double at = sqrt(squares[k]);
            AffineForm *form = &out[k * stride + i];
            /* Further away there may be nodes that were not gathered. */
            bool complete = at + 2 * off < 1 - SLACK;
            if (!(at < 1 - SLACK)) at = noise_worley(p->centre, k);
            *form = complete ? along_nodes(&all, p, k, highest[k]) : affine_unknown(false);
            form->error += p->off;
            *form = affine_within(*form, interval(bound_max(0, at - off), at + off));
        }
    }
}

void affine_worley(int count, const AffineForm *place, int last, AffineForm *out, NodeCache *cells) {
    Piece pieces[MOST_PIECES];
    for (int i = 0; i < count; i++) pieces[i] = piece_of(place, count, i);
    for (int i = 0, n = 1; i < count; i += n) {
        Box3 box;
        n = 1;
        if (pieces[i].known) {
            n = group_of(&pieces[i], count - i, &box);
            worley_group(&pieces[i], n, &box, last, &out[i], count, cells);
            continue;
        }
        const Interval range[3] = {affine_range(place[i]), affine_range(place[count + i]),
                                   affine_range(place[2 * count + i])};
        Interval spans[WORLEY_NODES];
        interval_worley_nearest(range, last, spans);
        for (int k = 0; k <= last; k++) out[k * count + i] = affine_of_interval(spans[k]);
    }
}

/* ---- sparse convolution ---- */

static void find_impulses(NodeCell cell, int impulses, NodePoints *out) {
    uint64_t bits = node_cell_bits(cell, SPARSE_KIND);
    out->count = impulses;
    for (int k = 0; k < impulses; k++) out->points[k].at = sparse_impulse(cell, bits, k, &out->points[k].weight);
}

static void add_impulses(Points *all, NodeCell cell, int impulses, NodeCache *cache) {
    NodePoints own, *here = &own;
    bool known = false;
    if (cache) here = node_cache_at(cache, cell, SPARSE_KIND + (uint32_t)impulses, &known);
    if (!known) find_impulses(cell, impulses, here);
    for (int k = 0; k < impulses; k++) add_point(all, here->points[k].at, here->points[k].weight);
}

static void gather_impulses(const Box3 *box, int impulses, NodeCache *cache, Points *near) {
    NearCell cells[MOST_CELLS + 1];
    Points all;
    int cell_count = cells_near(box, cells);
    all.count = 0;
    for (int c = 0; c < cell_count; c++) add_impulses(&all, cells[c].cell, impulses, cache);
    keep_near(&all, box, 1, near);
    fill_up(near);
}

/* Value, slope and curvature at the centre, and the bound of the third derivative for the rest. An impulse whose border lies on the piece
 * is beyond it off by no more than the jump of its second derivative makes of the way. Or value and slope, and the bound of
 * the second derivative. */
static AffineForm along_impulses(const Points *restrict near, const Piece *p, double root) {
    double value[TOGETHER] = {0}, slope[TOGETHER] = {0}, bend[TOGETHER] = {0}, weights[TOGETHER] = {0}, jumps[TOGETHER] = {0};
    double length = p->length, long_square = length * length, reach = (1 + length + p->off) * (1 + length + p->off);
    Vec3 centre = p->centre, way = p->way;
    for (int i = 0; i < near->count; i += TOGETHER) {
        const double *x = &near->x[i], *y = &near->y[i], *z = &near->z[i], *weight = &near->weight[i];
        for (int k = 0; k < TOGETHER; k++) {
            double dx = centre.x - x[k], dy = centre.y - y[k], dz = centre.z - z[k];
            double square = dx * dx + dy * dy + dz * dz, along = 2 * (dx * way.x + dy * way.y + dz * way.z);
            bool within = square < 1;
            double rise, curve, w = within ? weight[k] : 0, size = square < reach ? fabs(weight[k]) : 0, kernel = sparse_kernel_bent(within ? square : 1, &rise, &curve);
            double over = length - fabs(1 - sqrt(square));
            over = over > 0 ? over : 0;
            value[k] += w * kernel;
            slope[k] += w * (rise * along);
            bend[k] += w * (curve * (along * along) + rise * long_square);
            weights[k] += size;
            jumps[k] += size * (over * over);
        }
    }
    for (int k = 1; k < TOGETHER; k++)
        value[0] += value[k], slope[0] += slope[k], bend[0] += bend[k], weights[0] += weights[k], jumps[0] += jumps[k];
    double second = weights[0] * (SPARSE_CURVATURE / 2 * long_square), shift = bend[0] / 2;
    double third = fabs(shift) + weights[0] * (SPARSE_THIRD / 6 * long_square * length) + SPARSE_CURVATURE / 2 * jumps[0];
    if (third < second) value[0] += shift, second = third;
    double rest = second + weights[0] * (SPARSE_STEEPEST * p->off);
    return (AffineForm){value[0] / root, slope[0] / root, round_up((rest + 0x1p-44 * (weights[0] + 1)) / root), false};
}

void affine_sparse_convolution(int count, const AffineForm *place, int impulses, AffineForm *out, NodeCache *cells) {
    Piece pieces[MOST_PIECES];
    double root = sqrt(impulses);
    Interval whole = interval(-SPARSE_MOST * root, SPARSE_MOST * root);
    for (int i = 0; i < count; i++)
        pieces[i] = piece_of(place, count, i), pieces[i].known &= impulses <= SPARSE_FEW;
    for (int i = 0, n = 1; i < count; i += n) {
        Box3 box;
        Points points;
        n = 1;
        if (!pieces[i].known) {
            const Interval range[3] = {affine_range(place[i]), affine_range(place[count + i]),
                                       affine_range(place[2 * count + i])};
            /* As long as a cell's side: sums of each impulse's own bounds would tell little more than those of all noises, and slowly. */
            bool some_nan = range[0].nan || range[1].nan || range[2].nan;
            bool tells = some_nan || pieces[i].length < MOST_SPAN / 2 || !(pieces[i].length < FAR);
            out[i] = affine_of_interval(tells ? interval_sparse_convolution(range, impulses) : whole);
            continue;
        }
        n = group_of(&pieces[i], count - i, &box);
        gather_impulses(&box, impulses, cells, &points);
        for (int k = i; k < i + n; k++)
            out[k] = affine_within(along_impulses(&points, &pieces[k], root), whole);
    }
}
