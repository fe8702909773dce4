#include "render/skin_fold.h"

#include "render/skin_cross.h"
#include "shape/roots.h"

/* det J counts as 0 below this share of the product of the lengths of its columns: rounding. */
static const double FLAT_SINE = 1e-12;
/* Parts of a cell are halved this often at most: to decide, to find places, to follow rays. */
enum { DEEPEST_SIGN = 7, DEEPEST_PLACE = 9, DEEPEST_PIECE = 6 };
/* Places found within this of each other, in cell units, are one. */
static const double SAME_PLACE = 1e-6;
static const double EDGE_MARGIN = 1e-7;

/* ---- parts of cells, which are cells themselves ---- */

/* a = a0 + side·a', likewise b, w = w0 + tall·w'; side is negative for the middle one of a triangle's four parts. */
typedef struct Part {
    double a0, b0, w0, side, tall;
} Part;

static const Part WHOLE = {0, 0, 0, 1, 1};

static BilinearVec restrict_to(const BilinearVec *f, const Part *p) {
    Vec3 along_a = vec3_madd(f->c[1], f->c[3], p->b0), along_b = vec3_madd(f->c[2], f->c[3], p->a0);
    Vec3 origin = vec3_madd(vec3_madd(f->c[0], f->c[1], p->a0), along_b, p->b0);
    return (BilinearVec){{origin, vec3_scale(along_a, p->side), vec3_scale(along_b, p->side), vec3_scale(f->c[3], p->side * p->side)}};
}

static SkinCell part_of(const SkinCell *cell, const Part *p) {
    SkinCell out = {.triangle = cell->triangle};
    BilinearVec height = restrict_to(&cell->height, p);
    out.foot = restrict_to(&cell->foot, p);
    for (int i = 0; i < 4; i++) {
        out.foot.c[i] = vec3_madd(out.foot.c[i], height.c[i], p->w0);
        out.height.c[i] = vec3_scale(height.c[i], p->tall);
    }
    out.bounds = skin_cell_bounds(&out);
    return out;
}

static Part child(const Part *p, bool triangle, int i) {
    double half = p->side / 2;
    Part out = {p->a0 + (i & 1 ? half : 0), p->b0 + (i & 2 ? half : 0), p->w0 + (i & 4 ? p->tall / 2 : 0), half, p->tall / 2};
    if (triangle && (i & 3) == 3) out.side = -half; /* the middle one, seen from the opposite corner */
    return out;
}

static SkinPoint out_of_part(const Part *p, SkinPoint at) {
    return (SkinPoint){at.cell, p->a0 + p->side * at.a, p->b0 + p->side * at.b, p->w0 + p->tall * at.w};
}

static bool in_cell(bool triangle, const SkinPoint *p, double margin) {
    double low = fmin(fmin(p->a, p->b), p->w), high = fmax(triangle ? p->a + p->b : fmax(p->a, p->b), p->w);
    return low >= -margin && high <= 1 + margin;
}

/* ---- the sign of det J ---- */

typedef struct Signs {
    bool negative, positive; /* of Bernstein's coefficients */
    bool corner_negative, corner_positive;
} Signs;

/* The Jacobian's determinant at the 27 places with a, b, w in {0, ½, 1} says all: it is of second degree in each. Over a triangle it is
 * linear in (a, b), and only the corners are asked. */
static void sample_determinants(const SkinCell *cell, double det[3][3][3], double *scale) {
    double longest[3] = {0, 0, 0};
    for (int i = 0; i < 27; i++) {
        int ia = i % 3, ib = i / 3 % 3, iw = i / 9;
        Mat3 j;
        if (cell->triangle && (ia == 1 || ib == 1 || (ia && ib))) continue;
        skin_cell_position(cell, ia / 2.0, ib / 2.0, iw / 2.0, &j);
        det[ia][ib][iw] = mat3_determinant(&j);
        for (int k = 0; k < 3; k++) longest[k] = fmax(longest[k], vec3_length(j.c[k]));
    }
    *scale = longest[0] * longest[1] * longest[2];
}

