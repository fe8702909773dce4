#include "render/skin_rim.h"

#include "base/random.h"
#include "render/skin_fold.h"

#include <stdlib.h>

/* A skin whose border needs more tiles than this has no rim. */
enum { MOST_TILES = 1 << 21 };
/* The rim may be so much wider at a corner of the border; and its outer side at least so long, against the border's. */
static const double MOST_MITER = 3, LEAST_SIDE = 0.1;

/* ---- tiles ---- */

typedef struct Tile {
    uint64_t key; /* 0: free */
    int64_t iu, iv;
    uint32_t part;
    bool beyond;
    double border, seam; /* how far its middle is from the nearest edge of either kind, in tiles */
} Tile;

struct TileSet {
    Tile *tiles;
    size_t mask, count;
};

static uint64_t tile_key(uint32_t part, int64_t iu, int64_t iv) { return random_hash((uint64_t)iu, (uint64_t)iv, part, 0x71e5) | 1; }

static Tile *find_tile(const TileSet *set, uint32_t part, int64_t iu, int64_t iv) {
    uint64_t key = tile_key(part, iu, iv);
    for (size_t at = key & set->mask;; at = (at + 1) & set->mask) {
        Tile *t = &set->tiles[at];
        if (!t->key || (t->key == key && t->part == part && t->iu == iu && t->iv == iv)) return t;
    }
}

bool tile_set_has(const TileSet *set, uint32_t part, int64_t iu, int64_t iv) { return find_tile(set, part, iu, iv)->beyond; }

static void double_room(TileSet *set, Arena *arena) {
    size_t room = set->tiles ? 2 * (set->mask + 1) : 256;
    TileSet larger = {arena_new_array(arena, Tile, room), room - 1, set->count};
    for (size_t i = 0; set->tiles && i <= set->mask; i++)
        if (set->tiles[i].key) *find_tile(&larger, set->tiles[i].part, set->tiles[i].iu, set->tiles[i].iv) = set->tiles[i];
    *set = larger;
}

static Tile *add_tile(TileSet *set, uint32_t part, int64_t iu, int64_t iv, Arena *arena) {
    if (!set->tiles || 2 * set->count > set->mask) double_room(set, arena);
    Tile *t = find_tile(set, part, iu, iv);
    if (t->key) return t;
    set->count++;
    *t = (Tile){.key = tile_key(part, iu, iv), .iu = iu, .iv = iv, .part = part, .border = VTS_INFINITY, .seam = VTS_INFINITY};
    return t;
}

/* ---- edges of the surface ---- */

/* An edge of the border, from p to q as its cell has it. */
typedef struct RimEdge {
    uint32_t cell;
    int edge;
    int32_t next, before; /* along the border, beyond q and p; -1: nowhere */
    SkinCorner p, q;
    Vec3 out;             /* unit, along the surface */
    double width;         /* of the rim, along it; 0: there is none */
    Vec3 shift_p, shift_q; /* from p and q to the corners beyond them */
    double most;          /* the share of them up to which the rim is not bent too much */
    int32_t rim;          /* its cell */
} RimEdge;

typedef struct Rim {
    CompiledSkin *skin;
    Arena *scratch, *kept; /* of the work alone; of what the skin has from it */
    RimEdge *edges;
    size_t count;
    int32_t *number; /* [4·cell + edge]: of the border's edge, or -1 */
    double reach;    /* how far from the border the middle of a tile may be whose copy reaches over it, in tiles */
    int around;      /* tiles beside one that its copies come from */
    TileSet *set;
} Rim;

static int edges_of(const SkinCell *cell) { return cell->triangle ? 3 : 4; }

static Vec3 along_a(const SkinCell *c, double b) { return vec3_madd(c->foot.c[1], c->foot.c[3], b); }
static Vec3 along_b(const SkinCell *c, double a) { return vec3_madd(c->foot.c[2], c->foot.c[3], a); }
static double bilinear_a(const Bilinear *f, double b) { return f->c[1] + f->c[3] * b; }
static double bilinear_b(const Bilinear *f, double a) { return f->c[2] + f->c[3] * a; }

