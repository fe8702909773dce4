/* Noises made of scattered points along short pieces of lines. */
#include "tape/noise_nodes_forms.h"

#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/noise_nodes.h"

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

typedef struct Points {
    Vec3 at[MOST_POINTS];
    double weight[MOST_POINTS];
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

static double gap(double low, double high, int64_t cell) {
    double a = (double)cell - high, b = low - ((double)cell + 1);
    return bound_max(0, bound_max(a, b));
}

static int cells_near(const Box3 *box, NearCell *out) {
    NodeCell first = node_cell_of(vec3(box->min.x - 1, box->min.y - 1, box->min.z - 1));
    NodeCell last = node_cell_of(vec3(box->max.x + 1, box->max.y + 1, box->max.z + 1));
    int count = 0;
    for (int64_t x = first.x; x <= last.x; x++)
        for (int64_t y = first.y; y <= last.y; y++)
            for (int64_t z = first.z; z <= last.z; z++) {
                double gx = gap(box->min.x, box->max.x, x), gy = gap(box->min.y, box->max.y, y),
                       gz = gap(box->min.z, box->max.z, z);
                double square = gx * gx + gy * gy + gz * gz;
                if (square <= 1 && count < MOST_CELLS) out[count++] = (NearCell){{x, y, z}, square};
            }
    return count;
}

/* ---- Worley ---- */

/* The least `count` numbers, in order; more is put in its place. */
static void keep_least(double *least, int count, double more) {
    int k = count - 1;
    if (!(more < least[k])) return;
    for (; k > 0 && more < least[k - 1]; k--) least[k] = least[k - 1];
    least[k] = more;
}

static void add_nodes(Points *points, NodeCell cell) {
    uint64_t bits = node_cell_bits(cell, WORLEY_KIND);
    int count = worley_node_count(bits);
    for (int k = 0; k < count && points->count < MOST_POINTS; k++)
        points->at[points->count++] = worley_node(cell, bits, k);
}

/* The squares of the distances from the piece's centre to all nodes, and to the nearest ones, number 0 … last. */
static void nearest(const Points *points, const Piece *p, int last, double *restrict all, double *restrict squares) {
    for (int i = 0; i < points->count; i++) all[i] = vec3_length_squared(vec3_sub(points->at[i], p->centre));
    for (int k = 0; k <= last; k++) squares[k] = HUGE_VAL;
    for (int i = 0; i < points->count; i++) keep_least(squares, last + 1, all[i]);
}

/* Of all nodes those that may be among the nearest from a place of the piece: distances change by no more than the way. */
static void keep_near(const Points *points, const double *all, double far, Points *near) {
    near->count = 0;
    for (int i = 0; i < points->count; i++)
        if (all[i] <= far * far) near->at[near->count++] = points->at[i];
}

/* Of each piece all nodes that may be among the nearest up to `last` from any of its places, if they are less than a unit away: the
 * distance changes by no more than the way. */
static void gather_nodes(Points *points, const Piece *pieces, int count, const Box3 *box, int last) {
    NearCell cells[MOST_CELLS];
    int cell_count = cells_near(box, cells);
    double reach = 0, squares[WORLEY_NODES], all[MOST_POINTS];
    points->count = 0;
    for (int c = 0; c < cell_count; c++)
        if (cells[c].square == 0) add_nodes(points, cells[c].cell);
    for (int i = 0; i < count; i++) {
        nearest(points, &pieces[i], last, all, squares);
        reach = bound_max(reach, sqrt(squares[last]) + 2 * (pieces[i].length + pieces[i].off) + SLACK);
    }
    for (int c = 0; c < cell_count; c++)
        if (cells[c].square > 0 && cells[c].square <= reach * reach) add_nodes(points, cells[c].cell);
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

static AffineForm along_nodes(const Points *points, const Piece *p, int index) {
    Rival rivals[MOST_RIVALS];
    double highest[WORLEY_NODES], square = p->length * p->length;
    int count = 0;
    for (int k = 0; k <= index; k++) highest[k] = HUGE_VAL;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < points->count; i++) {
            Vec3 to = vec3_sub(p->centre, points->at[i]);
            Rival r = {vec3_length_squared(to), 2 * vec3_dot(to, p->way)};
            if (pass == 0)
                keep_least(highest, index + 1, r.middle + fabs(r.slope));
            else if (r.middle - fabs(r.slope) <= highest[index] + 0x1p-40) {
                if (count == MOST_RIVALS) return affine_unknown(false);
                rivals[count++] = r;
            }
        }
    AffineForm level = level_of(rivals, count, index);
    level.centre += square / 2, level.error += square / 2;
    if (!(level.centre - fabs(level.slope) - level.error > 0x1p-20)) return affine_unknown(false);
    return root_of(level);
}

static void worley_group(const Piece *pieces, int count, const Box3 *box, int last, AffineForm *out,
                         int stride) {
    Points points, near;
    double all[MOST_POINTS];
    gather_nodes(&points, pieces, count, box, last);
    for (int i = 0; i < count; i++) {
        const Piece *p = &pieces[i];
        double squares[WORLEY_NODES], off = p->length + p->off;
        nearest(&points, p, last, all, squares);
        keep_near(&points, all, sqrt(squares[last]) + 2 * off + SLACK, &near);
        for (int k = 0; k <= last; k++) {
            double at = sqrt(squares[k]);
            AffineForm *form = &out[k * stride + i];
            bool complete = at + 2 * off < 1 - SLACK;
            if (!complete) at = noise_worley(p->centre, k);
            *form = complete ? along_nodes(&near, p, k) : affine_unknown(false);
            form->error += p->off;
            *form = affine_within(*form, interval(bound_max(0, at - off), at + off));
        }
    }
}

void affine_worley(int count, const AffineForm *place, int last, AffineForm *out) {
    Piece pieces[MOST_PIECES];
    for (int i = 0; i < count; i++) pieces[i] = piece_of(place, count, i);
    for (int i = 0, n = 1; i < count; i += n) {
        Box3 box;
        n = 1;
        if (pieces[i].known) {
            n = group_of(&pieces[i], count - i, &box);
            worley_group(&pieces[i], n, &box, last, &out[i], count);
            continue;
        }
        const Interval range[3] = {affine_range(place[i]), affine_range(place[count + i]),
                                   affine_range(place[2 * count + i])};
        for (int k = 0; k <= last; k++) out[k * count + i] = affine_of_interval(interval_worley(range, k));
    }
}

/* ---- sparse convolution ---- */

static void gather_impulses(Points *points, const Box3 *box, int impulses) {
    NearCell cells[MOST_CELLS];
    int cell_count = cells_near(box, cells);
    points->count = 0;
    for (int c = 0; c < cell_count; c++) {
        uint64_t bits = node_cell_bits(cells[c].cell, SPARSE_KIND);
        for (int k = 0; k < impulses; k++) {
            double weight;
            Vec3 at = sparse_impulse(cells[c].cell, bits, k, &weight);
            Vec3 out = vec3(bound_max(bound_max(box->min.x - at.x, at.x - box->max.x), 0),
                            bound_max(bound_max(box->min.y - at.y, at.y - box->max.y), 0),
                            bound_max(bound_max(box->min.z - at.z, at.z - box->max.z), 0));
            if (vec3_length_squared(out) > 1 || points->count == MOST_POINTS) continue;
            points->at[points->count] = at, points->weight[points->count++] = weight;
        }
    }
}

enum { TOGETHER = 8 };

/* Impulses that count at a place: squares of their distances, weights, and the slopes of those squares. */
typedef struct Impulses {
    double square[MOST_POINTS + TOGETHER], weight[MOST_POINTS + TOGETHER], along[MOST_POINTS + TOGETHER];
    int count;
} Impulses;

/* Returns the weights of all that count anywhere on the piece. */
static double find_near(const Points *points, const Piece *p, Impulses *near) {
    double reach = 1 + p->length + p->off, weights = 0;
    int count = 0;
    for (int i = 0; i < points->count; i++) {
        Vec3 to = vec3_sub(p->centre, points->at[i]);
        double square = vec3_length_squared(to), w = points->weight[i];
        weights += square < reach * reach ? fabs(w) : 0;
        near->square[count] = square, near->weight[count] = w, near->along[count] = 2 * vec3_dot(to, p->way);
        count += square < 1;
    }
    near->count = count;
    for (int i = count; i < count + TOGETHER; i++) near->square[i] = near->weight[i] = near->along[i] = 0;
    return weights;
}

/* Value and slope at the centre, and the bound of the second derivative for the rest: the kernel's first derivative has no jumps. */
static AffineForm along_impulses(const Points *points, const Piece *p, double root) {
    Impulses near;
    double weights = find_near(points, p, &near), value = 0, slope = 0, size = 0;
    for (int i = 0; i < near.count; i += TOGETHER) {
        const double *square = &near.square[i], *weight = &near.weight[i], *along = &near.along[i];
        double values[TOGETHER], slopes[TOGETHER];
        for (int k = 0; k < TOGETHER; k++) {
            double rise;
            values[k] = weight[k] * sparse_kernel(square[k], &rise);
            slopes[k] = weight[k] * rise * along[k];
        }
        for (int k = 0; k < TOGETHER; k++) value += values[k], slope += slopes[k], size += fabs(weight[k]);
    }
    double rest = weights * (SPARSE_CURVATURE / 2 * p->length * p->length + SPARSE_STEEPEST * p->off);
    return (AffineForm){value / root, slope / root, round_up((rest + 0x1p-44 * (size + 1)) / root), false};
}

void affine_sparse_convolution(int count, const AffineForm *place, int impulses, AffineForm *out) {
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
        gather_impulses(&points, &box, impulses);
        for (int k = i; k < i + n; k++)
            out[k] = affine_within(along_impulses(&points, &pieces[k], root), whole);
    }
}
