#include "terrain/ground_mesh.h"

#include "terrain/ground_nodes.h"
#include "terrain/ground_normals.h"

#include <string.h>

typedef struct Refinement {
    const GroundSource *source;
    const GroundErrors *errors;
    const GroundDetail *detail;
    GroundNodes nodes;
    uint32_t right, bottom, last; /* of the map, and of the square of all triangles; in parts */
    size_t halvings;              /* that errors asked for */
} Refinement;

/* Nodes: the ends of the longest side, and the right angle. */
typedef struct Triangle {
    uint32_t a, b, apex;
} Triangle;

static const GroundNode *node(const Refinement *r, uint32_t index) { return ground_node(&r->nodes, index); }

static uint32_t distance(uint32_t a, uint32_t b) { return a > b ? a - b : b - a; }

/* ---- which are halved ---- */

/* A node that is to be a corner needs those at the right angles of the triangles that it halves. */
static void activate(Refinement *r, uint32_t x, uint32_t y);

static void need(Refinement *r, int64_t x, int64_t y) {
    if (x >= 0 && y >= 0 && x <= r->last && y <= r->last) activate(r, (uint32_t)x, (uint32_t)y);
}

static void need_parents(Refinement *r, int64_t x, int64_t y) {
    int64_t bits = x | y, s = bits & -bits;
    bool odd_x = x & s, odd_y = y & s;
    if (!odd_y) need(r, x, y - s), need(r, x, y + s);
    else if (!odd_x) need(r, x - s, y), need(r, x + s, y);
    else {
        /* The middle of a square: its diagonal is longest between corners of an even sum, the right angles are the others. */
        int64_t even = ((x - s) / (2 * s) + (y - s) / (2 * s)) % 2 == 0;
        need(r, x - s, even ? y + s : y - s);
        need(r, x + s, even ? y - s : y + s);
    }
}

static void activate(Refinement *r, uint32_t x, uint32_t y) {
    uint32_t index = ground_node_find(&r->nodes, x, y);
    if (index != GROUND_NO_NODE) return;
    index = ground_node_add(&r->nodes, x, y);
    ground_node(&r->nodes, index)->corner = true;
    need_parents(r, x, y);
}

/* The square of posts, or the part of one below them, that the triangle lies in. */
typedef struct Around {
    int level, column, row;
    bool diagonal; /* the triangle is half of it; else a quarter, on one of its sides */
} Around;

static int log2_of(uint32_t power) {
    int n = 0;
    while (power >>= 1) n++;
    return n;
}

static Around around(const Refinement *r, const Triangle *t) {
    const GroundNode *a = node(r, t->a), *b = node(r, t->b), *c = node(r, t->apex);
    uint32_t side = distance(a->x, b->x);
    if (distance(a->y, b->y) > side) side = distance(a->y, b->y);
    uint32_t x = a->x < b->x ? a->x : b->x, y = a->y < b->y ? a->y : b->y;
    bool diagonal = a->x != b->x && a->y != b->y;
    /* Of a triangle on a side the right angle is the middle of its square. */
    if (a->x == b->x && c->x < x) x -= side;
    if (a->y == b->y && c->y < y) y -= side;
    return (Around){log2_of(side) - GROUND_PART_BITS, (int)(x / side), (int)(y / side), diagonal};
}

/* Below the posts the ground is bilinear: its twist falls by four with each level. */
static double error_between_posts(const Refinement *r, const Around *at) {
    int shift = -at->level, column = at->column >> shift, row = at->row >> shift;
    double error = ground_cell_error(r->source, column, row);
    return isnan(error) ? 0 : ldexp(error, -2 * (shift + !at->diagonal));
}

static bool is_empty(const Refinement *r, const Around *at) {
    return at->level >= 1 ? ground_is_hole(r->errors, at->level, at->column, at->row)
                          : isnan(ground_cell_error(r->source, at->column >> -at->level, at->row >> -at->level));
}

/* A triangle on the side of a square: what its first halving moves, and what its two quarters of the square have. */
static double error_on_side(const Refinement *r, const Triangle *t, const Around *at) {
    const GroundNode *a = node(r, t->a), *b = node(r, t->b), *c = node(r, t->apex);
    double column = (a->x + b->x) / 2 / (double)GROUND_PARTS, row = (a->y + b->y) / 2 / (double)GROUND_PARTS;
    double middle = ground_source_beyond(r->source, column, row);
    double own = fabs(middle - 0.5 * (a->height + b->height)), error = 0;
    uint32_t half = (uint32_t)GROUND_PARTS << (at->level - 1);
    for (int k = 0; k < 2; k++) {
        const GroundNode *end = k ? b : a;
        int x = (int)((end->x < c->x ? end->x : c->x) / half), y = (int)((end->y < c->y ? end->y : c->y) / half);
        const Around quarter = {at->level - 1, x, y, true};
        if (is_empty(r, &quarter)) return HUGE_VAL;
        error = fmax(error, at->level == 1 ? error_between_posts(r, &quarter) : ground_error(r->errors, at->level - 1, x, y));
    }
    return (isfinite(own) ? own : 0) + error;
}

