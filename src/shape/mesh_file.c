#include "shape/mesh_file.h"

#include "scene/scene_hash.h"
#include "shape/mesh_program.h"
#include "shape/mesh_stream.h"
#include "shape/weld.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_COLORS = 256 };

/* A part where it lies in the stream. Arrays may be unaligned. */
typedef struct StreamPart {
    MeshStreamPart head;
    const unsigned char *positions, *normals, *uvs, *triangles; /* NULL: none */
    size_t group;
} StreamPart;

/* A mesh while parts are put into it. */
typedef struct MeshDraft {
    MeshData mesh;
    Vec3 *vertices, *normals, *uvs;
    uint32_t *vertex_place, *normal_place, *uv_place; /* of the stream's vertices, and of normals that were added */
    size_t stream_vertices, stream_triangles;
    size_t given_normals, own_normals; /* of the stream; behind them those that were added */
    uint32_t (*triangles)[3], (*normal_triangles)[3], (*uv_triangles)[3];
    bool has_normals, has_uvs;
} MeshDraft;

/* ---- the stream ---- */

static const unsigned char *take(const unsigned char **at, size_t *left, size_t count, size_t size) {
    if (count > *left / size) return NULL;
    const unsigned char *taken = *at;
    *at += count * size;
    *left -= count * size;
    return taken;
}

static bool take_part(const unsigned char **at, size_t *left, StreamPart *out) {
    const unsigned char *head = take(at, left, 1, sizeof out->head);
    if (!head) return false;
    memcpy(&out->head, head, sizeof out->head);
    size_t n = out->head.vertex_count;
    if (!(out->positions = take(at, left, n, 12))) return false;
    if (out->head.flags & MESH_STREAM_NORMALS && !(out->normals = take(at, left, n, 12))) return false;
    if (out->head.flags & MESH_STREAM_UVS && !(out->uvs = take(at, left, n, 8))) return false;
    return (out->triangles = take(at, left, out->head.triangle_count, 12)) != NULL;
}

static Vec3 vector_at(const unsigned char *array, size_t i, size_t components) {
    float v[3] = {0, 0, 0};
    memcpy(v, array + 4 * components * i, 4 * components);
    return vec3((double)v[0], (double)v[1], (double)v[2]);
}

static const char *part_fault(const StreamPart *part) {
    for (size_t i = 0; i < part->head.vertex_count; i++)
        if (!vec3_is_finite(vector_at(part->positions, i, 3))) return "a coordinate in it is not a number";
    for (size_t i = 0; i < 3 * (size_t)part->head.triangle_count; i++) {
        uint32_t index;
        memcpy(&index, part->triangles + 4 * i, sizeof index);
        if (index >= part->head.vertex_count) return "it is damaged: a triangle has a corner that does not exist";
    }
    return NULL;
}

static StreamPart *take_all(const unsigned char *bytes, size_t size, uint32_t count, Arena *arena, const char **fault) {
    *fault = "it is damaged";
    if (count > size / sizeof(MeshStreamPart)) return NULL;
    StreamPart *parts = arena_new_array(arena, StreamPart, count);
    for (size_t i = 0; i < count; i++) {
        if (!take_part(&bytes, &size, &parts[i])) return NULL;
        const char *wrong = part_fault(&parts[i]);
        if (wrong) return *fault = wrong, NULL;
    }
    return parts;
}

/* ---- one mesh of several parts ---- */

/* Where a part's vertices and normals begin among those of all parts. */
typedef struct StreamPlace {
    size_t vertex, normal;
} StreamPlace;

static void pass_part(StreamPlace *place, const StreamPart *part) {
    place->vertex += part->head.vertex_count;
    if (part->normals) place->normal += part->head.vertex_count;
}

static void count_part(MeshDraft *draft, const StreamPart *part) {
    draft->stream_vertices += part->head.vertex_count;
    draft->stream_triangles += part->head.triangle_count;
    if (part->normals) draft->given_normals += part->head.vertex_count;
    draft->has_normals |= part->normals != NULL;
    draft->has_uvs |= part->uvs != NULL;
}

