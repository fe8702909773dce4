/* Particles one by one, and meshes as what hangs together. */
#include "render/wang.h"
#include "scene/scene_bounds.h"

#include <string.h>

/* ---- particles ---- */

static void particle_pieces(const Object *object, Arena *arena, WangPieces *out) {
    size_t count = object->as.particles.count;
    uint32_t *piece = arena_new_array(arena, uint32_t, count);
    Box3 *bounds = arena_new_array(arena, Box3, count);
    Object one = object_copy(object);
    one.as.particles.count = 1;
    for (size_t i = 0; i < count; i++) {
        one.as.particles.items = &object->as.particles.items[i];
        bounds[i] = object_bounds(&one);
        piece[i] = (uint32_t)i;
    }
    *out = (WangPieces){object, count, count, piece, bounds};
}

static const Object *pick_particles(const Object *object, const uint32_t *units, size_t count, Arena *arena) {
    Particle *items = arena_new_array(arena, Particle, count);
    for (size_t i = 0; i < count; i++) items[i] = object->as.particles.items[units[i]];
    Object part = object_copy(object);
    part.as.particles.items = items;
    part.as.particles.count = count;
    return object_keep(arena, &part, NULL);
}

/* ---- meshes ---- */

static uint32_t find_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void join(uint32_t *parent, uint32_t a, uint32_t b) {
    a = find_root(parent, a), b = find_root(parent, b);
    if (a < b) parent[b] = a;
    else parent[a] = b;
}

static uint64_t place_hash(Vec3 p) {
    Hash128 h = hash_begin(0);
    hash_add_double(&h, p.x), hash_add_double(&h, p.y), hash_add_double(&h, p.z);
    return h.lo;
}

static bool same_place(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Vertices at one place are one. */
static void join_places(const MeshData *mesh, uint32_t *parent, Arena *arena) {
    size_t size = 16;
    while (size < 2 * mesh->vertex_count) size *= 2;
    uint32_t *table = arena_new_array(arena, uint32_t, size); /* 0: free, else number + 1 */
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        size_t at = (size_t)place_hash(mesh->vertices[i]) & (size - 1);
        while (table[at] && !same_place(mesh->vertices[table[at] - 1], mesh->vertices[i])) at = (at + 1) & (size - 1);
        if (table[at]) join(parent, table[at] - 1, (uint32_t)i);
        else table[at] = (uint32_t)i + 1;
    }
}

static void mesh_pieces(const Object *object, Arena *arena, WangPieces *out) {
    const MeshData *mesh = object->as.mesh;
    Transform place = object_transform(object);
    size_t vertices = mesh->vertex_count, count = 0;
    uint32_t *parent = arena_new_array(arena, uint32_t, vertices), *number = arena_new_array(arena, uint32_t, vertices);
    uint32_t *piece = arena_new_array(arena, uint32_t, mesh->triangle_count);
    for (size_t i = 0; i < vertices; i++) parent[i] = (uint32_t)i, number[i] = UINT32_MAX;
    join_places(mesh, parent, arena);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 1; k < 3; k++) join(parent, mesh->triangles[i][0], mesh->triangles[i][k]);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t root = find_root(parent, mesh->triangles[i][0]);
        if (number[root] == UINT32_MAX) number[root] = (uint32_t)count++;
        piece[i] = number[root];
    }
    Box3 *bounds = arena_new_array(arena, Box3, count);
    for (size_t i = 0; i < count; i++) bounds[i] = box3_empty();
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            bounds[piece[i]] = box3_add_point(bounds[piece[i]], transform_point(&place, mesh->vertices[mesh->triangles[i][k]]));
    *out = (WangPieces){object, count, mesh->triangle_count, piece, bounds};
}

static const uint32_t (*pick_corners(const uint32_t (*from)[3], const uint32_t *units, size_t count, Arena *arena))[3] {
    if (!from) return NULL;
    uint32_t(*out)[3] = arena_push_array_(arena, count, sizeof *out);
    for (size_t i = 0; i < count; i++) memcpy(out[i], from[units[i]], sizeof *out);
    return (const uint32_t(*)[3])out;
}

static const Object *pick_triangles(const Object *object, const uint32_t *units, size_t count, Arena *arena) {
    const MeshData *from = object->as.mesh;
    MeshData *mesh = arena_new(arena, MeshData);
    *mesh = *from;
    mesh->single = false;
    mesh->triangle_count = count;
    mesh->triangles = pick_corners(from->triangles, units, count, arena);
    mesh->normal_triangles = pick_corners(from->normal_triangles ? from->normal_triangles : from->normals ? from->triangles : NULL, units, count, arena);
    mesh->uv_triangles = pick_corners(from->uv_triangles ? from->uv_triangles : from->uvs ? from->triangles : NULL, units, count, arena);
    mesh->corner_textures = pick_corners(from->corner_textures, units, count, arena);
    if (from->triangle_textures) {
        uint32_t *textures = arena_new_array(arena, uint32_t, count);
        for (size_t i = 0; i < count; i++) textures[i] = from->triangle_textures[units[i]];
        mesh->triangle_textures = textures;
    }
    hash_add(&mesh->hash, units, count * sizeof *units);
    Object part = object_copy(object);
    part.as.mesh = mesh;
    return object_keep(arena, &part, NULL);
}

/* ---- both ---- */

bool wang_pieces_of(const Object *object, Arena *arena, WangPieces *out) {
    if (object->rest && object->rest->clipped_by.count) return false;
    if (object->kind == OBJECT_PARTICLES) particle_pieces(object, arena, out);
    else if (object->kind == OBJECT_TRIANGLES) mesh_pieces(object, arena, out);
    else return false;
    return true;
}

const Object *wang_pieces_pick(const WangPieces *pieces, const uint32_t *units, size_t count, Arena *arena) {
    bool triangles = pieces->object->kind == OBJECT_TRIANGLES;
    return triangles ? pick_triangles(pieces->object, units, count, arena) : pick_particles(pieces->object, units, count, arena);
}