/* By how much texture coordinates change along `way`, which lies in the surface, at (a, b). False where they are singular. */
static bool texture_along(const SkinCell *cell, double a, double b, Vec3 way, double *du, double *dv) {
    Vec3 pa = along_a(cell, b), pb = along_b(cell, a);
    double aa = vec3_length_squared(pa), ab = vec3_dot(pa, pb), bb = vec3_length_squared(pb), det = aa * bb - ab * ab;
    if (!(det > 1e-12 * aa * bb)) return false;
    double wa = vec3_dot(way, pa), wb = vec3_dot(way, pb), da = (wa * bb - wb * ab) / det, db = (wb * aa - wa * ab) / det;
    *du = da * bilinear_a(&cell->u, b) + db * bilinear_b(&cell->u, a);
    *dv = da * bilinear_a(&cell->v, b) + db * bilinear_b(&cell->v, a);
    return true;
}

/* Where the rim goes from an edge, and how far. */
static void aim_edge(const Rim *rim, RimEdge *e) {
    const SkinCell *cell = &rim->skin->cells[e->cell];
    double a = (e->p.a + e->q.a) / 2, b = (e->p.b + e->q.b) / 2, inner = cell->triangle ? 1.0 / 3 : 0.5, du, dv;
    Vec3 along = vec3_sub(e->q.foot, e->p.foot), front = vec3_cross(along_a(cell, b), along_b(cell, a));
    Vec3 out = vec3_cross(along, front), middle = vec3_lerp(e->p.foot, e->q.foot, 0.5);
    if (vec3_dot(out, vec3_sub(middle, skin_cell_position(cell, inner, inner, 0, NULL))) < 0) out = vec3_negate(out);
    e->out = vec3_normalize(out);
    e->width = 0;
    if (!texture_along(cell, a, b, e->out, &du, &dv)) return;
    double u = e->q.u - e->p.u, v = e->q.v - e->p.v, rate = fabs(u * dv - v * du) / hypot(u, v), size = vec3_length(vec3_sub(rim->skin->bounds.max, rim->skin->bounds.min));
    if (rate > 0 && isfinite(rate)) e->width = fmin(rim->reach / rate, size);
}

/* The corner that is as far as the rim is wide from both edges. */
static Vec3 miter(const RimEdge *e, const RimEdge *f) {
    Vec3 one = vec3_scale(e->out, e->width);
    if (!f || f->width == 0) return one;
    double g = vec3_dot(e->out, f->out), det = 1 - g * g, most = MOST_MITER * fmax(e->width, f->width);
    Vec3 shift = vec3_scale(vec3_madd(one, f->out, f->width), 0.5);
    if (det > 1e-6) shift = vec3_madd(vec3_scale(e->out, (e->width - g * f->width) / det), f->out, (f->width - g * e->width) / det);
    double length = vec3_length(shift);
    return length > most ? vec3_scale(shift, most / length) : shift;
}

static const RimEdge *edge_at(const Rim *rim, int32_t number) { return number < 0 ? NULL : &rim->edges[number]; }

static void lay_corners(Rim *rim) {
    for (size_t i = 0; i < rim->count; i++) {
        RimEdge *e = &rim->edges[i];
        e->shift_p = miter(e, edge_at(rim, e->before));
        e->shift_q = miter(e, edge_at(rim, e->next));
        Vec3 along = vec3_sub(e->q.foot, e->p.foot);
        double side = vec3_length_squared(along), more = vec3_dot(vec3_sub(e->shift_q, e->shift_p), along);
        e->most = more < 0 ? fmin(1, (1 - LEAST_SIDE) * side / -more) : 1;
    }
    for (size_t i = 0; i < rim->count; i++) {
        RimEdge *e = &rim->edges[i];
        const RimEdge *f = edge_at(rim, e->before), *g = edge_at(rim, e->next);
        e->shift_p = vec3_scale(e->shift_p, f ? fmin(e->most, f->most) : e->most);
        e->shift_q = vec3_scale(e->shift_q, g ? fmin(e->most, g->most) : e->most);
    }
}

/* ---- finding the border ---- */

typedef struct EdgeEnds {
    uint32_t low, high, cell;
    int edge;
} EdgeEnds;

static int by_ends(const void *a, const void *b) {
    const EdgeEnds *x = a, *y = b;
    if (x->low != y->low) return x->low < y->low ? -1 : 1;
    if (x->high != y->high) return x->high < y->high ? -1 : 1;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    return x->edge - y->edge;
}

