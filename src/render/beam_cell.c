#include "render/beam_cell.h"

/* Slack of boxes against rounding. */
static const float HAIR = 1e-5f;
/* Determinants up to this part of the squared rates are nothing but rounding. */
static const double SINGULAR = 1e-12;

double bilinear_at(const Bilinear *f, double a, double b) { return f->c[0] + f->c[1] * a + (f->c[2] + f->c[3] * a) * b; }

/* ---- texture coordinates ---- */

typedef struct Rates {
    double ua, ub, va, vb, det;
} Rates;

static Rates rates_at(const SkinCell *cell, double a, double b) {
    const double *u = cell->u.c, *v = cell->v.c;
    Rates r = {u[1] + u[3] * b, u[2] + u[3] * a, v[1] + v[3] * b, v[2] + v[3] * a, 0};
    r.det = r.ua * r.vb - r.ub * r.va;
    return r;
}

/* The determinant is linear in a and b: its extremes lie at corners. */
static void det_range(const SkinCell *cell, double *least, double *most) {
    *least = VTS_INFINITY, *most = -VTS_INFINITY;
    for (int i = 0; i < 4; i++) {
        double det = rates_at(cell, i & 1, i >> 1).det;
        *least = fmin(*least, det), *most = fmax(*most, det);
    }
}

bool cell_is_tame(const SkinCell *cell) {
    double least, most;
    if (cell->triangle) return true;
    det_range(cell, &least, &most);
    return least > 0 ? least >= 0.5 * most : most < 0 && most <= 0.5 * least;
}

bool cell_is_singular(const SkinCell *cell) {
    const double *u = cell->u.c, *v = cell->v.c;
    double scale = fabs(u[1]) + fabs(u[2]) + fabs(u[3]) + fabs(v[1]) + fabs(v[2]) + fabs(v[3]), least, most;
    det_range(cell, &least, &most);
    return !(fmax(fabs(least), fabs(most)) > SINGULAR * scale * scale);
}

/* From (a, b) on, with `size` times the rates. */
static Bilinear quarter_of(const Bilinear *f, double a, double b, double size) {
    const double *c = f->c;
    return (Bilinear){{bilinear_at(f, a, b), (c[1] + c[3] * b) * size, (c[2] + c[3] * a) * size, c[3] * size * size}};
}

static BilinearVec quarter_of_vec(const BilinearVec *f, double a, double b, double size) {
    const Vec3 *c = f->c;
    Vec3 along = vec3_madd(c[1], c[3], b), across = vec3_madd(c[2], c[3], a);
    return (BilinearVec){{vec3_madd(vec3_madd(c[0], c[1], a), across, b), vec3_scale(along, size), vec3_scale(across, size), vec3_scale(c[3], size * size)}};
}

SkinCell cell_quarter(const SkinCell *cell, int quarter) {
    double a = quarter & 1 ? 0.5 : 0, b = quarter & 2 ? 0.5 : 0, size = cell->triangle && quarter == 3 ? -0.5 : 0.5;
    SkinCell out = *cell;
    out.foot = quarter_of_vec(&cell->foot, a, b, size), out.height = quarter_of_vec(&cell->height, a, b, size);
    out.u = quarter_of(&cell->u, a, b, size), out.v = quarter_of(&cell->v, a, b, size);
    out.w_foot = quarter_of(&cell->w_foot, a, b, size), out.w_tip = quarter_of(&cell->w_tip, a, b, size);
    return out;
}

/* ---- the frame ---- */

static void set_column(CellFrame *f, int i, Vec3 c) { f->x[i] = (float)c.x, f->y[i] = (float)c.y, f->z[i] = (float)c.z; }

