#include "render/beam_skin.h"

#include <stdlib.h>

/* How often a triangle is cut in four where the mapping bends it. */
enum { NEWTON_STEPS = 3, DEEPEST_CUT = 5, MOST_CLIPPED = 9, DEEPEST_NODE = 512 };
/* Corners this little outside of a cell count as inside: tiles that end with the cell do so but for rounding. */
static const float HAIR = 1e-5f;

/* ---- a cell as the beam sees it ---- */

/* q = c0 + c1·a + c2·b + c3·a·b + w·(c4 + c5·a + c6·b + c7·a·b), q.x, q.y and q.z. */
typedef struct CellFrame {
    const SkinCell *cell;
    float x[8], y[8], z[8];
    float bend_ab, bend_aw, bend_bw; /* how far the middle of a line leaves its chord, for unit extents, scene units */
    bool affine;                     /* (u, v) → (a, b), and w' → w without a and b */
    double a_u, a_v, a_0, b_u, b_v, b_0, w_w, w_0;
} CellFrame;

static void fold(CellFrame *f, int i, Vec3 c) { f->x[i] = (float)c.x, f->y[i] = (float)c.y, f->z[i] = (float)c.z; }

/* Whether the box over the cell has no room: its height vectors vanish or lie in the surface. */
static bool is_flat(const SkinCell *cell) {
    double largest = 0, size = 0;
    for (int i = 0; i < 4; i++) {
        Mat3 j;
        if (cell->triangle && i == 3) break;
        skin_cell_position(cell, i & 1, i >> 1, 0.5, &j);
        largest = fmax(largest, fabs(mat3_determinant(&j)));
        size = fmax(size, vec3_length(j.c[0]) * vec3_length(j.c[1]) * (vec3_length(j.c[0]) + vec3_length(j.c[1])));
    }
    return !(largest > 1e-9 * size);
}

/* False where the mapping is singular, or texture coordinates are: there is no way back from them. */
static bool frame_cell(CellFrame *f, const Beam *beam, const SkinCell *cell) {
    f->cell = cell;
    if (is_flat(cell)) return false;
    fold(f, 0, beam_point(beam, cell->foot.c[0]));
    for (int i = 1; i < 4; i++) fold(f, i, beam_vector(beam, cell->foot.c[i]));
    for (int i = 0; i < 4; i++) fold(f, 4 + i, beam_vector(beam, cell->height.c[i]));
    const Vec3 *p = cell->foot.c, *h = cell->height.c;
    double twist = vec3_length(h[3]);
    f->bend_ab = (float)((vec3_length(p[3]) + twist) / 4);
    f->bend_aw = (float)((vec3_length(h[1]) + twist) / 4);
    f->bend_bw = (float)((vec3_length(h[2]) + twist) / 4);
    const double *u = cell->u.c, *v = cell->v.c, *foot = cell->w_foot.c, *tip = cell->w_tip.c;
    double det = u[1] * v[2] - u[2] * v[1], scale = fabs(u[1]) + fabs(u[2]) + fabs(v[1]) + fabs(v[2]);
    if (!(fabs(det) > 1e-12 * scale * scale)) return false;
    f->a_u = v[2] / det, f->a_v = -u[2] / det;
    f->b_u = -v[1] / det, f->b_v = u[1] / det;
    f->a_0 = -(f->a_u * u[0] + f->a_v * v[0]);
    f->b_0 = -(f->b_u * u[0] + f->b_v * v[0]);
    f->w_w = 1 / (tip[0] - foot[0]);
    f->w_0 = -foot[0] * f->w_w;
    if (!isfinite(f->w_w)) return false;
    double steepest = 0;
    for (int i = 1; i < 4; i++) steepest = fmax(steepest, fmax(fabs(foot[i]), fabs(tip[i])));
    f->affine = fabs(u[3]) + fabs(v[3]) <= 1e-9 * scale && steepest <= 1e-9 * fabs(tip[0] - foot[0]);
    return true;
}

static Vec3f frame_point(const CellFrame *f, float a, float b, float w) {
    float ab = a * b;
    return vec3f(f->x[0] + f->x[1] * a + f->x[2] * b + f->x[3] * ab + w * (f->x[4] + f->x[5] * a + f->x[6] * b + f->x[7] * ab),
                 f->y[0] + f->y[1] * a + f->y[2] * b + f->y[3] * ab + w * (f->y[4] + f->y[5] * a + f->y[6] * b + f->y[7] * ab),
                 f->z[0] + f->z[1] * a + f->z[2] * b + f->z[3] * ab + w * (f->z[4] + f->z[5] * a + f->z[6] * b + f->z[7] * ab));
}