/* Edges without a neighbour; some of them are shared by three cells, or by two that are turned opposite ways. */
static EdgeEnds *open_edges(const CompiledSkin *skin, const SurfaceMesh *mesh, Arena *arena, size_t *count) {
    size_t n = 0;
    for (int pass = 0;; pass++) {
        EdgeEnds *list = pass ? arena_new_array(arena, EdgeEnds, n) : NULL;
        n = 0;
        for (size_t i = 0; i < mesh->cell_count; i++)
            for (int e = 0; e < edges_of(&skin->cells[i]); e++) {
                const uint32_t *v = mesh->cells[i].vertex;
                uint32_t p = v[e], q = v[(e + 1) % edges_of(&skin->cells[i])];
                if (skin->cells[i].neighbour[e].cell >= 0 || p == q) continue;
                if (pass) list[n] = (EdgeEnds){p < q ? p : q, p < q ? q : p, (uint32_t)i, e};
                n++;
            }
        *count = n;
        if (pass || !n) return list;
    }
}

static void find_border(Rim *rim, const SurfaceMesh *mesh) {
    const CompiledSkin *skin = rim->skin;
    size_t count;
    EdgeEnds *open = open_edges(skin, mesh, rim->scratch, &count);
    rim->edges = arena_new_array(rim->scratch, RimEdge, count);
    if (!count) return;
    rim->number = arena_new_array(rim->scratch, int32_t, 4 * mesh->cell_count);
    for (size_t i = 0; i < 4 * mesh->cell_count; i++) rim->number[i] = -1;
    qsort(open, count, sizeof *open, by_ends);
    for (size_t i = 0; i < count; i++) {
        const EdgeEnds *o = &open[i];
        bool shared = (i && o[-1].low == o->low && o[-1].high == o->high) || (i + 1 < count && o[1].low == o->low && o[1].high == o->high);
        const SkinCell *cell = &skin->cells[o->cell];
        if (shared || cell->side == CELL_FLAT || cell->side == CELL_FOLDED) continue;
        rim->number[4 * o->cell + (uint32_t)o->edge] = (int32_t)rim->count;
        RimEdge *e = &rim->edges[rim->count++];
        *e = (RimEdge){.cell = o->cell, .edge = o->edge, .next = -1, .before = -1, .rim = -1};
        e->p = skin_cell_corner(cell, o->edge);
        e->q = skin_cell_corner(cell, (o->edge + 1) % edges_of(cell));
    }
}

/* The border's next edge, round the cells at the end of this one. */
static int32_t next_edge(const Rim *rim, const RimEdge *e) {
    uint32_t cell = e->cell;
    int edge = e->edge;
    for (size_t i = 0; i < rim->skin->cell_count; i++) {
        const SkinCell *c = &rim->skin->cells[cell];
        edge = (edge + 1) % edges_of(c);
        if (c->neighbour[edge].cell < 0) return rim->number[4 * cell + (uint32_t)edge];
        cell = (uint32_t)c->neighbour[edge].cell;
        edge = c->neighbour[edge].edge;
        if (cell == e->cell && edge == e->edge) break;
    }
    return -1;
}

static void link_edges(Rim *rim) {
    for (size_t i = 0; i < rim->count; i++) {
        int32_t next = next_edge(rim, &rim->edges[i]);
        if (next < 0 || rim->edges[next].before >= 0) continue;
        rim->edges[i].next = next;
        rim->edges[next].before = (int32_t)i;
    }
}

/* ---- cells ---- */

/* The corner beyond one of an edge. */
static SkinCorner corner_beyond(const Rim *rim, const RimEdge *e, const SkinCorner *from, Vec3 shift) {
    SkinCorner out = *from;
    double du = 0, dv = 0;
    texture_along(&rim->skin->cells[e->cell], from->a, from->b, shift, &du, &dv);
    out.foot = vec3_add(from->foot, shift);
    out.u += du, out.v += dv;
    return out;
}

/* The mean of what the edges at a corner say of the coordinates there, unless a seam runs into it. */
static SkinCorner shared_corner(const SkinCorner *a, const SkinCorner *from_a, const SkinCorner *b, const SkinCorner *from_b) {
    SkinCorner out = *a;
    if (fabs(from_a->u - from_b->u) + fabs(from_a->v - from_b->v) > 1e-9) return out;
    out.u = (a->u + b->u) / 2, out.v = (a->v + b->v) / 2;
    return out;
}

static SkinCorner beyond_p(const Rim *rim, const RimEdge *e) {
    SkinCorner own = corner_beyond(rim, e, &e->p, e->shift_p);
    const RimEdge *f = edge_at(rim, e->before);
    if (!f || f->width == 0) return own;
    SkinCorner other = corner_beyond(rim, f, &f->q, f->shift_q);
    return shared_corner(&own, &e->p, &other, &f->q);
}