/* The largest change of the layer's thickness in w' along a and b, relative to the least. */
static void taper_of(const SkinCell *cell, double *along_a, double *along_b, double *twist) {
    const double *foot = cell->w_foot.c, *tip = cell->w_tip.c;
    double least = VTS_INFINITY;
    for (int i = 0; i < 4; i++) least = fmin(least, fabs(bilinear_at(&cell->w_tip, i & 1, i >> 1) - bilinear_at(&cell->w_foot, i & 1, i >> 1)));
    least = fmax(least, 1e-3 * (fabs(foot[0]) + fabs(tip[0])));
    double skew = fabs(tip[3] - foot[3]);
    *along_a = (fabs(tip[1] - foot[1]) + skew) / least;
    *along_b = (fabs(tip[2] - foot[2]) + skew) / least;
    *twist = (fabs(foot[3]) + skew) / least;
}

/* How far lines of texture space bend: by the mapping to the scene, and by that to (a, b, w). */
static void set_bends(CellFrame *f) {
    const SkinCell *cell = f->cell;
    const Vec3 *p = cell->foot.c, *h = cell->height.c;
    double twist = vec3_length(h[3]), tilt_a = vec3_length(h[1]), tilt_b = vec3_length(h[2]), ab = vec3_length(p[3]) + twist, aw = tilt_a + twist, bw = tilt_b + twist;
    if (!f->affine) {
        double taper_a, taper_b, taper_ab, high = vec3_length(h[0]) + tilt_a + tilt_b + twist;
        taper_of(cell, &taper_a, &taper_b, &taper_ab);
        ab += f->bent_a * (vec3_length(p[1]) + tilt_a + ab) + f->bent_b * (vec3_length(p[2]) + tilt_b + ab) + high * taper_ab;
        aw += high * taper_a;
        bw += high * taper_b;
    }
    f->bend_ab = (float)(ab / 4), f->bend_aw = (float)(aw / 4), f->bend_bw = (float)(bw / 4);
}

/* (u, v) → (a, b) as it is at a place. */
static void set_linear(CellFrame *f, const Rates *r, double a, double b) {
    double u = bilinear_at(&f->cell->u, a, b), v = bilinear_at(&f->cell->v, a, b);
    f->a_u = r->vb / r->det, f->a_v = -r->ub / r->det, f->b_u = -r->va / r->det, f->b_v = r->ua / r->det;
    f->a_0 = a - f->a_u * u - f->a_v * v;
    f->b_0 = b - f->b_u * u - f->b_v * v;
}

bool cell_frame(CellFrame *f, const Beam *beam, const SkinCell *cell) {
    f->cell = cell;
    set_column(f, 0, beam_point(beam, cell->foot.c[0]));
    for (int i = 1; i < 4; i++) set_column(f, i, beam_vector(beam, cell->foot.c[i]));
    for (int i = 0; i < 4; i++) set_column(f, 4 + i, beam_vector(beam, cell->height.c[i]));
    f->scene[0] = vec3f(0, 0, 0);
    for (int i = 1; i < 4; i++) f->scene[i] = vec3f_from(cell->foot.c[i]);
    for (int i = 0; i < 4; i++) f->scene[4 + i] = vec3f_from(cell->height.c[i]);
    const double *u = cell->u.c, *v = cell->v.c, *foot = cell->w_foot.c, *tip = cell->w_tip.c;
    double scale = fabs(u[1]) + fabs(u[2]) + fabs(v[1]) + fabs(v[2]), least, most;
    Rates r = rates_at(cell, 0.5, 0.5);
    if (!(fabs(r.det) > SINGULAR * scale * scale)) return false;
    set_linear(f, &r, 0.5, 0.5);
    f->w_w = 1 / (tip[0] - foot[0]);
    f->w_0 = -foot[0] * f->w_w;
    double steepest = 0;
    for (int i = 1; i < 4; i++) steepest = fmax(steepest, fmax(fabs(foot[i]), fabs(tip[i])));
    f->affine = fabs(u[3]) + fabs(v[3]) <= 1e-9 * scale && steepest <= 1e-9 * fabs(tip[0] - foot[0]);
    if (f->affine && !isfinite(f->w_w)) return false;
    det_range(cell, &least, &most);
    double smallest = fmax(fmin(fabs(least), fabs(most)), 1e-3 * fmax(fabs(least), fabs(most)));
    f->bent_a = cell->triangle ? 0 : fabs(v[2] * u[3] - u[2] * v[3]) / smallest;
    f->bent_b = cell->triangle ? 0 : fabs(u[1] * v[3] - v[1] * u[3]) / smallest;
    set_bends(f);
    return true;
}