static void allocate(MeshDraft *draft, bool smooth, Arena *arena) {
    size_t n = draft->stream_vertices, t = draft->stream_triangles;
    draft->has_normals |= smooth;
    draft->vertices = arena_new_array(arena, Vec3, n);
    draft->vertex_place = arena_new_array(arena, uint32_t, n);
    draft->triangles = arena_push_array_(arena, t, sizeof *draft->triangles);
    if (draft->has_normals) { /* flat triangles bring one of their own each, smooth ones one for each vertex */
        size_t most = draft->given_normals + (smooth ? n : t);
        draft->normals = arena_new_array(arena, Vec3, most);
        draft->normal_place = arena_new_array(arena, uint32_t, most);
        draft->normal_triangles = arena_push_array_(arena, t, sizeof *draft->normal_triangles);
    }
    if (draft->has_uvs) {
        draft->uvs = arena_new_array(arena, Vec3, n);
        draft->uv_place = arena_new_array(arena, uint32_t, n);
        draft->uv_triangles = arena_push_array_(arena, t, sizeof *draft->uv_triangles);
    }
}

/* Vertices only, at their place among those of all parts. */
static void add_vertices(MeshDraft *draft, const StreamPart *part, StreamPlace first) {
    for (size_t i = 0; i < part->head.vertex_count; i++) {
        draft->vertices[first.vertex + i] = vector_at(part->positions, i, 3);
        if (draft->has_normals && part->normals) {
            Vec3 normal = vector_at(part->normals, i, 3);
            draft->normals[first.normal + i] = vec3_is_finite(normal) ? vec3_normalize(normal) : vec3_splat(0);
        }
        if (draft->has_uvs && part->uvs) {
            Vec3 uv = vector_at(part->uvs, i, 2);
            draft->uvs[first.vertex + i] = vec3_is_finite(uv) ? uv : vec3_splat(0);
        }
    }
}

/* Equal vectors become one each; the others move up. Returns how many are left. */
static size_t unite(Vec3 *vectors, size_t count, uint32_t *place, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    size_t left = weld_points(vectors, count, 0, arena, place);
    arena_reset_to(arena, mark);
    for (size_t i = 0; i < count; i++) vectors[place[i]] = vectors[i];
    return left;
}

static Vec3 triangle_area(const Vec3 *vertices, const uint32_t *t) {
    return vec3_cross(vec3_sub(vertices[t[1]], vertices[t[0]]), vec3_sub(vertices[t[2]], vertices[t[0]]));
}

/* The part's triangles, of which those without area are left out. Corners are still numbered as in the stream, but for those of
 * triangles whose normals are to be found. */
static void add_triangles(MeshDraft *draft, const StreamPart *part, StreamPlace first, bool smooth) {
    for (size_t i = 0; i < part->head.triangle_count; i++) {
        uint32_t corner[3], *t = draft->triangles[draft->mesh.triangle_count];
        memcpy(corner, part->triangles + 12 * i, sizeof corner);
        for (int k = 0; k < 3; k++) t[k] = draft->vertex_place[first.vertex + corner[k]];
        Vec3 area = triangle_area(draft->vertices, t);
        if (!(vec3_length_squared(area) > 0)) continue;
        if (draft->has_normals) {
            uint32_t *n = draft->normal_triangles[draft->mesh.triangle_count];
            size_t own = draft->given_normals + draft->own_normals;
            if (!part->normals && !smooth) draft->normals[draft->given_normals + draft->own_normals++] = vec3_normalize(area);
            for (int k = 0; k < 3; k++)
                n[k] = (uint32_t)(part->normals ? first.normal + corner[k] : smooth ? own + t[k] : own);
        }
        if (draft->has_uvs)
            for (int k = 0; k < 3; k++)
                draft->uv_triangles[draft->mesh.triangle_count][k] = (uint32_t)(first.vertex + corner[k]);
        draft->mesh.triangle_count++;
    }
}

