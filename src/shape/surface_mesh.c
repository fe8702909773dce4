#include "shape/surface_mesh.h"

#include "shape/surface_draft.h"
#include "shape/surface_front.h"
#include "shape/weld.h"

typedef struct Assembly {
    const SurfaceDraft *draft;
    Arena *arena;
    uint32_t *place, *uv_place; /* of the draft's vertices */
    SurfaceMesh *out;
} Assembly;

/* ---- places ---- */

static Vec3 *position_list(const SurfaceDraft *draft, Arena *arena) {
    Vec3 *points = arena_new_array(arena, Vec3, draft->vertices.count);
    for (size_t i = 0; i < draft->vertices.count; i++) points[i] = draft->vertices.items[i].position;
    return points;
}

static void join_positions(Assembly *a) {
    size_t count = a->draft->vertices.count;
    Vec3 *vertices = arena_new_array(a->arena, Vec3, count);
    a->place = arena_new_array(a->arena, uint32_t, count);
    ArenaMark mark = arena_mark(a->arena);
    Vec3 *points = position_list(a->draft, a->arena);
    a->out->vertex_count = weld_points(points, count, weld_tolerance(points, count), a->arena, a->place);
    for (size_t i = count; i-- > 0;) vertices[a->place[i]] = points[i]; /* the first of each place stays */
    arena_reset_to(a->arena, mark);
    a->out->bounds = box3_empty();
    for (size_t i = 0; i < a->out->vertex_count; i++)
        a->out->bounds = box3_add_point(a->out->bounds, vertices[i]);
    a->out->vertices = vertices;
}

static void join_uvs(Assembly *a) {
    size_t count = a->draft->vertices.count;
    TexCoord *uvs = arena_new_array(a->arena, TexCoord, count);
    a->uv_place = arena_new_array(a->arena, uint32_t, count);
    ArenaMark mark = arena_mark(a->arena);
    Vec3 *points = arena_new_array(a->arena, Vec3, count);
    for (size_t i = 0; i < count; i++) {
        TexCoord uv = a->draft->vertices.items[i].uv;
        points[i] = vec3(uv.u, uv.v, 0);
    }
    a->out->uv_count = weld_points(points, count, 1e-12, a->arena, a->uv_place);
    for (size_t i = count; i-- > 0;) uvs[a->uv_place[i]] = a->draft->vertices.items[i].uv;
    arena_reset_to(a->arena, mark);
    a->out->uvs = uvs;
}

/* ---- neighbours, in the draft's windings ---- */

static size_t list_edges(const Assembly *a, WeldEdge *edges) {
    size_t count = 0;
    for (uint32_t c = 0; c < a->draft->cell_count; c++) {
        const DraftCell *cell = &a->draft->cells[c];
        for (uint8_t e = 0; e < cell->corner_count; e++) {
            uint32_t from = a->place[cell->vertex[e]],
                     to = a->place[cell->vertex[(e + 1) % cell->corner_count]];
            if (from == to) continue;
            edges[count++] = (WeldEdge){from < to ? from : to, from < to ? to : from, c, e, from < to};
        }
    }
    return count;
}

static void join_pair(JoinedCells *joined, const WeldEdge *x, const WeldEdge *y) {
    joined->neighbours[x->cell][x->edge] = (SurfaceNeighbour){(int32_t)y->cell, y->edge, false};
    joined->neighbours[y->cell][y->edge] = (SurfaceNeighbour){(int32_t)x->cell, x->edge, false};
    joined->same_way[x->cell][x->edge] = joined->same_way[y->cell][y->edge] = x->forward == y->forward;
}