static inline float along(const float c[8], float a, float b, float w) {
    float ab = a * b;
    return c[0] + c[1] * a + c[2] * b + c[3] * ab + w * (c[4] + c[5] * a + c[6] * b + c[7] * ab);
}

Vec3f cell_frame_point(const CellFrame *f, float a, float b, float w) { return vec3f(along(f->x, a, b, w), along(f->y, a, b, w), along(f->z, a, b, w)); }

/* Written so that compilers make vectors of it. */
void cell_frame_points(const CellFrame *f, int count, const float *restrict a, const float *restrict b, const float *restrict w, float *restrict x,
                       float *restrict y, float *restrict z) {
    for (int i = 0; i < count; i++) {
        x[i] = along(f->x, a[i], b[i], w[i]);
        y[i] = along(f->y, a[i], b[i], w[i]);
        z[i] = along(f->z, a[i], b[i], w[i]);
    }
}

static Vec3f place_in_scene(const CellFrame *f, Vec3f p) {
    const Vec3f *c = f->scene;
    const float ab = p.x * p.y;
    Vec3f foot = vec3f_madd(vec3f_madd(vec3f_madd(c[0], c[1], p.x), c[2], p.y), c[3], ab);
    return vec3f_madd(foot, vec3f_madd(vec3f_madd(vec3f_madd(c[4], c[5], p.x), c[6], p.y), c[7], ab), p.z);
}

/* Half way along an edge a product of two coordinates is a quarter of that of their changes below the mean of its ends, and a·b·w that much for each two of them
 * times the third; `off` is what texture coordinates add. What that has across the edge is seen. */
static inline bool bends(const CellFrame *f, Vec3f p, Vec3f q, Vec3f off, float tolerance) {
    const Vec3f *c = f->scene, way = vec3f_sub(q, p), at = vec3f_scale(vec3f_add(p, q), 0.5f);
    const Vec3f c_ab = vec3f_madd(c[3], c[7], at.z), c_aw = vec3f_madd(c[5], c[7], at.y), c_bw = vec3f_madd(c[6], c[7], at.x);
    const Vec3f by_a = vec3f_madd(vec3f_madd(c[1], c_ab, at.y), c[5], at.z), by_b = vec3f_madd(vec3f_madd(c[2], c_ab, at.x), c[6], at.z);
    const Vec3f by_w = vec3f_madd(vec3f_madd(c[4], c_aw, at.x), c[6], at.y);
    const Vec3f edge = vec3f_madd(vec3f_madd(vec3f_scale(by_a, way.x), by_b, way.y), by_w, way.z);
    const Vec3f bow = vec3f_madd(vec3f_madd(vec3f_madd(off, c_ab, -0.25f * way.x * way.y), c_aw, -0.25f * way.x * way.z), c_bw, -0.25f * way.y * way.z);
    const float along = vec3f_dot(bow, edge), length = vec3f_dot(edge, edge);
    return vec3f_dot(bow, bow) - along * (along / length) > tolerance * tolerance; /* no higher power of lengths: floats hold few */
}

bool cell_frame_bends(const CellFrame *f, Vec3f p, Vec3f q, Vec3f middle, float tolerance) {
    if (cell_frame_bend(f, fabsf(q.x - p.x), fabsf(q.y - p.y), fabsf(q.z - p.z)) <= tolerance) return false;
    Vec3f off = {0, 0, 0};
    if (!f->affine) off = vec3f_sub(place_in_scene(f, middle), place_in_scene(f, vec3f_scale(vec3f_add(p, q), 0.5f)));
    return bends(f, p, q, off, tolerance);
}