static SkinCorner beyond_q(const Rim *rim, const RimEdge *e) {
    SkinCorner own = corner_beyond(rim, e, &e->q, e->shift_q);
    const RimEdge *f = edge_at(rim, e->next);
    if (!f || f->width == 0) return own;
    SkinCorner other = corner_beyond(rim, f, &f->p, f->shift_p);
    return shared_corner(&own, &e->q, &other, &f->p);
}

/* Its first edge is the border's, seen from beyond. */
static void make_cell(Rim *rim, RimEdge *e) {
    CompiledSkin *skin = rim->skin;
    SkinCell *cell = &skin->cells[skin->cell_count], *inner = &skin->cells[e->cell];
    const SkinCorner corner[4] = {e->q, e->p, beyond_p(rim, e), beyond_q(rim, e)};
    skin_cell_fit(cell, corner, false);
    cell->rim = true;
    cell->part = inner->part;
    for (int i = 0; i < 4; i++) cell->neighbour[i] = (SurfaceNeighbour){-1, 0, false};
    if (cell->side != inner->side) return;
    e->rim = (int32_t)skin->cell_count++;
    cell->neighbour[0] = (SurfaceNeighbour){(int32_t)e->cell, (uint8_t)e->edge, false};
    inner->neighbour[e->edge] = (SurfaceNeighbour){e->rim, 0, false};
    skin->bounds = box3_union(skin->bounds, cell->bounds);
}

static void make_cells(Rim *rim) {
    CompiledSkin *skin = rim->skin;
    for (size_t i = 0; i < rim->count; i++)
        if (rim->edges[i].width > 0) make_cell(rim, &rim->edges[i]);
    for (size_t i = 0; i < rim->count; i++) {
        const RimEdge *e = &rim->edges[i], *next = edge_at(rim, e->next);
        if (!next || e->rim < 0 || next->rim < 0) continue;
        bool seam = fabs(e->q.u - next->p.u) + fabs(e->q.v - next->p.v) > 1e-9;
        skin->cells[e->rim].neighbour[3] = (SurfaceNeighbour){next->rim, 1, seam};
        skin->cells[next->rim].neighbour[1] = (SurfaceNeighbour){e->rim, 3, seam};
    }
}

/* ---- parts, and tiles beyond their borders ---- */