static double corner_angle(const Vec3 *vertices, const uint32_t *t, int k) {
    Vec3 a = vec3_normalize(vec3_sub(vertices[t[(k + 1) % 3]], vertices[t[k]]));
    Vec3 b = vec3_normalize(vec3_sub(vertices[t[(k + 2) % 3]], vertices[t[k]]));
    return acos(double_clamp(vec3_dot(a, b), -1, 1));
}

/* Normals of vertices, where triangles ask for them, behind those of the stream. */
static void add_smooth_normals(MeshDraft *draft) {
    Vec3 *sum = draft->normals + draft->given_normals;
    for (size_t i = 0; i < draft->mesh.triangle_count; i++) {
        const uint32_t *t = draft->triangles[i];
        if (draft->normal_triangles[i][0] < draft->given_normals) continue;
        Vec3 normal = vec3_normalize(triangle_area(draft->vertices, t));
        for (int k = 0; k < 3; k++) sum[t[k]] = vec3_madd(sum[t[k]], normal, corner_angle(draft->vertices, t, k));
    }
    for (size_t i = 0; i < draft->mesh.vertex_count; i++) sum[i] = vec3_normalize(sum[i]);
    draft->own_normals = draft->mesh.vertex_count;
}

static void renumber(uint32_t (*triangles)[3], size_t count, const uint32_t *place) {
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) triangles[i][k] = place[triangles[i][k]];
}

/* Normals that nothing defines (none given, or opposite faces) are their triangle's own. */
static void mend_normals(MeshDraft *draft) {
    for (size_t i = 0; i < draft->mesh.triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            Vec3 *normal = &draft->normals[draft->normal_triangles[i][k]];
            if (vec3_length_squared(*normal) == 0)
                *normal = vec3_normalize(triangle_area(draft->vertices, draft->triangles[i]));
        }
}

static void finish_normals(MeshDraft *draft, Arena *arena) {
    MeshData *mesh = &draft->mesh;
    mend_normals(draft);
    mesh->normal_count = unite(draft->normals, draft->given_normals + draft->own_normals, draft->normal_place, arena);
    renumber(draft->normal_triangles, mesh->triangle_count, draft->normal_place);
    mesh->normals = draft->normals;
    mesh->normal_triangles = (const uint32_t(*)[3])draft->normal_triangles;
}

static void finish_uvs(MeshDraft *draft, Arena *arena) {
    MeshData *mesh = &draft->mesh;
    mesh->uv_count = unite(draft->uvs, draft->stream_vertices, draft->uv_place, arena);
    renumber(draft->uv_triangles, mesh->triangle_count, draft->uv_place);
    mesh->uvs = draft->uvs;
    mesh->uv_triangles = (const uint32_t(*)[3])draft->uv_triangles;
}

static const MeshData *mesh_of_group(const StreamPart *parts, size_t count, size_t group, bool smooth, Arena *arena) {
    MeshDraft *draft = arena_new(arena, MeshDraft);
    for (size_t i = 0; i < count; i++)
        if (parts[i].group == group) count_part(draft, &parts[i]);
    allocate(draft, smooth, arena);
    StreamPlace first = {0};
    for (size_t i = 0; i < count; i++)
        if (parts[i].group == group) {
            add_vertices(draft, &parts[i], first);
            pass_part(&first, &parts[i]);
        }
    MeshData *mesh = &draft->mesh;
    mesh->vertex_count = unite(draft->vertices, draft->stream_vertices, draft->vertex_place, arena);
    first = (StreamPlace){0};
    for (size_t i = 0; i < count; i++)
        if (parts[i].group == group) {
            add_triangles(draft, &parts[i], first, smooth);
            pass_part(&first, &parts[i]);
        }
    mesh->vertices = draft->vertices;
    mesh->triangles = (const uint32_t(*)[3])draft->triangles;
    if (smooth) add_smooth_normals(draft);
    if (draft->has_normals) finish_normals(draft, arena);
    if (draft->has_uvs) finish_uvs(draft, arena);
    mesh_rehash(mesh);
    return mesh;
}