static double bilinear(const Bilinear *f, double a, double b) { return f->c[0] + f->c[1] * a + (f->c[2] + f->c[3] * a) * b; }

/* (u, v, w') → (a, b, w); false where Newton's method finds no way. */
static bool to_cell(const CellFrame *f, double u, double v, double w, double *a, double *b, double *layer) {
    *a = f->a_u * u + f->a_v * v + f->a_0;
    *b = f->b_u * u + f->b_v * v + f->b_0;
    *layer = f->w_w * w + f->w_0;
    if (f->affine) return true;
    const Bilinear *fu = &f->cell->u, *fv = &f->cell->v;
    for (int i = 0; i < 8; i++) {
        double ru = u - bilinear(fu, *a, *b), rv = v - bilinear(fv, *a, *b);
        double ua = fu->c[1] + fu->c[3] * *b, ub = fu->c[2] + fu->c[3] * *a, va = fv->c[1] + fv->c[3] * *b, vb = fv->c[2] + fv->c[3] * *a;
        double inverse = 1 / (ua * vb - ub * va), da = (ru * vb - ub * rv) * inverse, db = (ua * rv - ru * va) * inverse;
        if (!(fabs(da) < 100 && fabs(db) < 100)) return false;
        *a += da, *b += db;
        if (fabs(da) + fabs(db) < 1e-9) break;
    }
    double foot = bilinear(&f->cell->w_foot, *a, *b), tip = bilinear(&f->cell->w_tip, *a, *b);
    *layer = (w - foot) / (tip - foot);
    return isfinite(*layer);
}

/* In which of six ways a point is out of the beam, a bit each. */
static unsigned outcode(const Beam *beam, float x, float y, float z) {
    float scale = beam->perspective ? z : 1, columns = (float)beam->samples.columns * scale, rows = (float)beam->samples.rows * scale;
    float near = (float)beam->nearest, far = (float)beam->farthest;
    unsigned ends = beam->perspective ? (unsigned)(z < near) << 4 | (unsigned)(z > far) << 5 : (unsigned)(z > near) << 4 | (unsigned)(z < far) << 5;
    return (unsigned)(x < 0) | (unsigned)(x > columns) << 1 | (unsigned)(y < 0) << 2 | (unsigned)(y > rows) << 3 | ends;
}

/* ---- boxes of the cell against the beam ---- */

typedef struct CellBox {
    float a0, a1, b0, b1, w0, w1;
} CellBox;

/* What lies between three pairs of planes of skin space is within the hull of its eight corners, as the mapping is linear along
 * each axis. *nearest gets the smallest q.z of a perspective beam, the negated largest of a parallel one. */
static bool box_met(const Beam *beam, const CellFrame *f, const CellBox *box, float *nearest) {
    unsigned outside = 63;
    *nearest = INFINITY;
    for (int i = 0; i < 8; i++) {
        Vec3f q = frame_point(f, i & 1 ? box->a1 : box->a0, i & 2 ? box->b1 : box->b0, i & 4 ? box->w1 : box->w0);
        outside &= outcode(beam, q.x, q.y, q.z);
        *nearest = float_min(*nearest, beam->perspective ? q.z : -q.z);
    }
    return outside == 0;
}

/* Narrows to the cell; false when nothing is left. */
static bool within_cell(const SkinCell *cell, CellBox *box) {
    box->a0 = float_max(box->a0, 0), box->a1 = float_min(box->a1, 1);
    box->b0 = float_max(box->b0, 0), box->b1 = float_min(box->b1, 1);
    box->w0 = float_max(box->w0, 0), box->w1 = float_min(box->w1, 1);
    return box->a0 <= box->a1 && box->b0 <= box->b1 && box->w0 <= box->w1 && (!cell->triangle || box->a0 + box->b0 <= 1);
}

/* The cell's box around a rectangle of (u, v) between two heights; false when they are apart. */
static bool box_of_uv(const CellFrame *f, const double u[2], const double v[2], const double w[2], CellBox *box) {
    double lo[3] = {VTS_INFINITY, VTS_INFINITY, VTS_INFINITY}, hi[3] = {-VTS_INFINITY, -VTS_INFINITY, -VTS_INFINITY};
    for (int i = 0; i < 8; i++) {
        double at[3];
        if (!to_cell(f, u[i & 1], v[i >> 1 & 1], w[i >> 2], &at[0], &at[1], &at[2])) {
            *box = (CellBox){0, 1, 0, 1, 0, 1};
            return true;
        }
        for (int k = 0; k < 3; k++) lo[k] = fmin(lo[k], at[k]), hi[k] = fmax(hi[k], at[k]);
    }
    /* Lines of equal u are bent where the cell's coordinates are not affine. */
    double slack = f->affine ? 1e-6 : 0.25;
    for (int k = 0; k < 3; k++) {
        double more = slack * (hi[k] - lo[k]) + 1e-6;
        lo[k] -= more, hi[k] += more;
    }
    *box = (CellBox){(float)lo[0], (float)hi[0], (float)lo[1], (float)hi[1], (float)lo[2], (float)hi[2]};
    return within_cell(f->cell, box);
}