static JoinedCells join_cells(const Assembly *a) {
    size_t cells = a->draft->cell_count;
    JoinedCells joined = {.draft = a->draft, .place = a->place};
    joined.neighbours = arena_push(a->arena, cells * sizeof *joined.neighbours);
    joined.same_way = arena_push(a->arena, cells * sizeof *joined.same_way);
    for (size_t c = 0; c < cells; c++) {
        for (int e = 0; e < 4; e++) joined.neighbours[c][e].cell = -1;
    }
    ArenaMark mark = arena_mark(a->arena);
    WeldEdge *edges = arena_new_array(a->arena, WeldEdge, 4 * cells);
    size_t count = list_edges(a, edges);
    weld_sort_edges(edges, count, a->out->vertex_count, a->arena);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi;) end++;
        if (end - i == 2) join_pair(&joined, &edges[i], &edges[i + 1]);
    }
    arena_reset_to(a->arena, mark);
    return joined;
}

/* ---- cells, in their final windings ---- */

/* Corner i of a turned cell was corner -i, edge e was edge -1 - e, modulo the number of corners. */
static int draft_corner(int corner, int count, bool turned) {
    return turned ? (count - corner) % count : corner;
}
static int draft_edge(int edge, int count, bool turned) { return turned ? count - 1 - edge : edge; }

static bool is_degenerate(const SurfaceMesh *mesh, const SurfaceCell *cell) {
    double twice_area = 0, longest = 0;
    Vec3 a = mesh->vertices[cell->vertex[0]];
    for (int i = 1; i < cell->corner_count; i++) {
        Vec3 p = vec3_sub(mesh->vertices[cell->vertex[i]], a);
        Vec3 q = vec3_sub(mesh->vertices[cell->vertex[(i + 1) % cell->corner_count]], a);
        twice_area += vec3_length(vec3_cross(p, q));
        longest = double_max(longest, vec3_length_squared(p));
    }
    return twice_area <= 1e-12 * longest;
}

static void make_cells(const Assembly *a, const bool *turned) {
    SurfaceCell *cells = arena_new_array(a->arena, SurfaceCell, a->draft->cell_count);
    for (size_t c = 0; c < a->draft->cell_count; c++) {
        const DraftCell *from = &a->draft->cells[c];
        cells[c].corner_count = from->corner_count;
        for (int i = 0; i < 4; i++) {
            uint32_t v = from->vertex[draft_corner(i % from->corner_count, from->corner_count, turned[c])];
            cells[c].vertex[i] = a->place[v];
            cells[c].uv[i] = a->uv_place[v];
        }
        cells[c].degenerate = is_degenerate(a->out, &cells[c]);
    }
    a->out->cells = cells;
    a->out->cell_count = a->draft->cell_count;
}

static bool is_seam(const SurfaceCell *x, int e, const SurfaceCell *y, int f) {
    return x->uv[e] != y->uv[(f + 1) % y->corner_count] || x->uv[(e + 1) % x->corner_count] != y->uv[f];
}

static void make_neighbours(const Assembly *a, const JoinedCells *joined, const bool *turned) {
    const SurfaceCell *cells = a->out->cells;
    SurfaceNeighbour(*out)[4] = arena_push(a->arena, a->out->cell_count * sizeof *out);
    for (size_t c = 0; c < a->out->cell_count; c++) {
        for (int e = 0; e < 4; e++) {
            int count = cells[c].corner_count;
            out[c][e].cell = -1;
            if (e >= count) continue;
            SurfaceNeighbour next = joined->neighbours[c][draft_edge(e, count, turned[c])];
            if (next.cell < 0) continue;
            next.edge = (uint8_t)draft_edge(next.edge, cells[next.cell].corner_count, turned[next.cell]);
            next.seam = is_seam(&cells[c], e, &cells[next.cell], next.edge);
            out[c][e] = next;
        }
    }
    a->out->neighbours = (const SurfaceNeighbour(*)[4])out;
}

/* ---- normals and given vectors ---- */

