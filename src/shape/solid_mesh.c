/* Triangles of all kinds. */
#include "shape/box_tree.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"

typedef struct MeshSolid {
    const MeshData *mesh;
    const BoxTree *tree;
    Box3 bounds;
} MeshSolid;

static Vec3 corner(const MeshData *mesh, uint32_t triangle, int k) {
    return mesh->vertices[mesh->triangles[triangle][k]];
}

static const void *prepare(const Object *object, Arena *arena) {
    const MeshData *mesh = object->as.mesh;
    MeshSolid *solid = arena_new(arena, MeshSolid);
    Box3 *boxes = arena_new_array(arena, Box3, mesh->triangle_count);
    *solid = (MeshSolid){.mesh = mesh, .bounds = box3_empty()};
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        boxes[i] = box3_empty();
        for (int k = 0; k < 3; k++) boxes[i] = box3_add_point(boxes[i], corner(mesh, i, k));
        solid->bounds = box3_union(solid->bounds, boxes[i]);
    }
    solid->tree = box_tree_build(boxes, mesh->triangle_count, arena);
    return solid;
}

typedef struct RayVisit {
    const MeshSolid *solid;
    const Ray *ray;
    SolidSink *sink;
} RayVisit;

/* By signed volumes over the edges: two triangles agree about a ray through their common edge, which both compute from the
 * same numbers, so that closed meshes have no cracks. */
static bool meet_triangle(const MeshData *mesh, uint32_t triangle, const Ray *ray, double *t, double *u,
                          double *v) {
    Vec3 a = vec3_sub(corner(mesh, triangle, 0), ray->origin),
         b = vec3_sub(corner(mesh, triangle, 1), ray->origin),
         c = vec3_sub(corner(mesh, triangle, 2), ray->origin);
    Vec3 d = ray->direction;
    double bc = vec3_dot(d, vec3_cross(b, c)), ca = vec3_dot(d, vec3_cross(c, a)),
           ab = vec3_dot(d, vec3_cross(a, b));
    if ((bc < 0 || ca < 0 || ab < 0) && (bc > 0 || ca > 0 || ab > 0)) return false;
    double sum = bc + ca + ab;
    if (!(sum != 0)) return false;
    Vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    *t = vec3_dot(normal, a) / vec3_dot(normal, d);
    *u = ca / sum;
    *v = ab / sum;
    return isfinite(*t);
}

static void visit_triangle(void *context, uint32_t triangle) {
    RayVisit *visit = context;
    double t, u, v;
    if (meet_triangle(visit->solid->mesh, triangle, visit->ray, &t, &u, &v))
        solid_offer(visit->sink, t, (SolidTag){triangle, u, v});
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    RayVisit visit = {.solid = data, .ray = ray, .sink = sink};
    box_tree_ray(visit.solid->tree, ray, sink->t_min, &sink->t_max, visit_triangle, &visit);
}

/* (c - a) × (b - a), POV-Ray's side. */
static Vec3 flat_normal(const void *data, Vec3 point, const SolidTag *tag) {
    const MeshData *mesh = ((const MeshSolid *)data)->mesh;
    (void)point;
    Vec3 a = corner(mesh, tag->part, 0);
    return vec3_normalize(vec3_cross(vec3_sub(corner(mesh, tag->part, 2), a), vec3_sub(corner(mesh, tag->part, 1), a)));
}

static Vec3 normal(const void *data, Vec3 point, const SolidTag *tag) {
    const MeshData *mesh = ((const MeshSolid *)data)->mesh;
    Vec3 flat = flat_normal(data, point, tag);
    if (!mesh->normals) return flat;
    const uint32_t *n =
        mesh->normal_triangles ? mesh->normal_triangles[tag->part] : mesh->triangles[tag->part];
    Vec3 mean = vec3_scale(vec3_normalize(mesh->normals[n[0]]), 1 - tag->u - tag->v);
    mean = vec3_madd(mean, vec3_normalize(mesh->normals[n[1]]), tag->u);
    mean = vec3_madd(mean, vec3_normalize(mesh->normals[n[2]]), tag->v);
    mean = vec3_normalize(mean);
    return vec3_length_squared(mean) > 0 ? mean : flat;
}

TexCoord solid_mesh_uv(const MeshData *mesh, uint32_t triangle, double u, double v) {
    const Vec3 *corners = mesh->uvs ? mesh->uvs : mesh->uvs_from_above ? mesh->vertices : NULL;
    if (!corners) return (TexCoord){0, 0};
    const uint32_t *at = mesh->uvs && mesh->uv_triangles ? mesh->uv_triangles[triangle] : mesh->triangles[triangle];
    Vec3 p = vec3_scale(corners[at[0]], 1 - u - v);
    p = vec3_madd(vec3_madd(p, corners[at[1]], u), corners[at[2]], v);
    return (TexCoord){p.x, mesh->uvs ? p.y : p.z};
}

static TexCoord uv(const void *data, Vec3 point, const SolidTag *tag) {
    (void)point;
    return solid_mesh_uv(((const MeshSolid *)data)->mesh, tag->part, tag->u, tag->v);
}

typedef struct CountSink {
    SolidSink base;
    size_t count;
} CountSink;

static void count_crossing(SolidSink *base, double t, const SolidTag *tag) {
    (void)t, (void)tag;
    ((CountSink *)(void *)base)->count++;
}

/* POV-Ray's rule: an odd number of triangles in the direction of inside_vector. */
static bool inside(const void *data, Vec3 point) {
    const MeshSolid *solid = data;
    const Ray ray = {point, solid->mesh->inside_vector};
    if (vec3_length_squared(ray.direction) == 0) return false;
    CountSink sink = {.base = {.t_max = VTS_INFINITY, .take = count_crossing}};
    cross(data, &ray, &sink.base);
    return sink.count & 1;
}

static Box3 bounds(const void *data) { return ((const MeshSolid *)data)->bounds; }

const SolidOps solid_mesh_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .flat = flat_normal, .uv = uv, .inside = inside, .bounds = bounds};

/* One triangle on its own looks to the same side, inside out or not. */
const SolidOps solid_triangle_ops = {.prepare = prepare,
                                     .cross = cross,
                                     .normal = normal,
                                     .flat = flat_normal,
                                     .inside = inside,
                                     .bounds = bounds,
                                     .keeps_normal = true};
