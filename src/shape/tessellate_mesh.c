#include "shape/tessellate_mesh.h"

#include "shape/soup_stitch.h"

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
    const Vec3 *at = &mesh->vertices[corner.vertex];
    Vec3 uv = mesh->uvs ? mesh->uvs[corner.uv] : mesh->uvs_from_above ? vec3(at->x, at->z, 0) : vec3_splat((double)NAN);
    uint32_t index = soup_vertex(arena, out, *at, normal, uv.x, uv.y);
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
        *list_push_sole(arena, &out->triangles) =
            (SoupTriangle){{first + v[0], first + v[1], first + v[2]}, false, 0};
    }
}

static void push_separate(const MeshData *mesh, Arena *arena, TriangleSoup *out) {
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t v[3];
        for (int i = 0; i < 3; i++) v[i] = push_corner(mesh, mesh_corner(mesh, t, i), arena, out);
        *list_push_sole(arena, &out->triangles) = (SoupTriangle){{v[0], v[1], v[2]}, false, 0};
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
    soup_mark_closed(arena, out, since);
    soup_split(arena, out, since, parts);
    return true;
}
