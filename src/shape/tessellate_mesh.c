#include "shape/tessellate_mesh.h"

#include "shape/surface_mesh.h"
#include "shape/weld.h"

/* ---- meshes ---- */

typedef struct MeshCorner {
    uint32_t vertex, normal, uv;
} MeshCorner;

static MeshCorner mesh_corner(const MeshData *mesh, size_t triangle, int corner) {
    uint32_t vertex = mesh->triangles[triangle][corner];
    return (MeshCorner){vertex, mesh->normal_triangles ? mesh->normal_triangles[triangle][corner] : vertex,
                        mesh->uv_triangles ? mesh->uv_triangles[triangle][corner] : vertex};
}

static const char *mesh_fault(const MeshData *mesh) {
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        if (!vec3_is_finite(mesh->vertices[i])) return "a vertex of the mesh is not a finite number";
    }
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            MeshCorner corner = mesh_corner(mesh, t, i);
            if (corner.vertex >= mesh->vertex_count)
                return "a triangle of the mesh names a vertex that it does not have";
            if (mesh->normals && corner.normal >= mesh->normal_count)
                return "a triangle names a normal that the mesh does not have";
            if (mesh->uvs && corner.uv >= mesh->uv_count)
                return "a triangle names a uv vector that the mesh does not have";
        }
    }
    return NULL;
}

static uint32_t push_corner(const MeshData *mesh, MeshCorner corner, Arena *arena, TriangleSoup *out) {
    Vec3 normal = mesh->normals ? vec3_normalize(mesh->normals[corner.normal]) : vec3_splat(0);
    Vec3 uv = mesh->uvs ? mesh->uvs[corner.uv] : vec3_splat((double)NAN);
    uint32_t index = soup_vertex(arena, out, mesh->vertices[corner.vertex], normal, uv.x, uv.y);
    if (mesh->height_vectors) out->vertices.items[index].height = &mesh->height_vectors[corner.vertex];
    if (mesh->w_vectors) out->vertices.items[index].w = &mesh->w_vectors[corner.vertex];
    return index;
}

static bool looks_against_normals(const TriangleSoup *soup, const uint32_t v[3]) {
    const SoupVertex *a = &soup->vertices.items[v[0]], *b = &soup->vertices.items[v[1]],
                     *c = &soup->vertices.items[v[2]];
    Vec3 face = vec3_cross(vec3_sub(b->position, a->position), vec3_sub(c->position, a->position));
    return vec3_dot(face, vec3_add(vec3_add(a->normal, b->normal), c->normal)) < 0;
}

/* Vertices are shared where normals and texture coordinates have the same indices as places. */
static void push_shared(const MeshData *mesh, Arena *arena, TriangleSoup *out) {
    uint32_t first = (uint32_t)out->vertices.count;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) push_corner(mesh, (MeshCorner){i, i, i}, arena, out);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangles[t];
        *list_push(arena, &out->triangles) =
            (SoupTriangle){{first + v[0], first + v[1], first + v[2]}, false};
    }
}

static void push_separate(const MeshData *mesh, Arena *arena, TriangleSoup *out) {
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t v[3];
        for (int i = 0; i < 3; i++) v[i] = push_corner(mesh, mesh_corner(mesh, t, i), arena, out);
        *list_push(arena, &out->triangles) = (SoupTriangle){{v[0], v[1], v[2]}, false};
    }
}

static void turn_to_normals(TriangleSoup *out, SoupMark since) {
    for (size_t t = since.triangle; t < out->triangles.count; t++) {
        uint32_t *v = out->triangles.items[t].vertex, second = v[1];
        if (!looks_against_normals(out, v)) continue;
        v[1] = v[2];
        v[2] = second;
    }
}

/* ---- closed parts ---- */

static uint32_t find_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* Places of the vertices after the mark. */
static uint32_t weld_since(const TriangleSoup *soup, SoupMark since, Arena *arena, uint32_t **place) {
    size_t count = soup->vertices.count - since.vertex;
    Vec3 *points = arena_new_array(arena, Vec3, count);
    for (size_t i = 0; i < count; i++) points[i] = soup->vertices.items[since.vertex + i].position;
    *place = arena_new_array(arena, uint32_t, count);
    return weld_points(points, count, 0, arena, *place);
}

static size_t collect_edges(const TriangleSoup *soup, SoupMark since, const uint32_t *place,
                            WeldEdge *edges) {
    size_t count = 0;
    for (size_t t = since.triangle; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        for (uint8_t e = 0; e < 3; e++) {
            uint32_t a = place[v[e] - since.vertex], b = place[v[(e + 1) % 3] - since.vertex];
            if (a == b) continue;
            edges[count++] =
                (WeldEdge){a < b ? a : b, a < b ? b : a, (uint32_t)(t - since.triangle), e, a < b};
        }
    }
    return count;
}

static size_t run_of_edge(const WeldEdge *edges, size_t count, size_t i) {
    size_t end = i + 1;
    while (end < count && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi) end++;
    return end;
}

/* Triangles joined by edges are one part; a part with an odd edge is open. */
static void mark_closed_parts(TriangleSoup *soup, SoupMark since, Arena *arena) {
    size_t count = soup->triangles.count - since.triangle;
    uint32_t *place, *parent = arena_new_array(arena, uint32_t, count);
    uint32_t places = weld_since(soup, since, arena, &place);
    WeldEdge *edges = arena_new_array(arena, WeldEdge, 3 * count);
    size_t edge_count = collect_edges(soup, since, place, edges);
    bool *open = arena_new_array(arena, bool, count);
    weld_sort_edges(edges, edge_count, places, arena);
    for (uint32_t t = 0; t < count; t++) parent[t] = t;
    for (size_t i = 0, end; i < edge_count; i = end) {
        end = run_of_edge(edges, edge_count, i);
        for (size_t j = i + 1; j < end; j++)
            parent[find_root(parent, edges[j].cell)] = find_root(parent, edges[i].cell);
    }
    for (size_t i = 0, end; i < edge_count; i = end) {
        end = run_of_edge(edges, edge_count, i);
        if ((end - i) % 2) open[find_root(parent, edges[i].cell)] = true;
    }
    for (uint32_t t = 0; t < count; t++)
        soup->triangles.items[since.triangle + t].solid = !open[find_root(parent, t)];
}

bool tessellate_mesh(const MeshData *mesh, int parts, Arena *arena, TriangleSoup *out, const char **reason) {
    SoupMark since = soup_mark(out);
    *reason = mesh_fault(mesh);
    if (*reason) return false;
    bool shared = (!mesh->normals || !mesh->normal_triangles) && (!mesh->uvs || !mesh->uv_triangles);
    if (shared)
        push_shared(mesh, arena, out);
    else
        push_separate(mesh, arena, out);
    if (mesh->normals) turn_to_normals(out, since);
    mark_closed_parts(out, since, arena);
    soup_split(arena, out, since, parts);
    return true;
}