/* Written so that compilers make vectors of it. */
void cell_frame_bends_of(const CellFrame *f, int count, const float *restrict pa, const float *restrict pb, const float *restrict pw, const float *restrict qa,
                         const float *restrict qb, const float *restrict qw, float tolerance, uint32_t *restrict bent) {
    const CellFrame own = *f; /* which `bent` is no part of */
    for (int i = 0; i < count; i++) bent[i] = bends(&own, vec3f(pa[i], pb[i], pw[i]), vec3f(qa[i], qb[i], qw[i]), vec3f(0, 0, 0), tolerance);
}

void cell_frame_linearise(CellFrame *f, double u, double v) {
    double a = 0.5, b = 0.5;
    for (int i = 0; i < 4; i++) {
        Rates r = rates_at(f->cell, a, b);
        double du = u - bilinear_at(&f->cell->u, a, b), dv = v - bilinear_at(&f->cell->v, a, b);
        if (!(fabs(r.det) > 0)) return;
        a = double_clamp(a + (r.vb * du - r.ub * dv) / r.det, 0, 1);
        b = double_clamp(b + (r.ua * dv - r.va * du) / r.det, 0, 1);
    }
    Rates r = rates_at(f->cell, a, b);
    if (fabs(r.det) > 0) set_linear(f, &r, a, b);
}

/* ---- boxes ---- */

/* Written so that compilers make vectors of it. */
void beam_outcodes(const Beam *beam, int count, const float *restrict x, const float *restrict y, const float *restrict z, uint32_t *restrict codes) {
    float columns = (float)beam->samples.columns, rows = (float)beam->samples.rows, near = (float)beam->nearest, far = (float)beam->farthest;
    if (beam->perspective)
        for (int i = 0; i < count; i++)
            codes[i] = (uint32_t)(x[i] < 0) | (uint32_t)(x[i] > columns * z[i]) << 1 | (uint32_t)(y[i] < 0) << 2 | (uint32_t)(y[i] > rows * z[i]) << 3 |
                       (uint32_t)(z[i] < near) << 4 | (uint32_t)(z[i] > far) << 5;
    else
        for (int i = 0; i < count; i++)
            codes[i] = (uint32_t)(x[i] < 0) | (uint32_t)(x[i] > columns) << 1 | (uint32_t)(y[i] < 0) << 2 | (uint32_t)(y[i] > rows) << 3 |
                       (uint32_t)(z[i] > near) << 4 | (uint32_t)(z[i] < far) << 5;
}

/* What lies between three pairs of planes of skin space is within the hull of its eight corners, as the mapping is linear along
 * each axis. */
bool cell_box_met(const Beam *beam, const CellFrame *f, const CellBox *box, float *nearest) {
    enum { CORNERS = 8 };
    const float a[CORNERS] = {box->a0, box->a1, box->a0, box->a1, box->a0, box->a1, box->a0, box->a1};
    const float b[CORNERS] = {box->b0, box->b0, box->b1, box->b1, box->b0, box->b0, box->b1, box->b1};
    const float w[CORNERS] = {box->w0, box->w0, box->w0, box->w0, box->w1, box->w1, box->w1, box->w1};
    float x[CORNERS], y[CORNERS], z[CORNERS], least = INFINITY, most = -INFINITY;
    uint32_t codes[CORNERS], outside = ~0u;
    cell_frame_points(f, CORNERS, a, b, w, x, y, z);
    beam_outcodes(beam, CORNERS, x, y, z, codes);
    for (int i = 0; i < CORNERS; i++) {
        outside &= codes[i];
        least = float_min(least, z[i]), most = float_max(most, z[i]);
    }
    *nearest = beam->perspective ? least : -most;
    return outside == 0;
}

