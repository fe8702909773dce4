#include "render/beam_skin.h"

#include "render/beam_cell.h"

#include <stdlib.h>

/* DEEPEST_CUT: how often an edge is cut in two where the mapping bends it. */
enum { NEWTON_STEPS = 3, DEEPEST_CUT = 5, MOST_CLIPPED = 9, DEEPEST_NODE = 512, DEEPEST_PART = 4, DEEPEST_VAST_PART = 24 };
/* Corners this little outside of a cell count as inside: tiles that end with the cell do so but for rounding. */
static const float HAIR = 1e-5f;
/* Cells of more tiles than this along a side are drawn in parts: floats tell places in a wider one less well than shadows of blades on themselves
 * need. */
static const double MOST_TILES_ACROSS = 64;

/* ---- triangles ---- */

/* One copy in one cell: box coordinates of the texel → (a, b, w). */
typedef struct CopyFrame {
    const CellFrame *frame;
    const PlacedTexel *placed;
    const TexelCopy *copy;
    double u_x, u_z, u_0, v_x, v_z, v_0, w_y, w_0; /* (x, y, z) → (u, v, w') */
    float a_x, a_z, a_0, b_x, b_z, b_0, y_w, y_0;  /* (x, y, z) → (a, b, w) where that is affine */
    int period;                                    /* of cyclic y */
    float tolerance;                               /* of bent triangles, scene units */
} CopyFrame;

typedef struct Drawing {
    BeamDraft *draft;
    const CompiledSkin *skin;
    const SkinCell *cell;     /* of which a part is drawn: its (a, b) times `size`, plus these */
    double from_a, from_b, size;
    CopyFrame at;
    const TexelCluster *cluster;
    Vec3f walls[4];           /* of the part, in box coordinates of a copy: inside where x·p.x + y·p.z + z >= 0 */
} Drawing;