/* ---- triangles ---- */

/* One copy in one cell: box coordinates of the texel → (a, b, w). */
typedef struct CopyFrame {
    const CellFrame *frame;
    const PlacedTexel *placed;
    const TexelCopy *copy;
    double u_x, u_z, u_0, v_x, v_z, v_0, w_y, w_0; /* (x, y, z) → (u, v, w') */
    float a_x, a_z, a_0, b_x, b_z, b_0, y_w, y_0;  /* (x, y, z) → (a, b, w) where that is affine */
    float tolerance;                               /* of bent triangles, scene units */
} CopyFrame;

typedef struct Drawing {
    BeamDraft *draft;
    const CompiledSkin *skin;
    CopyFrame at;
} Drawing;

/* The linear part of (u, v) → (a, b) at a place, or as near to it as the cell goes. */
static void linearise(CellFrame *f, double u, double v) {
    double a, b, w;
    if (!to_cell(f, u, v, 0, &a, &b, &w)) return;
    a = double_clamp(a, 0, 1), b = double_clamp(b, 0, 1);
    const double *cu = f->cell->u.c, *cv = f->cell->v.c;
    double ua = cu[1] + cu[3] * b, ub = cu[2] + cu[3] * a, va = cv[1] + cv[3] * b, vb = cv[2] + cv[3] * a, det = ua * vb - ub * va;
    if (!(fabs(det) > 0)) return;
    double u0 = cu[0] + cu[1] * a + (cu[2] + cu[3] * a) * b, v0 = cv[0] + cv[1] * a + (cv[2] + cv[3] * a) * b;
    f->a_u = vb / det, f->a_v = -ub / det, f->b_u = -va / det, f->b_v = ua / det;
    f->a_0 = a - f->a_u * u0 - f->a_v * v0;
    f->b_0 = b - f->b_u * u0 - f->b_v * v0;
}

static bool frame_copy(CopyFrame *c, const CellFrame *f, const PlacedTexel *placed, const TexelCopy *copy, int period) {
    double det = copy->xu * copy->zv - copy->xv * copy->zu;
    *c = (CopyFrame){.frame = f, .placed = placed, .copy = copy};
    if (!(fabs(det) > 0) || !(copy->inverse_scale > 0)) return false;
    c->u_x = copy->zv / det, c->u_z = -copy->xv / det, c->u_0 = -(c->u_x * copy->x0 + c->u_z * copy->z0);
    c->v_x = -copy->zu / det, c->v_z = copy->xu / det, c->v_0 = -(c->v_x * copy->x0 + c->v_z * copy->z0);
    c->w_y = 1 / copy->inverse_scale, c->w_0 = period / copy->inverse_scale;
    CellFrame at_middle = *f;
    if (!f->affine) {
        linearise(&at_middle, c->u_x * 0.5 + c->u_z * 0.5 + c->u_0, c->v_x * 0.5 + c->v_z * 0.5 + c->v_0);
        f = &at_middle;
    }
    c->a_x = (float)(f->a_u * c->u_x + f->a_v * c->v_x), c->a_z = (float)(f->a_u * c->u_z + f->a_v * c->v_z);
    c->a_0 = (float)(f->a_u * c->u_0 + f->a_v * c->v_0 + f->a_0);
    c->b_x = (float)(f->b_u * c->u_x + f->b_v * c->v_x), c->b_z = (float)(f->b_u * c->u_z + f->b_v * c->v_z);
    c->b_0 = (float)(f->b_u * c->u_0 + f->b_v * c->v_0 + f->b_0);
    c->y_w = (float)(f->w_w * c->w_y), c->y_0 = (float)(f->w_w * c->w_0 + f->w_0);
    return true;
}