/* Values at 0, ½, 1 of a parabola to Bernstein's coefficients. */
static void to_bernstein(double *f0, double *f1, double *f2) { *f1 = 2 * *f1 - (*f0 + *f2) / 2; }

static Signs signs_of(const SkinCell *cell) {
    double f[3][3][3] = {{{0}}}, scale;
    Signs out = {false, false, false, false};
    sample_determinants(cell, f, &scale);
    double least = FLAT_SINE * scale;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            to_bernstein(&f[i][k][0], &f[i][k][1], &f[i][k][2]);
        }
    for (int i = 0; i < 3 && !cell->triangle; i++)
        for (int k = 0; k < 3; k++) to_bernstein(&f[i][0][k], &f[i][1][k], &f[i][2][k]);
    for (int i = 0; i < 3 && !cell->triangle; i++)
        for (int k = 0; k < 3; k++) to_bernstein(&f[0][i][k], &f[1][i][k], &f[2][i][k]);
    for (int i = 0; i < 27; i++) {
        double c = f[i % 3][i / 3 % 3][i / 9];
        bool corner = i % 3 != 1 && i / 3 % 3 != 1 && i / 9 != 1;
        out.negative |= c < -least;
        out.positive |= c > least;
        out.corner_negative |= corner && c < -least;
        out.corner_positive |= corner && c > least;
    }
    return out;
}

static CellSide join_sides(CellSide a, CellSide b) {
    if (a == CELL_FLAT) return b;
    return b == CELL_FLAT || a == b ? a : CELL_FOLDED;
}

static CellSide part_side(const SkinCell *cell, const Part *part, int depth) {
    SkinCell piece = part_of(cell, part);
    Signs s = signs_of(&piece);
    if (!s.negative || !s.positive) return s.positive ? CELL_UPRIGHT : s.negative ? CELL_MIRRORED : CELL_FLAT;
    if ((s.corner_negative && s.corner_positive) || depth == 0) return CELL_FOLDED;
    CellSide side = CELL_FLAT;
    for (int i = 0; i < 8 && side != CELL_FOLDED; i++) {
        Part next = child(part, cell->triangle, i);
        side = join_sides(side, part_side(cell, &next, depth - 1));
    }
    return side;
}

CellSide skin_cell_side(const SkinCell *cell, double w_most) {
    Part whole = WHOLE;
    whole.tall = w_most;
    return part_side(cell, &whole, DEEPEST_SIGN);
}

double skin_cell_unfolded_height(const SkinCell *cell, double most) {
    if (skin_cell_side(cell, most) != CELL_FOLDED) return most;
    double lo = 0, hi = most;
    while (hi - lo > 1e-3 * most) {
        double middle = (lo + hi) / 2;
        if (skin_cell_side(cell, middle) == CELL_FOLDED) hi = middle;
        else lo = middle;
    }
    return lo;
}

/* ---- all places of a point ---- */

static int add_place(SkinPoint *list, int count, SkinPoint p) {
    for (int i = 0; i < count; i++)
        if (fabs(list[i].a - p.a) + fabs(list[i].b - p.b) + fabs(list[i].w - p.w) < SAME_PLACE) return count;
    if (count == MOST_PREIMAGES) return count;
    list[count] = p;
    return count + 1;
}

/* The triangle at height w has the edges e1 + w·g1, e2 + w·g2 and the corner c + w·g0, seen from the point: its plane passes the point
 * where det[e1 + w·g1, e2 + w·g2, c + w·g0] = 0. */