/* Direction from corner i to the next corner round the cell (step ±1) that is somewhere else. */
static Vec3 side_direction(const SurfaceMesh *mesh, const SurfaceCell *cell, int i, int step) {
    int count = cell->corner_count;
    for (int k = 1; k < count; k++) {
        uint32_t other = cell->vertex[(i + count + step * k) % count];
        if (other == cell->vertex[i]) continue;
        return vec3_normalize(vec3_sub(mesh->vertices[other], mesh->vertices[cell->vertex[i]]));
    }
    return vec3_splat(0);
}

/* The normal of the cell at corner i, as long as the angle there. */
static Vec3 corner_normal(const SurfaceMesh *mesh, const SurfaceCell *cell, int i) {
    Vec3 next = side_direction(mesh, cell, i, 1), last = side_direction(mesh, cell, i, -1);
    Vec3 normal = vec3_cross(next, last);
    double sine = vec3_length(normal);
    if (!(sine > 1e-12)) return vec3_splat(0);
    return vec3_scale(normal, atan2(sine, vec3_dot(next, last)) / sine);
}

static void make_normals(const Assembly *a, const bool *turned) {
    SurfaceMesh *mesh = a->out;
    Vec3 *normals = arena_new_array(a->arena, Vec3, mesh->vertex_count);
    for (size_t c = 0; c < mesh->cell_count; c++) {
        const DraftCell *from = &a->draft->cells[c];
        for (int i = 0; i < from->corner_count; i++) {
            const SoupVertex *draft =
                &a->draft->vertices.items[from->vertex[draft_corner(i, from->corner_count, turned[c])]];
            Vec3 normal = corner_normal(mesh, &mesh->cells[c], i), *sum = &normals[mesh->cells[c].vertex[i]];
            double angle = vec3_length(normal);
            if (from->directed && vec3_length_squared(draft->normal) > 0) {
                normal = vec3_scale(draft->normal, turned[c] ? -angle : angle);
            }
            *sum = vec3_add(*sum, normal);
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        normals[i] = vec3_length(normals[i]) > 1e-9 ? vec3_normalize(normals[i]) : vec3(0, 1, 0);
    }
    mesh->normals = normals;
}

static void make_height_vectors(const Assembly *a) {
    Vec3 *heights = NULL;
    for (size_t i = a->draft->vertices.count; i-- > 0;) {
        const Vec3 *given = a->draft->vertices.items[i].height;
        if (!given) continue;
        if (!heights) heights = arena_copy(a->arena, a->out->normals, a->out->vertex_count * sizeof(Vec3));
        heights[a->place[i]] = *given;
    }
    a->out->height_vectors = heights;
}

static void make_w_vectors(const Assembly *a) {
    Vec3 *ws = NULL;
    for (size_t i = a->draft->vertices.count; i-- > 0;) {
        const Vec3 *given = a->draft->vertices.items[i].w;
        if (!given) continue;
        if (!ws) {
            ws = arena_new_array(a->arena, Vec3, a->out->vertex_count);
            for (size_t k = 0; k < a->out->vertex_count; k++) ws[k] = vec3(0, 1, 0);
        }
        ws[a->place[i]] = *given;
    }
    a->out->w_vectors = ws;
}

bool surface_mesh_build(const Surface *surface, const SurfaceMeshOptions *options, Arena *arena,
                        SurfaceMesh *out, ShapeRefusal *refusal) {
    SurfaceDraft draft;
    *out = (SurfaceMesh){0};
    if (!surface_draft_build(surface, options, arena, &draft, refusal)) return false;
    out->shortest_cut = draft.shortest_cut;
    Assembly assembly = {.draft = &draft, .arena = arena, .out = out};
    bool *turned = arena_new_array(arena, bool, draft.cell_count);
    join_positions(&assembly);
    join_uvs(&assembly);
    JoinedCells joined = join_cells(&assembly);
    surface_front_choose(&joined, arena, turned);
    make_cells(&assembly, turned);
    make_neighbours(&assembly, &joined, turned);
    make_normals(&assembly, turned);
    make_height_vectors(&assembly);
    make_w_vectors(&assembly);
    return true;
}
