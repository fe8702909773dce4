/* sphere_sweep: what a sphere passes through while its centre and its radius run along splines. */
#include "shape/outline.h"
#include "shape/roots.h"
#include "shape/solid.h"

#include <stdlib.h>

typedef struct SweepPiece {
    double x[4], y[4], z[4], r[4]; /* of s in [0, 1] */
    Box3 bounds;
} SweepPiece;

typedef struct Sweep {
    SweepPiece *pieces;
    size_t count;
    Box3 bounds;
    Arena *arena;
} Sweep;

static Vec3 center_at(const SweepPiece *piece, double s) {
    return vec3(roots_value(piece->x, 3, s), roots_value(piece->y, 3, s), roots_value(piece->z, 3, s));
}

/* Of a polynomial over [0, 1], by its values at the ends and where its slope vanishes. */
static void range_of(const double c[4], double *lo, double *hi) {
    double places[4] = {0, 1}, slope[3] = {c[1], 2 * c[2], 3 * c[3]};
    int count = 2 + roots_in(slope, 2, 0, 1, places + 2);
    *lo = VTS_INFINITY, *hi = -VTS_INFINITY;
    for (int i = 0; i < count; i++) {
        double v = roots_value(c, 3, places[i]);
        *lo = double_min(*lo, v), *hi = double_max(*hi, v);
    }
}

static Box3 piece_bounds(const SweepPiece *piece) {
    Box3 box;
    double lo, hi;
    range_of(piece->x, &box.min.x, &box.max.x);
    range_of(piece->y, &box.min.y, &box.max.y);
    range_of(piece->z, &box.min.z, &box.max.z);
    range_of(piece->r, &lo, &hi);
    Vec3 r = vec3_splat(double_max(fabs(lo), fabs(hi)));
    return (Box3){vec3_sub(box.min, r), vec3_add(box.max, r)};
}

static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    CurveKind curve = s->as.sweep.curve;
    size_t first = curve == CURVE_LINEAR ? 0 : 1, from = curve == CURVE_LINEAR ? 2 : 3, n = s->as.sweep.count;
    Sweep *sweep = arena_new(arena, Sweep);
    sweep->pieces = arena_new_array(arena, SweepPiece, n);
    sweep->bounds = box3_empty();
    for (size_t i = first; i + from <= n; i++) {
        SweepSphere p[4];
        for (size_t k = 0; k < 4; k++) p[k] = s->as.sweep.spheres[size_min(i + k - (i + k > 0), n - 1)];
        SweepPiece *piece = &sweep->pieces[sweep->count++];
        outline_coefficients(curve, (double[]){p[0].center.x, p[1].center.x, p[2].center.x, p[3].center.x},
                             piece->x);
        outline_coefficients(curve, (double[]){p[0].center.y, p[1].center.y, p[2].center.y, p[3].center.y},
                             piece->y);
        outline_coefficients(curve, (double[]){p[0].center.z, p[1].center.z, p[2].center.z, p[3].center.z},
                             piece->z);
        outline_coefficients(curve, (double[]){p[0].radius, p[1].radius, p[2].radius, p[3].radius}, piece->r);
        piece->bounds = piece_bounds(piece);
        sweep->bounds = box3_union(sweep->bounds, piece->bounds);
    }
    return sweep->count ? sweep : NULL;
}

/* A stretch of the line within the sweep. */
typedef struct Stretch {
    double in, out, s_in, s_out;
    uint32_t piece_in, piece_out;
} Stretch;

enum { FEW_STRETCHES = 32 };
typedef struct StretchList {
    Stretch *items;
    size_t count, capacity;
} StretchList;

/* The sphere at s holds the line from -b - √D to -b + √D, b of degree 3 in s and D of degree 6. */
typedef struct LineOfPiece {
    double b[4], d[7];
} LineOfPiece;

static LineOfPiece line_of_piece(const SweepPiece *piece, Vec3 o, Vec3 dir) {
    LineOfPiece line;
    double x[4], y[4], z[4], square[7];
    for (int i = 0; i < 4; i++) {
        x[i] = (i == 0 ? o.x : 0) - piece->x[i];
        y[i] = (i == 0 ? o.y : 0) - piece->y[i];
        z[i] = (i == 0 ? o.z : 0) - piece->z[i];
        line.b[i] = x[i] * dir.x + y[i] * dir.y + z[i] * dir.z;
    }
    /* r² less the squared distance of the centre from the line, as sums of squares of what is across: no cancellation. */
    double across[3][4];
    for (int i = 0; i < 4; i++) {
        across[0][i] = x[i] - line.b[i] * dir.x;
        across[1][i] = y[i] - line.b[i] * dir.y;
        across[2][i] = z[i] - line.b[i] * dir.z;
    }
    roots_multiply(piece->r, 3, piece->r, 3, line.d);
    for (int axis = 0; axis < 3; axis++) {
        roots_multiply(across[axis], 3, across[axis], 3, square);
        for (int i = 0; i < 7; i++) line.d[i] -= square[i];
    }
    return line;
}

static double end_at(const LineOfPiece *line, double s, int side) {
    return -roots_value(line->b, 3, s) + side * sqrt(double_max(roots_value(line->d, 6, s), 0));
}

/* Both ends move with s; the stretch of connected spheres reaches as far as the furthest of each. Where an end rests,
 * 4 D b'² = D'². */