static int prism_preimages(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint *out) {
    Vec3 e[2] = {cell->foot.c[1], cell->foot.c[2]}, g[2] = {cell->height.c[1], cell->height.c[2]};
    Vec3 corner = vec3_sub(cell->foot.c[0], world), up = cell->height.c[0];
    Vec3 n0 = vec3_cross(e[0], e[1]), n1 = vec3_add(vec3_cross(e[0], g[1]), vec3_cross(g[0], e[1])), n2 = vec3_cross(g[0], g[1]);
    const double cubic[4] = {vec3_dot(n0, corner), vec3_dot(n1, corner) + vec3_dot(n0, up), vec3_dot(n2, corner) + vec3_dot(n1, up),
                             vec3_dot(n2, up)};
    double w[ROOTS_HIGHEST_DEGREE];
    int found = roots_in(cubic, 3, -1e-6, 1 + 1e-6, w), count = 0;
    for (int i = 0; i < found; i++) {
        Vec3 e1 = vec3_madd(e[0], g[0], w[i]), e2 = vec3_madd(e[1], g[1], w[i]), rest = vec3_negate(vec3_madd(corner, up, w[i]));
        Vec3 n = vec3_cross(e1, e2);
        double nn = vec3_length_squared(n);
        if (!(nn > 0)) continue;
        SkinPoint p = {0, vec3_dot(vec3_cross(rest, e2), n) / nn, vec3_dot(vec3_cross(e1, rest), n) / nn, w[i]}, polished = p;
        if (!in_cell(true, &p, 1e-3)) continue;
        if (skin_cell_invert(cell, world, tolerance, &polished) && in_cell(true, &polished, 1e-3)) p = polished;
        if (in_cell(true, &p, EDGE_MARGIN)) count = add_place(out, count, p);
    }
    return count;
}

/* The part's corner i, relative to the point. */
static Vec3 corner_from(const SkinCell *part, int i, Vec3 world) {
    return vec3_sub(skin_cell_position(part, i & 1, i >> 1 & 1, i >> 2, NULL), world);
}

/* Whether all corners lie on one side of the point, along the rows of the inverse Jacobian in the middle: then so does the part. */
static bool part_misses(const SkinCell *part, const Mat3 *rows, Vec3 world) {
    Vec3 low = vec3_splat(VTS_INFINITY), high = vec3_splat(-VTS_INFINITY);
    for (int i = 0; i < 8; i++) {
        Vec3 y = mat3_apply_transposed(rows, corner_from(part, i, world));
        low = vec3_min(low, y), high = vec3_max(high, y);
    }
    return low.x > 0 || low.y > 0 || low.z > 0 || high.x < 0 || high.y < 0 || high.z < 0;
}

/* Whether the Jacobian, multiplied by its inverse in the middle, is dominated by its diagonal all over the part: the mapping is one to
 * one there. Columns are bilinear, so that their corners bound them. */
static bool one_to_one(const SkinCell *part, const Mat3 *rows) {
    double worst[3] = {VTS_INFINITY, VTS_INFINITY, VTS_INFINITY}, beside[3] = {0, 0, 0};
    for (int column = 0; column < 3; column++) {
        double most[3] = {0, 0, 0};
        for (int i = 0; i < 8; i++) {
            Mat3 j;
            skin_cell_position(part, i & 1, i >> 1 & 1, i >> 2, &j);
            Vec3 m = mat3_apply_transposed(rows, j.c[column]);
            for (int row = 0; row < 3; row++) {
                double entry = vec3_get(m, row);
                if (row == column) worst[row] = fmin(worst[row], entry);
                else most[row] = fmax(most[row], fabs(entry));
            }
        }
        for (int row = 0; row < 3; row++) beside[row] += most[row];
    }
    return worst[0] > beside[0] && worst[1] > beside[1] && worst[2] > beside[2];
}

typedef struct PlaceSearch {
    const SkinCell *cell;
    Vec3 world;
    double tolerance;
    SkinPoint *out;
    int count, parts_left;
} PlaceSearch;

static void search_part(PlaceSearch *s, const Part *part, int depth) {
    SkinCell piece = part_of(s->cell, part);
    Mat3 j;
    skin_cell_position(&piece, 0.5, 0.5, 0.5, &j);
    Mat3 rows = mat3_cofactor(&j);
    double det = mat3_determinant(&j);
    for (int i = 0; i < 3; i++) rows.c[i] = vec3_scale(rows.c[i], det < 0 ? -1 : 1);
    if (s->parts_left-- <= 0 || part_misses(&piece, &rows, s->world)) return;
    SkinPoint p = out_of_part(part, (SkinPoint){0, 0.5, 0.5, 0.5});
    if (skin_cell_invert(s->cell, s->world, s->tolerance, &p) && in_cell(false, &p, EDGE_MARGIN)) s->count = add_place(s->out, s->count, p);
    if (depth == 0 || one_to_one(&piece, &rows)) return;
    for (int i = 0; i < 8; i++) {
        Part next = child(part, false, i);
        search_part(s, &next, depth - 1);
    }
}