/* Box coordinates → (a, b, w) of many points. Written so that compilers make vectors of it. */
static void to_skin(const CopyFrame *c, int count, const float *restrict x, const float *restrict y, const float *restrict z, float *restrict a,
                    float *restrict b, float *restrict w) {
    for (int i = 0; i < count; i++) {
        a[i] = c->a_x * x[i] + c->a_z * z[i] + c->a_0;
        b[i] = c->b_x * x[i] + c->b_z * z[i] + c->b_0;
        w[i] = c->y_w * y[i] + c->y_0;
    }
    if (c->frame->affine) return;
    /* Newton's method from the linear map at the copy's middle, for texture coordinates less those of the cell's first corner. */
    const Bilinear *fu = &c->frame->cell->u, *fv = &c->frame->cell->v, *foot = &c->frame->cell->w_foot, *tip = &c->frame->cell->w_tip;
    float u1 = (float)fu->c[1], u2 = (float)fu->c[2], u3 = (float)fu->c[3], v1 = (float)fv->c[1], v2 = (float)fv->c[2], v3 = (float)fv->c[3];
    float ux = (float)c->u_x, uz = (float)c->u_z, u0 = (float)(c->u_0 - fu->c[0]), vx = (float)c->v_x, vz = (float)c->v_z, v0 = (float)(c->v_0 - fv->c[0]);
    for (int step = 0; step < NEWTON_STEPS; step++)
        for (int i = 0; i < count; i++) {
            float ru = ux * x[i] + uz * z[i] + u0 - u1 * a[i] - (u2 + u3 * a[i]) * b[i];
            float rv = vx * x[i] + vz * z[i] + v0 - v1 * a[i] - (v2 + v3 * a[i]) * b[i];
            float ua = u1 + u3 * b[i], ub = u2 + u3 * a[i], va = v1 + v3 * b[i], vb = v2 + v3 * a[i];
            float inverse = 1 / (ua * vb - ub * va);
            a[i] += (ru * vb - ub * rv) * inverse;
            b[i] += (ua * rv - ru * va) * inverse;
        }
    float f0 = (float)foot->c[0], f1 = (float)foot->c[1], f2 = (float)foot->c[2], f3 = (float)foot->c[3];
    float t0 = (float)tip->c[0], t1 = (float)tip->c[1], t2 = (float)tip->c[2], t3 = (float)tip->c[3], wy = (float)c->w_y, w0 = (float)c->w_0;
    for (int i = 0; i < count; i++) {
        float from = f0 + f1 * a[i] + (f2 + f3 * a[i]) * b[i], to = t0 + t1 * a[i] + (t2 + t3 * a[i]) * b[i];
        w[i] = (wy * y[i] + w0 - from) / (to - from);
    }
}

/* Keeps what samples saw, when room is short: nothing that was hidden since. */
static void drop_hidden(BeamDraft *draft) {
    const BeamSamples *s = &draft->beam->samples;
    uint32_t count = s->first[s->columns * s->rows], kept = 0;
    uint32_t *used = draft->renumber;
    for (uint32_t i = 0; i <= draft->facet_count; i++) used[i] = 0;
    for (uint32_t i = 0; i < count; i++) used[s->mark[i]] = 1;
    for (uint32_t i = 1; i <= draft->facet_count; i++) {
        if (!used[i]) continue;
        draft->facets[kept] = draft->facets[i - 1];
        used[i] = ++kept;
    }
    used[0] = 0;
    for (uint32_t i = 0; i < count; i++) s->mark[i] = used[s->mark[i]];
    draft->facet_count = kept;
}

static void keep_facet(const Drawing *d, const Vec3f corner[3], size_t layer) {
    BeamDraft *draft = d->draft;
    draft->facets[draft->facet_count++] =
        (BeamFacet){d->skin, d->at.frame->cell, d->at.placed, *d->at.copy, layer, {corner[0], corner[1], corner[2]}};
    if (draft->facet_count == draft->facet_capacity) drop_hidden(draft);
}

static float edge_side(const Vec3f *p, int edge, bool triangle) {
    switch (edge) {
    case 0: return p->x;
    case 1: return p->y;
    case 2: return p->z;
    case 3: return 1 - p->z;
    case 4: return triangle ? 1 - p->x - p->y : 1 - p->x;
    default: return triangle ? 1 : 1 - p->y;
    }
}

/* The part of the polygon in the cell. */
static int clip_to_cell(const Vec3f in[3], bool triangle, Vec3f out[MOST_CLIPPED]) {
    Vec3f other[MOST_CLIPPED];
    int count = 3;
    for (int i = 0; i < 3; i++) out[i] = in[i];
    for (int e = 0; e < 6 && count; e++) {
        int kept = 0;
        bool any = false;
        for (int i = 0; i < count; i++) any |= edge_side(&out[i], e, triangle) < 0;
        if (!any) continue;
        for (int i = 0; i < count; i++) {
            Vec3f a = out[i], b = out[(i + 1) % count];
            float da = edge_side(&a, e, triangle), db = edge_side(&b, e, triangle);
            if (da >= 0) other[kept++] = a;
            if ((da >= 0) != (db >= 0)) other[kept++] = vec3f_madd(a, vec3f_sub(b, a), da / (da - db));
        }
        for (int i = 0; i < kept; i++) out[i] = other[i];
        count = kept;
    }
    return count;
}