static bool frame_copy(CopyFrame *c, const CellFrame *f, const PlacedTexel *placed, const TexelCopy *copy, int period) {
    double det = copy->xu * copy->zv - copy->xv * copy->zu;
    *c = (CopyFrame){.frame = f, .placed = placed, .copy = copy, .period = period};
    if (!(fabs(det) > 0) || !(copy->inverse_scale > 0)) return false;
    c->u_x = copy->zv / det, c->u_z = -copy->xv / det, c->u_0 = -(c->u_x * copy->x0 + c->u_z * copy->z0);
    c->v_x = -copy->zu / det, c->v_z = copy->xu / det, c->v_0 = -(c->v_x * copy->x0 + c->v_z * copy->z0);
    c->w_y = 1 / copy->inverse_scale, c->w_0 = period / copy->inverse_scale;
    CellFrame at_middle = *f;
    if (!f->affine) {
        cell_frame_linearise(&at_middle, c->u_x * 0.5 + c->u_z * 0.5 + c->u_0, c->v_x * 0.5 + c->v_z * 0.5 + c->v_0);
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

static Vec3f place_of(const CopyFrame *c, Vec3f x) {
    float a, b, w;
    to_skin(c, 1, &x.x, &x.y, &x.z, &a, &b, &w);
    return vec3f(a, b, w);
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

static void keep_facet(const Drawing *d, const Vec3f corner[3], int triangle) {
    BeamDraft *draft = d->draft;
    BeamFacet *f = &draft->facets[draft->facet_count++];
    *f = (BeamFacet){.skin = d->skin, .cell = d->cell, .placed = d->at.placed, .copy = *d->at.copy, .cluster = d->cluster, .triangle = (uint8_t)triangle,
                     .round = d->cluster->normals, .layer = d->cluster->layers[triangle], .period = d->at.period, .from_a = d->from_a, .from_b = d->from_b, .size = d->size};
    for (int i = 0; i < 3; i++) f->corner[i] = corner[i];
    if (draft->facet_count == draft->facet_capacity) drop_hidden(draft);
}

static Vec3 cluster_corner(const TexelCluster *cluster, int vertex) {
    return vec3((double)cluster->x[vertex], (double)cluster->y[vertex], (double)cluster->z[vertex]);
}

Vec3 beam_facet_normal(const BeamFacet *f, Vec3 in) {
    const uint8_t *v = f->cluster->triangles[f->triangle];
    Vec3 extent = vec3_from_f(f->copy.texel->extent), a = cluster_corner(f->cluster, v[0]), p = vec3_mul(vec3_sub(in, a), extent);
    Vec3 e1 = vec3_mul(vec3_sub(cluster_corner(f->cluster, v[1]), a), extent), e2 = vec3_mul(vec3_sub(cluster_corner(f->cluster, v[2]), a), extent);
    Vec3 flat = vec3_cross(e1, e2);
    double area = vec3_length_squared(flat);
    if (!f->cluster->normals || !(area > 0)) return vec3_normalize(flat);
    p.y -= f->period * extent.y;
    double s = vec3_dot(vec3_cross(p, e2), flat) / area, t = vec3_dot(vec3_cross(e1, p), flat) / area;
    Vec3 round = vec3_normalize(vec3_from_f(facet_normals_at(&f->cluster->normals[f->triangle], (float)s, (float)t)));
    return vec3_length_squared(round) > 0 ? round : vec3_normalize(flat);
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
    const float x[3] = {q[0].x, q[1].x, q[2].x}, y[3] = {q[0].y, q[1].y, q[2].y}, z[3] = {q[0].z, q[1].z, q[2].z};
    uint32_t codes[3];
    beam_outcodes(beam, 3, x, y, z, codes);
    return codes[0] & codes[1] & codes[2];
}

/* One triangle of the cluster or a part of it, in the cell and in the beam. */
typedef struct Piece {
    Vec3f p[3], q[3];
    Vec3f x[3];  /* box coordinates, where texture coordinates are not affine */
    int triangle;
    bool inside; /* the cell as a whole */
} Piece;

/* Of what lies in the cell and before the beam's near end as a whole. */
static void draw_flat(Drawing *d, const Piece *piece) {
    Beam *beam = d->draft->beam;
    const CellFrame *f = d->at.frame;
    Vec3f part[MOST_CLIPPED];
    int count = 3;
    d->draft->triangles++;
    for (int i = 0; i < 3; i++) part[i] = piece->q[i];
    if (!piece->inside) {
        count = clip_to_cell(piece->p, f->cell->triangle, part);
        for (int i = 0; i < count; i++) part[i] = cell_frame_point(f, part[i].x, part[i].y, part[i].z);
    }
    if (beam_draw(beam, part, count, d->draft->facet_count + 1) && d->draft->facets) keep_facet(d, piece->p, piece->triangle);
}

/* The middles of a piece's edges, from each corner to the next. */
typedef struct Middles {
    Vec3f p[3], x[3];
    bool bent[3]; /* the mapping bends the edge more than is tolerated: the same whichever of its two triangles asks */
    int bent_count;
} Middles;

static Middles middles_of(const Drawing *d, const Piece *piece) {
    const CellFrame *f = d->at.frame;
    Middles m = {.bent_count = 0};
    for (int i = 0; i < 3; i++) {
        const int next = (i + 1) % 3;
        m.p[i] = vec3f_scale(vec3f_add(piece->p[i], piece->p[next]), 0.5f);
        m.x[i] = vec3f_scale(vec3f_add(piece->x[i], piece->x[next]), 0.5f);
        if (!f->affine) m.p[i] = place_of(&d->at, m.x[i]);
        m.bent[i] = cell_frame_bends(f, piece->p[i], piece->p[next], m.p[i], d->at.tolerance);
        m.bent_count += m.bent[i];
    }
    return m;
}

static void draw_bent(Drawing *d, const Piece *piece, int depth);

/* Three of the six corners of what is cut: those of the piece, 0 … 2, and the middles of its edges, 3 … 5. */
static void draw_cut(Drawing *d, const Piece *piece, const Middles *m, int i, int j, int k, int depth) {
    const int corner[3] = {i, j, k};
    Piece part = {.triangle = piece->triangle, .inside = piece->inside};
    for (int e = 0; e < 3; e++) {
        const int c = corner[e];
        part.p[e] = c < 3 ? piece->p[c] : m->p[c - 3], part.x[e] = c < 3 ? piece->x[c] : m->x[c - 3];
        part.q[e] = c < 3 ? piece->q[c] : cell_frame_point(d->at.frame, part.p[e].x, part.p[e].y, part.p[e].z);
    }
    draw_bent(d, &part, depth);
}

/* Cut in the middles of edges, and again, until the mapping bends none of them more than is tolerated: only of those that it bends, as blades are long and thin,
 * and so that neighbours meet without a gap. */
static void draw_bent(Drawing *d, const Piece *piece, int depth) {
    if (outside_beam(d->draft->beam, piece->q)) return;
    const Middles m = middles_of(d, piece);
    if (depth == DEEPEST_CUT || m.bent_count == 0) {
        draw_flat(d, piece);
        return;
    }
    int i = 0; /* of one bent edge it is the first corner, of two that of the straight one */
    while (m.bent_count < 3 && m.bent[i] != (m.bent_count == 1)) i++;
    const int j = (i + 1) % 3, k = (i + 2) % 3, below = depth + 1;
    if (m.bent_count == 1) {
        draw_cut(d, piece, &m, i, 3 + i, k, below);
        draw_cut(d, piece, &m, 3 + i, j, k, below);
        return;
    }
    draw_cut(d, piece, &m, k, 3 + k, 3 + j, below);
    if (m.bent_count == 2) {
        draw_cut(d, piece, &m, i, j, 3 + j, below);
        draw_cut(d, piece, &m, i, 3 + j, 3 + k, below);
        return;
    }
    draw_cut(d, piece, &m, i, 3 + i, 3 + k, below);
    draw_cut(d, piece, &m, j, 3 + j, 3 + i, below);
    draw_cut(d, piece, &m, 3 + i, 3 + j, 3 + k, below);
}

/* The bit after those of beam_outcodes(): out of the cell. */
enum { OUT_OF_CELL = 64 };

/* The walls of the cell as a copy sees them: straight lines of texture space. */
static void set_walls(Drawing *d) {
    const SkinCell *cell = d->at.frame->cell;
    const TexelCopy *copy = d->at.copy;
    int corners = cell->triangle ? 3 : 4;
    static const uint8_t around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, triangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    double x[4], z[4], area = 0;
    for (int i = 0; i < corners; i++) {
        const uint8_t *at = cell->triangle ? triangle[i] : around[i];
        double u = bilinear_at(&cell->u, at[0], at[1]), v = bilinear_at(&cell->v, at[0], at[1]);
        x[i] = copy->xu * u + copy->xv * v + copy->x0, z[i] = copy->zu * u + copy->zv * v + copy->z0;
    }
    for (int i = 0; i < corners; i++) area += x[i] * z[(i + 1) % corners] - x[(i + 1) % corners] * z[i];
    for (int i = 0; i < 4; i++) {
        int k = i % corners, next = (k + 1) % corners;
        double nx = z[k] - z[next], nz = x[next] - x[k], length = sqrt(nx * nx + nz * nz), per = length > 0 ? (area < 0 ? -1 : 1) / length : 0;
        d->walls[i] = vec3f((float)(nx * per), (float)(nz * per), (float)(-(nx * x[k] + nz * z[k]) * per));
    }
}

/* A triangle that reaches out of a cell where texture coordinates are not affine is cut before it is mapped: beyond the cell there may be no
 * way back from them. */
static void draw_across(Drawing *d, const Vec3f corner[3], int triangle) {
    Vec3f in[MOST_CLIPPED] = {corner[0], corner[1], corner[2]}, out[MOST_CLIPPED];
    int count = 3;
    for (int e = 0; e < 4; e++) {
        int kept = 0;
        for (int i = 0; i < count; i++) {
            Vec3f a = in[i], b = in[(i + 1) % count], wall = d->walls[e];
            float da = wall.x * a.x + wall.y * a.z + wall.z, db = wall.x * b.x + wall.y * b.z + wall.z;
            if (da >= 0) out[kept++] = a;
            if ((da >= 0) != (db >= 0)) out[kept++] = vec3f_madd(a, vec3f_sub(b, a), da / (da - db));
        }
        count = kept;
        for (int i = 0; i < kept; i++) in[i] = out[i];
    }
    for (int i = 2; i < count; i++) {
        Piece piece = {.x = {in[0], in[i - 1], in[i]}, .triangle = triangle};
        for (int k = 0; k < 3; k++) {
            Vec3f p = place_of(&d->at, piece.x[k]);
            piece.p[k] = vec3f(float_clamp(p.x, 0, 1), float_clamp(p.y, 0, 1), p.z);
            piece.q[k] = cell_frame_point(d->at.frame, p.x, p.y, p.z);
        }
        draw_bent(d, &piece, 0);
    }
}

/* A cluster's vertices: in the cell, in the beam, and as they are seen. */
typedef struct MappedVertices {
    float a[CLUSTER_VERTICES], b[CLUSTER_VERTICES], w[CLUSTER_VERTICES];
    float x[CLUSTER_VERTICES], y[CLUSTER_VERTICES], z[CLUSTER_VERTICES];
    float seen_x[CLUSTER_VERTICES], seen_y[CLUSTER_VERTICES], key[CLUSTER_VERTICES]; /* of those that lie before the near end */
    uint32_t code[CLUSTER_VERTICES];
} MappedVertices;

/* Written so that compilers make vectors of it. */
static void map_vertices(const Drawing *d, const TexelCluster *cluster, MappedVertices *v) {
    const Beam *beam = d->draft->beam;
    const bool perspective = beam->perspective, triangle = d->at.frame->cell->triangle;
    const int count = cluster->vertex_count;
    to_skin(&d->at, count, cluster->x, cluster->y, cluster->z, v->a, v->b, v->w);
    cell_frame_points(d->at.frame, count, v->a, v->b, v->w, v->x, v->y, v->z);
    beam_outcodes(beam, count, v->x, v->y, v->z, v->code);
    for (int i = 0; i < count; i++) {
        float a = v->a[i], b = v->b[i], w = v->w[i], most_b = triangle ? 1 - a : 1;
        uint32_t in = (uint32_t)(a >= -HAIR) & (uint32_t)(a <= 1 + HAIR) & (uint32_t)(b >= -HAIR) & (uint32_t)(b <= most_b + HAIR) &
                      (uint32_t)(w >= -HAIR) & (uint32_t)(w <= 1 + HAIR);
        v->code[i] |= in ? 0 : OUT_OF_CELL;
        float key = perspective ? 1 / v->z[i] : 1;
        v->seen_x[i] = v->x[i] * key, v->seen_y[i] = v->y[i] * key, v->key[i] = perspective ? key : v->z[i];
    }
}

static Vec3f vertex_in_box(const TexelCluster *cluster, int i) { return vec3f(cluster->x[i], cluster->y[i], cluster->z[i]); }
static Vec3f vertex_in_cell(const MappedVertices *v, int i) { return vec3f(v->a[i], v->b[i], v->w[i]); }
static Vec3f vertex_in_beam(const MappedVertices *v, int i) { return vec3f(v->x[i], v->y[i], v->z[i]); }
static Vec3f vertex_seen(const MappedVertices *v, int i) { return vec3f(v->seen_x[i], v->seen_y[i], v->key[i]); }

static void keep_plain(Drawing *d, const MappedVertices *v, int triangle) {
    const uint8_t *corner = d->cluster->triangles[triangle];
    const Vec3f p[3] = {vertex_in_cell(v, corner[0]), vertex_in_cell(v, corner[1]), vertex_in_cell(v, corner[2])};
    keep_facet(d, p, triangle);
}

/* Keeps the triangles that some samples see. */
static void keep_seen(Drawing *d, const MappedVertices *v, const BeamMesh *mesh, const BeamSeen *seen, int count) {
    uint32_t *mark = d->draft->beam->samples.mark;
    uint32_t left = 0;
    for (int i = 0; i < count; i++) left |= 1u << seen[i].triangle;
    for (int k = 0; k < mesh->count && left; k++) {
        if (!(left >> mesh->which[k] & 1)) continue;
        for (int i = 0; i < count; i++)
            if (seen[i].triangle == mesh->which[k]) mark[seen[i].sample] = d->draft->facet_count + 1;
        keep_plain(d, v, mesh->which[k]);
        left &= ~(1u << mesh->which[k]);
    }
}

/* Triangles that need neither be cut nor bent. */
static void draw_plain(Drawing *d, const MappedVertices *v, const BeamMesh *mesh) {
    BeamDraft *draft = d->draft;
    BeamSeen seen[BEAM_FEW_SAMPLES];
    draft->triangles += (uint64_t)mesh->count;
    const int count = beam_draw_mesh(draft->beam, mesh, seen);
    if (count > 0) keep_seen(d, v, mesh, seen, count);
    if (count >= 0) return;
    for (int i = 0; i < mesh->count; i++) {
        const uint8_t *corner = mesh->triangles[mesh->which[i]];
        if (beam_draw_seen(draft->beam, vertex_seen(v, corner[0]), vertex_seen(v, corner[1]), vertex_seen(v, corner[2]), draft->facet_count + 1) && draft->facets)
            keep_plain(d, v, mesh->which[i]);
    }
}

/* A triangle of the cluster, none of whose corners is out of the cell's texture space. */
static Piece piece_of(const MappedVertices *v, const TexelCluster *cluster, int triangle, bool inside) {
    Piece piece = {.triangle = triangle, .inside = inside};
    for (int k = 0; k < 3; k++) {
        const int corner = cluster->triangles[triangle][k];
        piece.p[k] = vertex_in_cell(v, corner), piece.q[k] = vertex_in_beam(v, corner), piece.x[k] = vertex_in_box(cluster, corner);
    }
    return piece;
}

/* Tells of which of the cluster's whole triangles the mapping bends an edge, where texture coordinates are affine: most edges cannot be bent so far, the others are
 * looked at together. */
static void find_bent(const Drawing *d, const MappedVertices *v, const BeamMesh *whole, bool bent[CLUSTER_TRIANGLES]) {
    enum { EDGES = 3 * CLUSTER_TRIANGLES };
    float pa[EDGES], pb[EDGES], pw[EDGES], qa[EDGES], qb[EDGES], qw[EDGES];
    uint32_t edge_bent[EDGES];
    uint8_t of[EDGES];
    int count = 0;
    for (int i = 0; i < whole->count; i++) {
        const uint8_t *corner = whole->triangles[whole->which[i]];
        bent[i] = false;
        for (int e = 0; e < 3; e++) {
            const int p = corner[e], q = corner[(e + 1) % 3];
            if (cell_frame_bend(d->at.frame, fabsf(v->a[q] - v->a[p]), fabsf(v->b[q] - v->b[p]), fabsf(v->w[q] - v->w[p])) <= d->at.tolerance) continue;
            pa[count] = v->a[p], pb[count] = v->b[p], pw[count] = v->w[p];
            qa[count] = v->a[q], qb[count] = v->b[q], qw[count] = v->w[q];
            of[count++] = (uint8_t)i;
        }
    }
    cell_frame_bends_of(d->at.frame, count, pa, pb, pw, qa, qb, qw, d->at.tolerance, edge_bent);
    for (int k = 0; k < count; k++) bent[of[k]] |= edge_bent[k] != 0;
}

/* Draws those of the cluster's whole triangles that are to be cut, and leaves the others. */
static void draw_bent_of(Drawing *d, const MappedVertices *v, BeamMesh *whole) {
    const bool affine = d->at.frame->affine;
    bool bent[CLUSTER_TRIANGLES];
    int left = 0;
    if (affine) find_bent(d, v, whole, bent);
    for (int i = 0; i < whole->count; i++) {
        if (!affine || bent[i]) {
            const Piece piece = piece_of(v, d->cluster, whole->which[i], true);
            if (affine || middles_of(d, &piece).bent_count > 0) {
                draw_bent(d, &piece, 0);
                continue;
            }
        }
        whole->which[left++] = whole->which[i];
    }
    whole->count = left;
}

/* Whether no edge of the cluster can be bent by more than is tolerated. `box` holds what lies in the cell. */
static bool is_plain(const CopyFrame *c, const TexelCluster *cluster, const CellBox *box) {
    float a = box->a1 - box->a0, b = box->b1 - box->b0, w = box->w1 - box->w0;
    const float *edge = cluster->longest;
    if (c->frame->affine) {
        a = float_min(a, fabsf(c->a_x) * edge[0] + fabsf(c->a_z) * edge[2]);
        b = float_min(b, fabsf(c->b_x) * edge[0] + fabsf(c->b_z) * edge[2]);
        w = float_min(w, fabsf(c->y_w) * edge[1]);
    }
    return cell_frame_bend(c->frame, a, b, w) <= c->tolerance;
}

/* `box` holds the part of the cluster that is in the cell. */
static void draw_cluster(Drawing *d, const TexelCluster *cluster, const CellBox *box) {
    MappedVertices v;
    const CellFrame *f = d->at.frame;
    const bool plain = is_plain(&d->at, cluster, box);
    BeamMesh whole = {.x = v.seen_x, .y = v.seen_y, .key = v.key, .triangles = cluster->triangles};
    d->cluster = cluster;
    map_vertices(d, cluster, &v);
    for (int i = 0; i < cluster->triangle_count; i++) {
        const uint8_t *corner = cluster->triangles[i];
        const uint32_t any = v.code[corner[0]] | v.code[corner[1]] | v.code[corner[2]], all = v.code[corner[0]] & v.code[corner[1]] & v.code[corner[2]];
        const bool inside = !(any & OUT_OF_CELL);
        const bool across = !f->affine && !inside; /* of the cell: what is out of it has no place in the beam */
        if (!across && all & (OUT_OF_CELL - 1)) continue;
        if (across) {
            const Vec3f x[3] = {vertex_in_box(cluster, corner[0]), vertex_in_box(cluster, corner[1]), vertex_in_box(cluster, corner[2])};
            draw_across(d, x, i);
            continue;
        }
        if (inside && !(any & BEAM_TOO_NEAR)) {
            whole.which[whole.count++] = (uint8_t)i;
            continue;
        }
        const Piece piece = piece_of(&v, cluster, i, inside);
        draw_bent(d, &piece, 0);
    }
    if (!plain) draw_bent_of(d, &v, &whole);
    whole.corners = whole.count == cluster->triangle_count ? cluster->vertex_count : 0;
    if (whole.count) draw_plain(d, &v, &whole);
}

/* ---- copies ---- */

static bool node_box(const CopyFrame *c, const ClusterNode *node, CellBox *box) {
    if (c->frame->affine) {
        float x = (node->min[0] + node->max[0]) / 2, z = (node->min[2] + node->max[2]) / 2, hx = node->max[0] - x, hz = node->max[2] - z;
        float a = c->a_x * x + c->a_z * z + c->a_0, ha = fabsf(c->a_x) * hx + fabsf(c->a_z) * hz + HAIR;
        float b = c->b_x * x + c->b_z * z + c->b_0, hb = fabsf(c->b_x) * hx + fabsf(c->b_z) * hz + HAIR;
        float w0 = c->y_w * node->min[1] + c->y_0, w1 = c->y_w * node->max[1] + c->y_0;
        *box = (CellBox){a - ha, a + ha, b - hb, b + hb, float_min(w0, w1) - HAIR, float_max(w0, w1) + HAIR};
        return cell_box_clip(c->frame->cell, box);
    }
    double x = (double)(node->min[0] + node->max[0]) / 2, z = (double)(node->min[2] + node->max[2]) / 2;
    double hx = (double)(node->max[0] - node->min[0]) / 2, hz = (double)(node->max[2] - node->min[2]) / 2;
    TextureBox in = {.u = c->u_x * x + c->u_z * z + c->u_0, .v = c->v_x * x + c->v_z * z + c->v_0,
                     .side_u = {c->u_x * hx, c->u_z * hz}, .side_v = {c->v_x * hx, c->v_z * hz},
                     .w0 = c->w_y * (double)node->min[1] + c->w_0, .w1 = c->w_y * (double)node->max[1] + c->w_0};
    return cell_box_of(c->frame, &in, box);
}

static void draw_copy(Drawing *d, const BeamTexel *texel) {
    uint32_t stack[DEEPEST_NODE];
    int depth = 0;
    if (texel->node_count) stack[depth++] = 0;
    while (depth) {
        const ClusterNode *node = &texel->nodes[stack[--depth]];
        CellBox box;
        float nearest;
        d->draft->nodes++;
        if (!node_box(&d->at, node, &box) || !cell_box_met(d->draft->beam, d->at.frame, &box, &nearest)) continue;
        if (node->leaf) {
            draw_cluster(d, &texel->clusters[node->first], &box);
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
    if (!skin_copy_of(d->skin, d->cell, placed, iu, iv, &copy) || !copy.texel->beam) return;
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
            set_walls(d);
            draw_copy(d, copy.texel->beam);
        }
}

/* Tiles [u0, u1) × [v0, v1). */
typedef struct TileRange {
    int64_t u0, u1, v0, v1;
} TileRange;

static bool tiles_met(const Drawing *d, const CellFrame *f, const PlacedTexel *placed, const TileRange *r, float *nearest) {
    double reach = placed->reach, u0 = (double)r->u0 - reach, u1 = (double)r->u1 + reach, v0 = (double)r->v0 - reach, v1 = (double)r->v1 + reach;
    TextureBox in = {.u = (u0 + u1) / 2, .v = (v0 + v1) / 2, .side_u = {(u1 - u0) / 2, 0}, .side_v = {0, (v1 - v0) / 2}, .w0 = -VTS_INFINITY, .w1 = VTS_INFINITY};
    CellBox box;
    return cell_box_of(f, &in, &box) && cell_box_met(d->draft->beam, f, &box, nearest);
}

/* The q.z from which on the skin is voxels in the eye's beam. */
static double seen_as_geometry(const Drawing *d) {
    const Beam *beam = d->draft->beam;
    return beam->perspective && !beam->light ? 1.42 * d->skin->exact_to * vec3_length(beam->rows[2]) : VTS_INFINITY;
}

static void draw_tiles(Drawing *d, const CellFrame *f, const PlacedTexel *placed, TileRange r) {
    if (beam_is_interrupted(d->draft)) return;
    if (r.u1 - r.u0 == 1 && r.v1 - r.v0 == 1) {
        draw_texel_at(d, f, placed, r.u0, r.v0);
        return;
    }
    TileRange half[2] = {r, r};
    if (r.u1 - r.u0 >= r.v1 - r.v0) half[0].u1 = half[1].u0 = r.u0 + (r.u1 - r.u0) / 2;
    else half[0].v1 = half[1].v0 = r.v0 + (r.v1 - r.v0) / 2;
    float nearest[2];
    bool met[2];
    for (int i = 0; i < 2; i++) met[i] = tiles_met(d, f, placed, &half[i], &nearest[i]) && (double)nearest[i] <= seen_as_geometry(d);
    int first = met[0] && met[1] && nearest[1] < nearest[0];
    for (int i = 0; i < 2; i++)
        if (met[first ^ i]) draw_tiles(d, f, placed, half[first ^ i]);
}

static const double LARGEST_TILE = 1e15;

static bool tiles_of_cell(const SkinCell *cell, int reach, TileRange *r) {
    double lo[2] = {VTS_INFINITY, VTS_INFINITY}, hi[2] = {-VTS_INFINITY, -VTS_INFINITY};
    for (int i = 0; i < (cell->triangle ? 3 : 4); i++) {
        double a = i & 1, b = i >> 1, at[2] = {bilinear_at(&cell->u, a, b), bilinear_at(&cell->v, a, b)};
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

static bool is_vast(const SkinCell *cell) {
    const double *u = cell->u.c, *v = cell->v.c;
    return fabs(u[1]) + fabs(u[2]) + fabs(u[3]) + fabs(v[1]) + fabs(v[2]) + fabs(v[3]) > 2 * MOST_TILES_ACROSS;
}

/* A cell as a whole, or where texture coordinates bend much, or tiles are many, part by part. */
static void draw_part(Drawing *d, const SkinCell *cell, int depth) {
    CellFrame f;
    const CellBox all = {0, 1, 0, 1, 0, 1};
    float nearest;
    bool framed = cell_frame(&f, d->draft->beam, cell);
    if (depth && framed && !cell_box_met(d->draft->beam, &f, &all, &nearest)) return;
    if (depth < DEEPEST_PART ? !cell_is_tame(cell) || is_vast(cell) : depth < DEEPEST_VAST_PART && is_vast(cell)) {
        Drawing part = *d;
        for (int i = 0; i < 4; i++) {
            SkinCell quarter = cell_quarter(cell, i);
            part.size = d->size * (cell->triangle && i == 3 ? -0.5 : 0.5);
            part.from_a = d->from_a + (i & 1 ? d->size / 2 : 0);
            part.from_b = d->from_b + (i & 2 ? d->size / 2 : 0);
            draw_part(&part, &quarter, depth + 1);
        }
        return;
    }
    if (!framed) return;
    for (size_t i = 0; i < d->skin->texel_count; i++) {
        const PlacedTexel *placed = &d->skin->texels[i];
        TileRange range;
        if (skin_cell_bears(cell, placed) && tiles_of_cell(cell, placed->reach, &range)) draw_tiles(d, &f, placed, range);
    }
}

/* ---- the cells in the beam ---- */

size_t beam_most_cells(const CompiledScene *compiled) {
    size_t count = 0;
    for (size_t i = 0; i < compiled->skin_count; i++)
        if (compiled->skins[i].boxes && !compiled->skins[i].rigid) count += compiled->skins[i].cell_count;
    return count;
}

typedef struct Gathering {
    BeamDraft *draft;
    const CompiledScene *compiled;
    uint32_t skin, count;
} Gathering;

static bool meets(const void *context, const Box3 *box) {
    const BeamDraft *draft = ((const Gathering *)context)->draft;
    return !beam_is_interrupted(draft) && beam_meets_box(draft->beam, box);
}

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
    if (g->compiled->skins[skin].boxes && !g->compiled->skins[skin].rigid) box_tree_descend(g->compiled->skins[skin].boxes, meets, gather_cell, g);
}

static int nearer_first(const void *a, const void *b) {
    const BeamCell *x = a, *y = b;
    if (x->nearest != y->nearest) return x->nearest < y->nearest ? -1 : 1;
    if (x->skin != y->skin) return x->skin < y->skin ? -1 : 1;
    return x->cell < y->cell ? -1 : 1;
}

/* The farthest that any sample sees yet: what lies beyond is hidden. Samples without a limit see everything. `farthest` is the one that did when this was asked
 * before: as long as it still does nothing has changed. */
static void draw_in_limit(Beam *beam, uint32_t *farthest) {
    const BeamSamples *s = &beam->samples;
    const uint32_t count = s->first[s->columns * s->rows];
    if (count == 0 || !(s->key[*farthest] > 0 && 1 / (double)s->key[*farthest] < beam->farthest)) return;
    for (uint32_t i = 0; i < count; i++)
        if (s->key[i] < s->key[*farthest]) *farthest = i;
    if (s->key[*farthest] > 0) beam->farthest = fmin(beam->farthest, 1 / (double)s->key[*farthest]);
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
    uint32_t farthest = 0;
    if (sorted) qsort(draft->cells, count, sizeof *draft->cells, nearer_first);
    for (uint32_t i = 0; i < count && !beam_is_interrupted(draft); i++) {
        const BeamCell *at = &draft->cells[i];
        const CompiledSkin *skin = &compiled->skins[at->skin];
        if (sorted && (double)at->nearest > beam->farthest) break;
        beam->exact_to = beam->perspective || beam->light ? (float)skin->exact_to : 1;
        const SkinCell *cell = &skin->cells[at->cell];
        Drawing d = {.draft = draft, .skin = skin, .cell = cell, .size = 1};
        if (cell->side != CELL_FLAT) draw_part(&d, cell, 0); /* a layer without height holds nothing */
        if (sorted && i % CELLS_BETWEEN_LIMITS == 0) draw_in_limit(beam, &farthest);
    }
}