int skin_cell_preimages(const SkinCell *cell, Vec3 world, double tolerance, SkinPoint out[MOST_PREIMAGES]) {
    if (cell->triangle) return prism_preimages(cell, world, tolerance, out);
    PlaceSearch search = {cell, world, tolerance, out, 0, 4000};
    search_part(&search, &WHOLE, DEEPEST_PLACE);
    return search.count;
}

/* ---- pieces of rays ---- */

typedef struct PieceSearch {
    const SkinCell *cell;
    int32_t number;
    const Ray *ray;
    double t_min, t_max, tolerance;
    SkinPiece *out;
    int count;
} PieceSearch;

/* Whether the middle of a stretch between two crossings lies in the part, and where. */
static bool place_in(const PieceSearch *s, const SkinCell *part, double t, SkinPoint *place) {
    Vec3 world = vec3_madd(s->ray->origin, s->ray->direction, t);
    if (skin_cell_holds(part, world, s->tolerance, place)) return true;
    if (s->cell->side != CELL_FOLDED) return false;
    SkinPoint all[MOST_PREIMAGES];
    if (!skin_cell_preimages(part, world, s->tolerance, all)) return false;
    *place = all[0];
    return true;
}

/* Pieces of neighbouring parts that continue each other are joined. */
static void add_piece(PieceSearch *s, SkinPiece piece) {
    double hair = 1e-9 * (piece.t1 - piece.t0);
    for (int i = 0; i < s->count; i++) {
        SkinPiece *p = &s->out[i];
        double apart = fabs(p->middle.a - piece.middle.a) + fabs(p->middle.b - piece.middle.b) + fabs(p->middle.w - piece.middle.w);
        if (fabs(p->t0 - piece.t0) <= hair && fabs(p->t1 - piece.t1) <= hair && apart < SAME_PLACE) return; /* along a wall between parts */
    }
    if (s->count < MOST_PIECES) s->out[s->count++] = piece;
}

static void cut_part(PieceSearch *s, const SkinCell *cell, const Part *part, double lo, double hi) {
    SkinCrossing cross[MOST_CROSSINGS];
    int count = skin_cell_cross(cell, s->ray, lo, hi, cross);
    double from = lo;
    for (int i = 0; i <= count; i++) {
        double to = i < count ? cross[i].t : hi;
        SkinPoint place = {.cell = s->number};
        if (to > from && place_in(s, cell, (from + to) / 2, &place)) {
            place.cell = s->number;
            add_piece(s, (SkinPiece){from, to, out_of_part(part, place)});
        }
        from = to;
    }
}

static void follow_part(PieceSearch *s, const Part *part, int depth) {
    SkinCell piece = part_of(s->cell, part);
    double lo = s->t_min, hi = s->t_max;
    if (!box3_clip_ray(piece.bounds, s->ray, &lo, &hi)) return;
    Signs signs = signs_of(&piece);
    if (depth == 0 || !signs.negative || !signs.positive) {
        if (signs.negative || signs.positive) cut_part(s, &piece, part, lo, hi);
        return;
    }
    for (int i = 0; i < 8; i++) {
        Part next = child(part, s->cell->triangle, i);
        follow_part(s, &next, depth - 1);
    }
}

int skin_cell_pieces(const SkinCell *cell, int32_t number, const Ray *ray, double t_min, double t_max, SkinPiece out[MOST_PIECES]) {
    double lo = t_min, hi = t_max;
    if (cell->side == CELL_FLAT || !box3_clip_ray(cell->bounds, ray, &lo, &hi)) return 0;
    double size = vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min));
    PieceSearch search = {cell, number, ray, t_min, t_max, 1e-9 * size, out, 0};
    if (cell->side == CELL_FOLDED) follow_part(&search, &WHOLE, DEEPEST_PIECE);
    else cut_part(&search, cell, &WHOLE, lo, hi);
    return search.count;
}