static void add_stretch(Sweep *sweep, StretchList *list, const LineOfPiece *line, uint32_t piece, double a,
                        double b) {
    double places[16] = {a, b}, db[3], dd[6], square[5], polynomial[11], other[11];
    for (int i = 0; i < 3; i++) db[i] = line->b[i + 1] * (i + 1);
    for (int i = 0; i < 6; i++) dd[i] = line->d[i + 1] * (i + 1);
    roots_multiply(db, 2, db, 2, square);
    roots_multiply(square, 4, line->d, 6, polynomial);
    roots_multiply(dd, 5, dd, 5, other);
    for (int i = 0; i < 11; i++) polynomial[i] = 4 * polynomial[i] - other[i];
    int count = 2 + roots_in(polynomial, 10, a, b, places + 2);
    Stretch stretch = {VTS_INFINITY, -VTS_INFINITY, a, a, piece, piece};
    for (int i = 0; i < count; i++) {
        double in = end_at(line, places[i], -1), out = end_at(line, places[i], 1);
        if (in < stretch.in) stretch.in = in, stretch.s_in = places[i];
        if (out > stretch.out) stretch.out = out, stretch.s_out = places[i];
    }
    *list_push(sweep->arena, list) = stretch;
}

static void piece_stretches(Sweep *sweep, StretchList *list, uint32_t index, Vec3 o, Vec3 d) {
    LineOfPiece line = line_of_piece(&sweep->pieces[index], o, d);
    double places[8] = {0};
    int count = 1 + roots_in(line.d, 6, 0, 1, places + 1);
    places[count++] = 1;
    for (int i = 0; i + 1 < count; i++)
        if (places[i] < places[i + 1] && roots_value(line.d, 6, (places[i] + places[i + 1]) / 2) > 0)
            add_stretch(sweep, list, &line, index, places[i], places[i + 1]);
}

static int by_start(const void *a, const void *b) {
    double x = ((const Stretch *)a)->in, y = ((const Stretch *)b)->in;
    return (x > y) - (x < y);
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    Sweep sweep = *(const Sweep *)data;
    Arena scratch;
    arena_init(&scratch, NULL, 8192);
    sweep.arena = &scratch;
    Stretch few[FEW_STRETCHES]; /* the arena is asked for more only if they do not do */
    StretchList list = {few, 0, FEW_STRETCHES};
    double length = vec3_length(ray->direction);
    Vec3 d = vec3_scale(ray->direction, 1 / length),
         middle = vec3_lerp(sweep.bounds.min, sweep.bounds.max, 0.5);
    double shift = vec3_dot(vec3_sub(middle, ray->origin), d);
    Vec3 o = vec3_madd(ray->origin, d, shift);
    for (uint32_t i = 0; i < sweep.count; i++) {
        double near = -VTS_INFINITY, far = VTS_INFINITY;
        if (box3_clip_ray(sweep.pieces[i].bounds, ray, &near, &far)) piece_stretches(&sweep, &list, i, o, d);
    }
    if (list.count) qsort(list.items, list.count, sizeof *list.items, by_start);
    for (size_t i = 0; i < list.count;) {
        Stretch whole = list.items[i++];
        for (; i < list.count && list.items[i].in <= whole.out; i++)
            if (list.items[i].out > whole.out) {
                whole.out = list.items[i].out, whole.s_out = list.items[i].s_out;
                whole.piece_out = list.items[i].piece_out;
            }
        solid_offer(sink, (whole.in + shift) / length, (SolidTag){whole.piece_in, whole.s_in, 0});
        solid_offer(sink, (whole.out + shift) / length, (SolidTag){whole.piece_out, whole.s_out, 0});
    }
    arena_destroy(&scratch);
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    return vec3_normalize(vec3_sub(p, center_at(&((const Sweep *)data)->pieces[tag->part], tag->u)));
}

/* The least of |p - c(s)|² - r(s)². */
static bool piece_holds(const SweepPiece *piece, Vec3 p) {
    const double *coordinates[3] = {piece->x, piece->y, piece->z};
    double value[7], square[7], slope[6], places[8] = {0, 1};
    roots_multiply(piece->r, 3, piece->r, 3, value);
    for (int i = 0; i < 7; i++) value[i] = -value[i];
    for (int axis = 0; axis < 3; axis++) {
        double off[4];
        for (int i = 0; i < 4; i++) off[i] = coordinates[axis][i] - (i == 0 ? vec3_get(p, axis) : 0);
        roots_multiply(off, 3, off, 3, square);
        for (int i = 0; i < 7; i++) value[i] += square[i];
    }
    for (int i = 0; i < 6; i++) slope[i] = value[i + 1] * (i + 1);
    int count = 2 + roots_in(slope, 5, 0, 1, places + 2);
    for (int i = 0; i < count; i++)
        if (roots_value(value, 6, places[i]) <= 0) return true;
    return false;
}

static bool inside(const void *data, Vec3 p) {
    const Sweep *sweep = data;
    for (size_t i = 0; i < sweep->count; i++)
        if (piece_holds(&sweep->pieces[i], p)) return true;
    return false;
}

static Box3 bounds(const void *data) { return ((const Sweep *)data)->bounds; }

const SolidOps solid_sweep_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