static bool outside_beam(const Beam *beam, const Vec3f q[3]) {
    return outcode(beam, q[0].x, q[0].y, q[0].z) & outcode(beam, q[1].x, q[1].y, q[1].z) & outcode(beam, q[2].x, q[2].y, q[2].z);
}

/* How far the mapping bends the triangle out of its plane, scene units. */
static float bend(const CellFrame *f, const Vec3f p[3]) {
    float a = float_max(fabsf(p[1].x - p[0].x), float_max(fabsf(p[2].x - p[0].x), fabsf(p[2].x - p[1].x)));
    float b = float_max(fabsf(p[1].y - p[0].y), float_max(fabsf(p[2].y - p[0].y), fabsf(p[2].y - p[1].y)));
    float w = float_max(fabsf(p[1].z - p[0].z), float_max(fabsf(p[2].z - p[0].z), fabsf(p[2].z - p[1].z)));
    return f->bend_ab * a * b + f->bend_aw * a * w + f->bend_bw * b * w;
}

/* One triangle of a layer, in the cell and in the beam. */
typedef struct Piece {
    Vec3f p[3], q[3];
    size_t layer;
    bool inside; /* the cell as a whole */
} Piece;

static void draw_flat(Drawing *d, const Piece *piece) {
    Beam *beam = d->draft->beam;
    const CellFrame *f = d->at.frame;
    uint32_t mark = d->draft->facet_count + 1;
    const Vec3f *q = piece->q;
    bool seen;
    d->draft->triangles++;
    if (!piece->inside) {
        Vec3f part[MOST_CLIPPED];
        int count = clip_to_cell(piece->p, f->cell->triangle, part);
        if (count < 3) return;
        for (int i = 0; i < count; i++) part[i] = frame_point(f, part[i].x, part[i].y, part[i].z);
        seen = beam_draw(beam, part, count, mark);
    } else if (beam->perspective && q[0].z >= (float)beam->nearest && q[1].z >= (float)beam->nearest && q[2].z >= (float)beam->nearest) {
        Vec3f s[3];
        for (int i = 0; i < 3; i++) {
            float key = 1 / q[i].z;
            s[i] = vec3f(q[i].x * key, q[i].y * key, key);
        }
        seen = beam_draw_seen(beam, s[0], s[1], s[2], mark);
    } else {
        seen = beam_draw(beam, q, 3, mark);
    }
    if (seen && d->draft->facets) keep_facet(d, piece->p, piece->layer);
}

/* Cut in four, and again, until the mapping bends it no more than is tolerated. */
static void draw_bent(Drawing *d, const Piece *piece, int depth) {
    const CellFrame *f = d->at.frame;
    if (outside_beam(d->draft->beam, piece->q)) return;
    if (depth == DEEPEST_CUT || bend(f, piece->p) <= d->at.tolerance) {
        draw_flat(d, piece);
        return;
    }
    Piece middle = {.layer = piece->layer, .inside = piece->inside};
    for (int i = 0; i < 3; i++) {
        middle.p[i] = vec3f_scale(vec3f_add(piece->p[i], piece->p[(i + 1) % 3]), 0.5f);
        middle.q[i] = frame_point(f, middle.p[i].x, middle.p[i].y, middle.p[i].z);
    }
    for (int i = 0; i < 3; i++) {
        Piece corner = {{piece->p[i], middle.p[i], middle.p[(i + 2) % 3]}, {piece->q[i], middle.q[i], middle.q[(i + 2) % 3]}, piece->layer, piece->inside};
        draw_bent(d, &corner, depth + 1);
    }
    draw_bent(d, &middle, depth + 1);
}

/* The bit after those of outcode(): out of the cell. */
enum { OUT_OF_CELL = 64 };

static unsigned cell_code(float a, float b, float w, bool triangle) {
    float most_b = triangle ? 1 - a : 1;
    return (a >= -HAIR && a <= 1 + HAIR && b >= -HAIR && b <= most_b + HAIR && w >= -HAIR && w <= 1 + HAIR) ? 0 : OUT_OF_CELL;
}