/* ---- the file ---- */

static bool same_look(const StreamPart *a, const StreamPart *b) {
    uint32_t colored = a->head.flags & MESH_STREAM_COLOR;
    return colored == (b->head.flags & MESH_STREAM_COLOR) &&
           (!colored || memcmp(a->head.color, b->head.color, sizeof a->head.color) == 0);
}

/* Gives parts of one colour one group; returns how many there are. All are one group where there would be too many. */
static size_t group_parts(StreamPart *parts, size_t count, bool by_color) {
    const StreamPart *first[MOST_COLORS];
    size_t groups = 0;
    for (size_t i = 0; by_color && i < count; i++) {
        size_t g = 0;
        while (g < groups && !same_look(first[g], &parts[i])) g++;
        if (g == MOST_COLORS) return group_parts(parts, count, false);
        if (g == groups) first[groups++] = &parts[i];
        parts[i].group = g;
    }
    for (size_t i = 0; !by_color && i < count; i++) parts[i].group = 0;
    return by_color ? groups : 1;
}

static double share(double number) { return number >= 0 && number <= 1 ? number : number > 1 ? 1 : 0; }

static MeshFilePart file_part(const StreamPart *parts, size_t count, size_t group, bool smooth, Arena *arena) {
    MeshFilePart out = {.mesh = mesh_of_group(parts, count, group, smooth, arena)};
    for (size_t i = 0; i < count && !out.colored; i++)
        if (parts[i].group == group && parts[i].head.flags & MESH_STREAM_COLOR) {
            const double *c = parts[i].head.color;
            out.colored = true;
            out.color = (Color){share(c[0]), share(c[1]), share(c[2]), 0, 1 - share(c[3])};
        }
    return out;
}

static const char *assemble(const unsigned char *bytes, size_t size, uint32_t part_count, const MeshFileOptions *options, Arena *arena,
                            MeshFile *out) {
    const char *fault;
    StreamPart *parts = take_all(bytes, size, part_count, arena, &fault);
    if (!parts) return fault;
    size_t vertices = 0, groups = group_parts(parts, part_count, options->by_color);
    for (size_t i = 0; i < part_count; i++) vertices += parts[i].head.vertex_count + (size_t)parts[i].head.triangle_count;
    if (vertices > UINT32_MAX / 2) return "it has too many vertices";
    MeshFilePart *made = arena_new_array(arena, MeshFilePart, groups);
    for (size_t g = 0; g < groups; g++) {
        made[out->part_count] = file_part(parts, part_count, g, options->smooth, arena);
        out->part_count += made[out->part_count].mesh->triangle_count > 0;
    }
    out->parts = made;
    return out->part_count ? NULL : "no triangle in it has an area";
}

/* About what assemble() takes from the arena: asked for beforehand, since nothing else frees the bytes when the arena runs out. */
static bool leaves_room(MemoryBudget *memory, size_t size) {
    bool room = size < SIZE_MAX / 8 && memory_budget_take(memory, 8 * size);
    if (room) memory_budget_give_back(memory, 8 * size);
    return room;
}

bool mesh_file_read(const char *path, const MeshFileOptions *options, Arena *arena, MeshFile *out, StrBuf *error) {
    unsigned char *bytes = NULL;
    size_t size = 0;
    uint32_t part_count = 0;
    uint64_t most = options->most_vertices ? options->most_vertices : UINT32_MAX / 4;
    *out = (MeshFile){0};
    if (!mesh_program_run(path, most, arena->budget, &bytes, &size, &part_count, error)) return false;
    bool room = leaves_room(arena->budget, size);
    const char *fault = room ? assemble(bytes, size, part_count, options, arena, out) : "it does not fit into the memory limit";
    free(bytes);
    memory_budget_give_back(arena->budget, size);
    if (fault) strbuf_adds(error, fault);
    return !fault;
}