static double triangle_error(const Refinement *r, const Triangle *t, const Around *at) {
    if (at->level < 1) return error_between_posts(r, at);
    double whole = ground_error(r->errors, at->level, at->column, at->row);
    return at->diagonal ? whole : fmin(whole, error_on_side(r, t, at));
}

/* Some triangles straddle the map's border; those beyond do not count. */
static bool is_outside(const Refinement *r, const Triangle *t) {
    const GroundNode *n[3] = {node(r, t->a), node(r, t->b), node(r, t->apex)};
    return (n[0]->x >= r->right && n[1]->x >= r->right && n[2]->x >= r->right) ||
           (n[0]->y >= r->bottom && n[1]->y >= r->bottom && n[2]->y >= r->bottom);
}

static bool wants_halving(const Refinement *r, const Triangle *t) {
    Around at = around(r, t);
    if (is_empty(r, &at)) return false;
    if (r->detail->every_post) return at.level >= 1;
    if (at.level <= 1 - GROUND_PART_BITS) return false;
    const GroundNode *n[3] = {node(r, t->a), node(r, t->b), node(r, t->apex)};
    GroundSpot spot = {.centre = vec3_scale(vec3_add(vec3_add(n[0]->place, n[1]->place), n[2]->place), 1.0 / 3), .top = -HUGE_VAL};
    double length = r->source->spacing * ldexp(at.diagonal ? sqrt(2) : 1, at.level);
    double error = triangle_error(r, t, &at) + r->source->bend * length * length, allowed, side;
    for (int i = 0; i < 3; i++) {
        spot.radius = fmax(spot.radius, error + vec3_length(vec3_sub(n[i]->place, spot.centre)));
        spot.top = fmax(spot.top, error + n[i]->place.y);
    }
    r->detail->allow(r->detail->context, &spot, &allowed, &side);
    return error > allowed || (length > side && at.level >= 1);
}

static bool middle_of(const Refinement *r, const Triangle *t, uint32_t *x, uint32_t *y) {
    const GroundNode *a = node(r, t->a), *b = node(r, t->b);
    *x = a->x / 2 + b->x / 2 + (a->x & b->x & 1);
    *y = a->y / 2 + b->y / 2 + (a->y & b->y & 1);
    return !((a->x ^ b->x) & 1) && !((a->y ^ b->y) & 1);
}

/* The node at which the triangle is halved, or GROUND_NO_NODE. */
static uint32_t halved_at(const Refinement *r, const Triangle *t) {
    uint32_t x, y;
    if (!middle_of(r, t, &x, &y)) return GROUND_NO_NODE;
    uint32_t index = ground_node_find(&r->nodes, x, y);
    return index != GROUND_NO_NODE && node(r, index)->corner ? index : GROUND_NO_NODE;
}

static bool too_many(const Refinement *r) { return r->detail->most_vertices && r->nodes.count > r->detail->most_vertices; }

/* No deeper than twice the levels. Halves that a neighbour demands are not asked again: their errors, sides and spheres lie within those of
 * the whole, which was content. */
static void refine(Refinement *r, Triangle t) {
    if (is_outside(r, &t) || too_many(r)) return;
    uint32_t middle = halved_at(r, &t), x, y;
    if (middle == GROUND_NO_NODE) {
        if (!middle_of(r, &t, &x, &y) || !wants_halving(r, &t)) return;
        r->halvings++;
        activate(r, x, y);
        middle = ground_node_find(&r->nodes, x, y);
    }
    refine(r, (Triangle){t.apex, t.a, middle});
    refine(r, (Triangle){t.b, t.apex, middle});
}

/* ---- leaves become triangles of the mesh ---- */

/* Triangles are kept in pieces until all are known, as nodes are. */
typedef struct TrianglePiece {
    struct TrianglePiece *older;
    size_t count;
    uint32_t items[GROUND_PIECE][3];
} TrianglePiece;

typedef struct Output {
    Refinement *r;
    Arena *scratch;
    TrianglePiece *newest;
    size_t vertex_count, triangle_count;
    uint32_t *node_of; /* by vertex */
    Vec3 *vertices, *normals;
    uint32_t (*triangles)[3];
} Output;