static void draw_cluster(Drawing *d, const TexelCluster *cluster) {
    float a[CLUSTER_VERTICES], b[CLUSTER_VERTICES], w[CLUSTER_VERTICES];
    Vec3f q[CLUSTER_VERTICES];
    unsigned char code[CLUSTER_VERTICES];
    const CellFrame *f = d->at.frame;
    to_skin(&d->at, cluster->vertex_count, cluster->x, cluster->y, cluster->z, a, b, w);
    for (int i = 0; i < cluster->vertex_count; i++) {
        q[i] = frame_point(f, a[i], b[i], w[i]);
        code[i] = (unsigned char)(outcode(d->draft->beam, q[i].x, q[i].y, q[i].z) | cell_code(a[i], b[i], w[i], f->cell->triangle));
    }
    for (int i = 0; i < cluster->triangle_count; i++) {
        const uint8_t *v = cluster->triangles[i];
        if (code[v[0]] & code[v[1]] & code[v[2]] & (OUT_OF_CELL - 1)) continue;
        Piece piece = {.layer = cluster->layers[i], .inside = !((code[v[0]] | code[v[1]] | code[v[2]]) & OUT_OF_CELL)};
        for (int k = 0; k < 3; k++) piece.p[k] = vec3f(a[v[k]], b[v[k]], w[v[k]]), piece.q[k] = q[v[k]];
        if (bend(f, piece.p) <= d->at.tolerance) draw_flat(d, &piece);
        else draw_bent(d, &piece, 0);
    }
}

/* ---- copies ---- */

static bool node_box(const CopyFrame *c, const ClusterNode *node, CellBox *box) {
    if (!c->frame->affine) {
        float x[8], y[8], z[8], a[8], b[8], w[8];
        for (int i = 0; i < 8; i++) {
            x[i] = i & 1 ? node->max[0] : node->min[0];
            y[i] = i & 2 ? node->max[1] : node->min[1];
            z[i] = i & 4 ? node->max[2] : node->min[2];
        }
        to_skin(c, 8, x, y, z, a, b, w);
        *box = (CellBox){a[0], a[0], b[0], b[0], w[0], w[0]};
        for (int i = 1; i < 8; i++) {
            box->a0 = float_min(box->a0, a[i]), box->a1 = float_max(box->a1, a[i]);
            box->b0 = float_min(box->b0, b[i]), box->b1 = float_max(box->b1, b[i]);
            box->w0 = float_min(box->w0, w[i]), box->w1 = float_max(box->w1, w[i]);
        }
        /* Its sides are bent. */
        float slack_a = 0.25f * (box->a1 - box->a0) + HAIR, slack_b = 0.25f * (box->b1 - box->b0) + HAIR, slack_w = 0.25f * (box->w1 - box->w0) + HAIR;
        *box = (CellBox){box->a0 - slack_a, box->a1 + slack_a, box->b0 - slack_b, box->b1 + slack_b, box->w0 - slack_w, box->w1 + slack_w};
        return within_cell(c->frame->cell, box);
    }
    float x = (node->min[0] + node->max[0]) / 2, z = (node->min[2] + node->max[2]) / 2;
    float hx = node->max[0] - x, hz = node->max[2] - z;
    float a = c->a_x * x + c->a_z * z + c->a_0, ha = fabsf(c->a_x) * hx + fabsf(c->a_z) * hz + HAIR;
    float b = c->b_x * x + c->b_z * z + c->b_0, hb = fabsf(c->b_x) * hx + fabsf(c->b_z) * hz + HAIR;
    float w0 = c->y_w * node->min[1] + c->y_0, w1 = c->y_w * node->max[1] + c->y_0;
    *box = (CellBox){a - ha, a + ha, b - hb, b + hb, float_min(w0, w1) - HAIR, float_max(w0, w1) + HAIR};
    return within_cell(c->frame->cell, box);
}

static void draw_copy(Drawing *d, const BeamTexel *texel) {
    uint32_t stack[DEEPEST_NODE];
    int depth = 0;
    if (texel->node_count) stack[depth++] = 0;
    while (depth) {
        const ClusterNode *node = &texel->nodes[stack[--depth]];
        CellBox box;
        float nearest;
        if (!node_box(&d->at, node, &box) || !box_met(d->draft->beam, d->at.frame, &box, &nearest)) continue;
        if (node->leaf) {
            draw_cluster(d, &texel->clusters[node->first]);
        } else if (depth + 2 <= DEEPEST_NODE) {
            stack[depth++] = node->first;
            stack[depth++] = node->first + 1;
        }
    }
}