/* A box of (a, b), middle and halves. */
typedef struct Patch {
    double a, b, half_a, half_b;
} Patch;

static bool intersect(double *middle, double *half, double other, double other_half) {
    double lo = fmax(*middle - *half, other - other_half), hi = fmin(*middle + *half, other + other_half);
    *middle = (lo + hi) / 2, *half = (hi - lo) / 2;
    return lo <= hi;
}

/* An interval Newton step: of places in the patch, those with these coordinates lie within the linear map's image of them, widened by
 * what the bilinear term is over the patch. */
static bool narrow(const CellFrame *f, const TextureBox *in, Patch *p) {
    Rates r = rates_at(f->cell, p->a, p->b);
    if (!(fabs(r.det) > 0)) return true;
    double du = in->u - bilinear_at(&f->cell->u, p->a, p->b), dv = in->v - bilinear_at(&f->cell->v, p->a, p->b), per = 1 / r.det;
    double bent = p->half_a * p->half_b, reach_a = f->bent_a * bent, reach_b = f->bent_b * bent;
    for (int i = 0; i < 2; i++) {
        reach_a += fabs((r.vb * in->side_u[i] - r.ub * in->side_v[i]) * per);
        reach_b += fabs((r.ua * in->side_v[i] - r.va * in->side_u[i]) * per);
    }
    double a = p->a + (r.vb * du - r.ub * dv) * per, b = p->b + (r.ua * dv - r.va * du) * per, hair = (double)HAIR;
    if (!isfinite(a + b + reach_a + reach_b)) return true;
    return intersect(&p->a, &p->half_a, a, reach_a + hair) && intersect(&p->b, &p->half_b, b, reach_b + hair);
}

/* Heights at the corners of the patch: between them they are monotone, as the quotient of two functions linear along each axis. */
static void heights(const CellFrame *f, const Patch *p, const TextureBox *in, double *lowest, double *highest) {
    int rising = 0;
    *lowest = VTS_INFINITY, *highest = -VTS_INFINITY;
    for (int i = 0; i < 4; i++) {
        double a = p->a + (i & 1 ? p->half_a : -p->half_a), b = p->b + (i & 2 ? p->half_b : -p->half_b);
        double foot = bilinear_at(&f->cell->w_foot, a, b), thick = bilinear_at(&f->cell->w_tip, a, b) - foot;
        double w0 = (in->w0 - foot) / thick, w1 = (in->w1 - foot) / thick;
        rising += thick > 0 ? 1 : -1;
        *lowest = fmin(*lowest, fmin(w0, w1)), *highest = fmax(*highest, fmax(w0, w1));
    }
    if (rising != 4 && rising != -4) *lowest = 0, *highest = 1;
}

bool cell_box_clip(const SkinCell *cell, CellBox *box) {
    box->a0 = float_max(box->a0, 0), box->a1 = float_min(box->a1, 1);
    box->b0 = float_max(box->b0, 0), box->b1 = float_min(box->b1, 1);
    box->w0 = float_max(box->w0, 0), box->w1 = float_min(box->w1, 1);
    return box->a0 <= box->a1 && box->b0 <= box->b1 && box->w0 <= box->w1 && (!cell->triangle || box->a0 + box->b0 <= 1);
}

bool cell_box_of(const CellFrame *f, const TextureBox *in, CellBox *box) {
    Patch p = {0.5, 0.5, 0.5, 0.5};
    double lowest, highest;
    for (int i = 0; i < (f->affine ? 1 : 3); i++)
        if (!narrow(f, in, &p)) return false;
    heights(f, &p, in, &lowest, &highest);
    *box = (CellBox){(float)(p.a - p.half_a), (float)(p.a + p.half_a), (float)(p.b - p.half_b), (float)(p.b + p.half_b), (float)lowest - HAIR, (float)highest + HAIR};
    return cell_box_clip(f->cell, box);
}