/* A corner of what the border leaves of a triangle. */
typedef struct Corner {
    int64_t x, y;
    double height;
} Corner;

typedef struct Polygon {
    Corner corner[5];
    int count;
} Polygon;

/* Sides of triangles run along rows, columns or diagonals: where a border cuts them are whole parts. */
static Corner cut(const Corner *a, const Corner *b, bool column, int64_t limit) {
    int64_t from = column ? a->x : a->y, to = column ? b->x : b->y;
    double t = (double)(limit - from) / (double)(to - from);
    int64_t x = a->x + (b->x - a->x) * (limit - from) / (to - from), y = a->y + (b->y - a->y) * (limit - from) / (to - from);
    return (Corner){x, y, a->height + (b->height - a->height) * t};
}

static Polygon clip(const Polygon *in, bool column, int64_t limit) {
    Polygon out = {.count = 0};
    for (int i = 0; i < in->count; i++) {
        const Corner *a = &in->corner[i], *b = &in->corner[(i + 1) % in->count];
        bool a_in = (column ? a->x : a->y) <= limit, b_in = (column ? b->x : b->y) <= limit;
        if (a_in) out.corner[out.count++] = *a;
        if (a_in != b_in && (column ? a->x : a->y) != limit && (column ? b->x : b->y) != limit)
            out.corner[out.count++] = a_in ? cut(a, b, column, limit) : cut(b, a, column, limit);
    }
    return out;
}

static uint32_t vertex_of(Output *out, const Corner *corner) {
    GroundNodes *nodes = &out->r->nodes;
    uint32_t index = ground_node_find(nodes, (uint32_t)corner->x, (uint32_t)corner->y);
    if (index == GROUND_NO_NODE) index = ground_node_add_at(nodes, (uint32_t)corner->x, (uint32_t)corner->y, corner->height);
    GroundNode *n = ground_node(nodes, index);
    if (n->vertex != GROUND_NO_NODE) return n->vertex;
    return n->vertex = (uint32_t)out->vertex_count++;
}