static uint32_t root_of(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* Cells are of one part if texture coordinates go on from one to the other. */
static void number_parts(CompiledSkin *skin, Arena *arena) {
    uint32_t *parent = arena_new_array(arena, uint32_t, skin->cell_count);
    for (uint32_t i = 0; i < skin->cell_count; i++) parent[i] = i;
    for (uint32_t i = 0; i < skin->cell_count; i++)
        for (int e = 0; e < edges_of(&skin->cells[i]); e++) {
            SurfaceNeighbour next = skin->cells[i].neighbour[e];
            if (next.cell >= 0 && !next.seam) parent[root_of(parent, i)] = root_of(parent, (uint32_t)next.cell);
        }
    for (uint32_t i = 0; i < skin->cell_count; i++) skin->cells[i].part = root_of(parent, i);
}

static double distance_to(double u, double v, double u0, double v0, double u1, double v1) {
    double du = u1 - u0, dv = v1 - v0, length = du * du + dv * dv;
    double s = length > 0 ? double_clamp(((u - u0) * du + (v - v0) * dv) / length, 0, 1) : 0;
    return hypot(u - u0 - s * du, v - v0 - s * dv);
}

/* Notes tiles near a piece of an edge, no longer than a few of them. False when there are too many. */
static bool note_tiles(Rim *rim, uint32_t part, double u0, double v0, double u1, double v1, bool border) {
    double far = 2 * rim->reach + rim->around + 1;
    int64_t low_u = (int64_t)floor(fmin(u0, u1) - far), high_u = (int64_t)floor(fmax(u0, u1) + far);
    int64_t low_v = (int64_t)floor(fmin(v0, v1) - far), high_v = (int64_t)floor(fmax(v0, v1) + far);
    for (int64_t iu = low_u; iu <= high_u; iu++)
        for (int64_t iv = low_v; iv <= high_v; iv++) {
            double distance = distance_to((double)iu + 0.5, (double)iv + 0.5, u0, v0, u1, v1);
            Tile *t = border ? add_tile(rim->set, part, iu, iv, rim->kept) : find_tile(rim->set, part, iu, iv);
            if (!t->key) continue;
            if (border) t->border = fmin(t->border, distance);
            else t->seam = fmin(t->seam, distance);
        }
    return rim->set->count <= MOST_TILES;
}

static bool note_edge(Rim *rim, uint32_t part, const SkinCorner *p, const SkinCorner *q, bool border) {
    double length = hypot(q->u - p->u, q->v - p->v);
    if (!(length < MOST_TILES && fabs(p->u) < 1e15 && fabs(p->v) < 1e15)) return false;
    int pieces = int_max(1, (int)ceil(length / 4));
    for (int i = 0; i < pieces; i++) {
        double s = (double)i / pieces, t = (double)(i + 1) / pieces;
        if (!note_tiles(rim, part, p->u + s * (q->u - p->u), p->v + s * (q->v - p->v), p->u + t * (q->u - p->u), p->v + t * (q->v - p->v), border)) return false;
    }
    return true;
}

static void note_seams(Rim *rim) {
    const CompiledSkin *skin = rim->skin;
    for (size_t i = 0; i < skin->cell_count; i++)
        for (int e = 0; e < edges_of(&skin->cells[i]); e++) {
            const SkinCell *cell = &skin->cells[i];
            if (cell->neighbour[e].cell < 0 || !cell->neighbour[e].seam) continue;
            SkinCorner p = skin_cell_corner(cell, e), q = skin_cell_corner(cell, (e + 1) % edges_of(cell));
            note_edge(rim, cell->part, &p, &q, false);
        }
}

typedef struct Inside {
    const CompiledSkin *skin;
    uint32_t part;
    double u, v;
} Inside;

/* Whether the point of the texture lies in the cell: even-odd. */
static bool holds(void *context, uint32_t number) {
    const Inside *in = context;
    const SkinCell *cell = &in->skin->cells[number];
    if (cell->part != in->part) return false;
    bool inside = false;
    for (int e = 0; e < edges_of(cell); e++) {
        SkinCorner p = skin_cell_corner(cell, e), q = skin_cell_corner(cell, (e + 1) % edges_of(cell));
        if ((p.v > in->v) != (q.v > in->v) && in->u < p.u + (in->v - p.v) / (q.v - p.v) * (q.u - p.u)) inside = !inside;
    }
    return inside;
}

static const BoxTree *tree_of_textures(const CompiledSkin *skin, Arena *arena) {
    Box3 *boxes = arena_new_array(arena, Box3, skin->cell_count);
    for (size_t i = 0; i < skin->cell_count; i++) {
        boxes[i] = box3_empty();
        for (int e = 0; e < edges_of(&skin->cells[i]); e++) {
            SkinCorner c = skin_cell_corner(&skin->cells[i], e);
            boxes[i] = box3_add_point(boxes[i], vec3(c.u, c.v, 0));
        }
    }
    return box_tree_build(boxes, skin->cell_count, arena);
}

/* False where there are too many. */
static bool find_tiles(Rim *rim) {
    rim->set = arena_new(rim->kept, TileSet);
    double_room(rim->set, rim->kept);
    for (size_t i = 0; i < rim->count; i++) {
        const RimEdge *e = &rim->edges[i];
        if (e->width > 0 && !note_edge(rim, rim->skin->cells[e->cell].part, &e->p, &e->q, true)) return false;
    }
    note_seams(rim);
    const BoxTree *tree = tree_of_textures(rim->skin, rim->scratch);
    for (size_t i = 0; i <= rim->set->mask; i++) {
        Tile *t = &rim->set->tiles[i];
        Inside in = {rim->skin, t->part, (double)t->iu + 0.5, (double)t->iv + 0.5};
        t->beyond = t->key && t->border <= t->seam && !box_tree_point(tree, vec3(in.u, in.v, 0), holds, &in);
    }
    return true;
}

void skin_rim_add(CompiledSkin *skin, const SurfaceMesh *mesh, Arena *arena, Arena *scratch) {
    Rim rim = {.skin = skin, .scratch = scratch, .kept = arena};
    for (size_t i = 0; i < skin->texel_count; i++) {
        if (!(skin->texels[i].overhang > 0)) continue;
        rim.around = int_max(rim.around, skin->texels[i].reach);
        rim.reach = fmax(rim.reach, 0.5 + skin->texels[i].overhang);
    }
    if (!rim.around) return;
    find_border(&rim, mesh);
    if (!rim.count) return;
    number_parts(skin, scratch);
    link_edges(&rim);
    for (size_t i = 0; i < rim.count; i++) aim_edge(&rim, &rim.edges[i]);
    if (!find_tiles(&rim)) return;
    lay_corners(&rim);
    make_cells(&rim);
    skin->beyond = rim.set;
}