/* What may be missed at the copy, seen from the eye: the same whatever beam it is drawn into. */
static double tolerance_at(const Drawing *d) {
    const CopyFrame *c = &d->at;
    const BeamDraft *draft = d->draft;
    double a = (double)(c->a_x / 2 + c->a_z / 2 + c->a_0), b = (double)(c->b_x / 2 + c->b_z / 2 + c->b_0);
    Vec3 middle = skin_cell_position(c->frame->cell, double_clamp(a, 0, 1), double_clamp(b, 0, 1), 0.5, NULL);
    double size = d->skin->tile_size, distance = vec3_length(vec3_sub(middle, draft->eye));
    return draft->tolerance * (draft->width + draft->spread * fmax(distance - 0.7 * size, 0.05 * size));
}

static void draw_texel_at(Drawing *d, const CellFrame *f, const PlacedTexel *placed, int64_t iu, int64_t iv) {
    TexelCopy copy;
    if (!texel_copy_of(placed, iu, iv, &copy) || !copy.texel->beam) return;
    int from = 0, to = 0;
    if (copy.texel->beam->cyclic[1]) {
        const double *foot = f->cell->w_foot.c, *tip = f->cell->w_tip.c;
        double reach = fabs(foot[1]) + fabs(foot[2]) + fabs(foot[3]) + fabs(tip[1]) + fabs(tip[2]) + fabs(tip[3]);
        from = (int)double_clamp(floor(fmin(foot[0], tip[0]) - reach), -64, 64);
        to = (int)double_clamp(ceil(fmax(foot[0], tip[0]) + reach) - 1, -64, 64);
    }
    for (int period = from; period <= to; period++)
        if (frame_copy(&d->at, f, placed, &copy, period)) {
            d->at.tolerance = (float)tolerance_at(d);
            draw_copy(d, copy.texel->beam);
        }
}

/* Tiles [u0, u1) × [v0, v1). */
typedef struct TileRange {
    int64_t u0, u1, v0, v1;
} TileRange;

static bool tiles_met(const Drawing *d, const CellFrame *f, const PlacedTexel *placed, const TileRange *r, float *nearest) {
    double reach = placed->reach;
    const double u[2] = {(double)r->u0 - reach, (double)r->u1 + reach}, v[2] = {(double)r->v0 - reach, (double)r->v1 + reach};
    const double *foot = f->cell->w_foot.c, *tip = f->cell->w_tip.c;
    double w[2] = {fmin(foot[0], tip[0]), fmax(foot[0], tip[0])};
    CellBox box;
    if (!box_of_uv(f, u, v, w, &box)) return false;
    box.w0 = 0, box.w1 = 1;
    return box_met(d->draft->beam, f, &box, nearest);
}

static void draw_tiles(Drawing *d, const CellFrame *f, const PlacedTexel *placed, TileRange r) {
    if (r.u1 - r.u0 == 1 && r.v1 - r.v0 == 1) {
        draw_texel_at(d, f, placed, r.u0, r.v0);
        return;
    }
    TileRange half[2] = {r, r};
    if (r.u1 - r.u0 >= r.v1 - r.v0) half[0].u1 = half[1].u0 = r.u0 + (r.u1 - r.u0) / 2;
    else half[0].v1 = half[1].v0 = r.v0 + (r.v1 - r.v0) / 2;
    float nearest[2];
    bool met[2];
    for (int i = 0; i < 2; i++) met[i] = tiles_met(d, f, placed, &half[i], &nearest[i]);
    int first = met[0] && met[1] && nearest[1] < nearest[0];
    for (int i = 0; i < 2; i++)
        if (met[first ^ i]) draw_tiles(d, f, placed, half[first ^ i]);
}

static const double LARGEST_TILE = 1e15;

static bool tiles_of_cell(const SkinCell *cell, int reach, TileRange *r) {
    double lo[2] = {VTS_INFINITY, VTS_INFINITY}, hi[2] = {-VTS_INFINITY, -VTS_INFINITY};
    for (int i = 0; i < (cell->triangle ? 3 : 4); i++) {
        double a = i & 1, b = i >> 1, at[2] = {bilinear(&cell->u, a, b), bilinear(&cell->v, a, b)};
        for (int k = 0; k < 2; k++) lo[k] = fmin(lo[k], at[k]), hi[k] = fmax(hi[k], at[k]);
    }
    for (int k = 0; k < 2; k++)
        if (!(fabs(lo[k]) < LARGEST_TILE && fabs(hi[k]) < LARGEST_TILE)) return false;
    /* A tile that the cell touches but for rounding is not worth the way. */
    const double hair = 1e-9;
    *r = (TileRange){(int64_t)floor(lo[0] + hair) - reach, (int64_t)ceil(hi[0] - hair) + reach, (int64_t)floor(lo[1] + hair) - reach,
                     (int64_t)ceil(hi[1] - hair) + reach};
    r->u1 = r->u1 > r->u0 ? r->u1 : r->u0 + 1;
    r->v1 = r->v1 > r->v0 ? r->v1 : r->v0 + 1;
    return true;
}