static int64_t doubled_area(const Corner *a, const Corner *b, const Corner *c) {
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

static void keep_triangle(Output *out, uint32_t a, uint32_t b, uint32_t c) {
    if (!out->newest || out->newest->count == GROUND_PIECE) {
        TrianglePiece *piece = arena_new(out->scratch, TrianglePiece);
        piece->older = out->newest;
        out->newest = piece;
    }
    uint32_t *triangle = out->newest->items[out->newest->count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
    out->triangle_count++;
}

static void emit(Output *out, const Triangle *t) {
    const Refinement *r = out->r;
    const uint32_t index[3] = {t->a, t->b, t->apex};
    Polygon polygon = {.count = 3};
    bool cuts = false;
    const Around at = around(r, t);
    if (is_empty(r, &at)) return;
    for (int i = 0; i < 3; i++) {
        const GroundNode *n = node(r, index[i]);
        if (isnan(n->height)) return;
        polygon.corner[i] = (Corner){n->x, n->y, n->height};
        cuts |= n->x > r->right || n->y > r->bottom;
    }
    if (cuts) polygon = clip(&polygon, true, r->right);
    if (cuts) polygon = clip(&polygon, false, r->bottom);
    for (int i = 2; i < polygon.count; i++) {
        const Corner *a = &polygon.corner[0], *b = &polygon.corner[i - 1], *c = &polygon.corner[i];
        if (doubled_area(a, b, c) == 0) continue;
        uint32_t v0 = vertex_of(out, a), v1 = vertex_of(out, b), v2 = vertex_of(out, c);
        keep_triangle(out, v0, v1, v2);
    }
}

static void emit_leaves(Output *out, Triangle t) {
    if (is_outside(out->r, &t)) return;
    uint32_t middle = halved_at(out->r, &t);
    if (middle == GROUND_NO_NODE) {
        emit(out, &t);
        return;
    }
    emit_leaves(out, (Triangle){t.apex, t.a, middle});
    emit_leaves(out, (Triangle){t.b, t.apex, middle});
}

/* ---- all of it ---- */

static void gather_vertices(Output *out, Arena *arena) {
    out->vertices = arena_new_array(arena, Vec3, out->vertex_count);
    out->node_of = arena_new_array(out->scratch, uint32_t, out->vertex_count);
    for (uint32_t i = 0; i < out->r->nodes.count; i++) {
        const GroundNode *n = node(out->r, i);
        if (n->vertex == GROUND_NO_NODE) continue;
        out->node_of[n->vertex] = i;
        out->vertices[n->vertex] = n->place;
    }
}

static void gather_triangles(Output *out, Arena *arena) {
    size_t end = out->triangle_count;
    out->triangles = arena_push(arena, out->triangle_count * sizeof *out->triangles);
    for (const TrianglePiece *piece = out->newest; piece; piece = piece->older) {
        end -= piece->count;
        memcpy(out->triangles + end, piece->items, piece->count * sizeof *piece->items);
    }
}

/* How long the sides are that meet in each vertex, in posts, on the average. */
static float *sides_around(const Output *out) {
    float *sum = arena_new_array(out->scratch, float, out->vertex_count), *met = arena_new_array(out->scratch, float, out->vertex_count);
    for (size_t i = 0; i < out->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t from = out->triangles[i][k], to = out->triangles[i][(k + 1) % 3];
            const GroundNode *a = node(out->r, out->node_of[from]), *b = node(out->r, out->node_of[to]);
            float length = (float)(hypot((double)a->x - b->x, (double)a->y - b->y) / GROUND_PARTS);
            sum[from] += length, sum[to] += length, met[from] += 1, met[to] += 1;
        }
    for (size_t i = 0; i < out->vertex_count; i++) sum[i] /= fmaxf(1, met[i]);
    return sum;
}

static void find_normals(Output *out, Arena *arena) {
    const float *sides = sides_around(out);
    GroundAxes *axes = ground_axes_create(out->r->source, out->scratch);
    out->normals = arena_new_array(arena, Vec3, out->vertex_count);
    for (size_t i = 0; i < out->vertex_count; i++) {
        const GroundNode *n = node(out->r, out->node_of[i]);
        out->normals[i] = ground_normal(axes, (double)n->x / GROUND_PARTS, (double)n->y / GROUND_PARTS, (double)sides[i]);
    }
}

/* Where no slope was found the triangles around tell the normal. */
static void complete_normals(Output *out) {
    const Vec3 *p = out->vertices;
    Vec3 *normals = out->normals;
    for (size_t i = 0; i < out->triangle_count; i++) {
        const uint32_t *t = out->triangles[i];
        Vec3 n = vec3_normalize(vec3_cross(vec3_sub(p[t[1]], p[t[0]]), vec3_sub(p[t[2]], p[t[0]])));
        for (int k = 0; k < 3; k++) {
            if (vec3_length_squared(normals[t[k]]) > 0) continue;
            Vec3 up = vec3_length_squared(normals[t[(k + 1) % 3]]) > 0 ? normals[t[(k + 1) % 3]] : vec3(0, 1, 0);
            normals[t[k]] = vec3_dot(n, up) < 0 ? vec3_negate(n) : n;
        }
    }
}

static void keep_mesh(Output *out, Arena *arena, MeshData *mesh) {
    const size_t count = out->vertex_count;
    if (!count) return;
    gather_vertices(out, arena);
    gather_triangles(out, arena);
    find_normals(out, arena);
    complete_normals(out);
    *mesh = (MeshData){.vertices = out->vertices, .vertex_count = count, .normals = out->normals, .normal_count = count,
                       .uvs_from_above = true,
                       .triangles = (const uint32_t(*)[3])out->triangles, .triangle_count = out->triangle_count};
}

bool ground_mesh_build(const GroundSource *source, const GroundErrors *errors, const GroundDetail *detail, Arena *scratch, Arena *arena,
                       MeshData *mesh, size_t *needed) {
    Refinement r = {.source = source, .errors = errors, .detail = detail, .last = (uint32_t)GROUND_PARTS << errors->levels};
    r.right = (uint32_t)(source->columns - 1) << GROUND_PART_BITS;
    r.bottom = (uint32_t)(source->rows - 1) << GROUND_PART_BITS;
    *mesh = (MeshData){0};
    ArenaMark mark = arena_mark(scratch);
    ground_nodes_init(&r.nodes, source, scratch);
    uint32_t corner[4];
    for (uint32_t i = 0; i < 4; i++) {
        corner[i] = ground_node_add(&r.nodes, (i & 1) * r.last, (i >> 1) * r.last);
        ground_node(&r.nodes, corner[i])->corner = true;
    }
    const Triangle roots[2] = {{corner[0], corner[3], corner[1]}, {corner[3], corner[0], corner[2]}};
    for (int i = 0; i < 2; i++) refine(&r, roots[i]);
    if (needed) *needed = 2 + r.halvings;
    bool fits = !too_many(&r);
    Output out = {.r = &r, .scratch = scratch};
    for (int i = 0; i < 2 && fits; i++) emit_leaves(&out, roots[i]);
    if (fits) keep_mesh(&out, arena, mesh);
    if (scratch != arena) arena_reset_to(scratch, mark);
    return fits;
}