static void draw_cell(BeamDraft *draft, const CompiledSkin *skin, const SkinCell *cell) {
    CellFrame f;
    Drawing d = {.draft = draft, .skin = skin};
    if (cell->side == CELL_FLAT || !frame_cell(&f, draft->beam, cell)) return; /* a layer without height holds nothing */
    for (size_t i = 0; i < skin->texel_count; i++) {
        const PlacedTexel *placed = &skin->texels[i];
        TileRange range;
        if (placed->family_size && tiles_of_cell(cell, placed->reach, &range)) draw_tiles(&d, &f, placed, range);
    }
}

/* ---- the cells in the beam ---- */

size_t beam_most_cells(const CompiledScene *compiled) {
    size_t count = 0;
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes) count += compiled->skins[i].cell_count;
    return count;
}

typedef struct Gathering {
    BeamDraft *draft;
    const CompiledScene *compiled;
    uint32_t skin, count;
} Gathering;

static bool meets(const void *context, const Box3 *box) { return beam_meets_box(((const Gathering *)context)->draft->beam, box); }

/* The least q.z of a box. */
static float nearest_of(const Beam *beam, const Box3 *box) {
    Vec3 r = beam->rows[2], middle = vec3_scale(vec3_add(box->min, box->max), 0.5), half = vec3_scale(vec3_sub(box->max, box->min), 0.5);
    return (float)(beam_point(beam, middle).z - fabs(r.x) * half.x - fabs(r.y) * half.y - fabs(r.z) * half.z);
}

static bool ordered(const Beam *beam) { return beam->perspective && !beam->light; }

static void gather_cell(void *context, uint32_t cell) {
    Gathering *g = context;
    const Beam *beam = g->draft->beam;
    const CompiledSkin *skin = &g->compiled->skins[g->skin];
    float nearest = ordered(beam) ? nearest_of(beam, &skin->cells[cell].bounds) : 0;
    /* q.z is at most |rows[2]| times the distance. */
    if (ordered(beam) && (double)nearest > 1.42 * skin->exact_to * vec3_length(beam->rows[2])) return;
    g->draft->cells[g->count++] = (BeamCell){g->skin, cell, nearest};
}

static void gather_skin(void *context, uint32_t skin) {
    Gathering *g = context;
    g->skin = skin;
    if (g->compiled->skins[skin].boxes) box_tree_descend(g->compiled->skins[skin].boxes, meets, gather_cell, g);
}

static int nearer_first(const void *a, const void *b) {
    const BeamCell *x = a, *y = b;
    if (x->nearest != y->nearest) return x->nearest < y->nearest ? -1 : 1;
    if (x->skin != y->skin) return x->skin < y->skin ? -1 : 1;
    return x->cell < y->cell ? -1 : 1;
}

/* The farthest that any sample sees yet: what lies beyond is hidden. Samples without a limit see everything. */
static void draw_in_limit(Beam *beam) {
    const BeamSamples *s = &beam->samples;
    uint32_t count = s->first[s->columns * s->rows];
    float least = INFINITY;
    for (uint32_t i = 0; i < count; i++) least = float_min(least, s->key[i]);
    if (least > 0 && 1 / (double)least < beam->farthest) beam->farthest = 1 / (double)least;
}

uint32_t beam_gather(BeamDraft *draft, const CompiledScene *compiled) {
    Gathering g = {draft, compiled, 0, 0};
    box_tree_descend(compiled->skin_tree, meets, gather_skin, &g);
    return g.count;
}

void beam_draw_cells(BeamDraft *draft, const CompiledScene *compiled, uint32_t count) {
    enum { CELLS_BETWEEN_LIMITS = 4 };
    Beam *beam = draft->beam;
    bool sorted = ordered(beam);
    if (sorted) qsort(draft->cells, count, sizeof *draft->cells, nearer_first);
    for (uint32_t i = 0; i < count; i++) {
        const BeamCell *at = &draft->cells[i];
        const CompiledSkin *skin = &compiled->skins[at->skin];
        if (sorted && (double)at->nearest > beam->farthest) break;
        beam->exact_to = beam->perspective || beam->light ? (float)skin->exact_to : 1;
        draw_cell(draft, skin, &skin->cells[at->cell]);
        if (sorted && i % CELLS_BETWEEN_LIMITS == 0) draw_in_limit(beam);
    }
}
