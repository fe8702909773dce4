/* Surfaces as what rays meet: the cells that skins lie on, as triangles with their smooth normals. */
#include "shape/intersect.h"
#include "shape/solid.h"
#include "shape/surface_mesh.h"

#include <math.h>

/* Curved solids are followed to this share of the surface's diagonal. */
static const double TOLERANCE = 1e-4;

static double tolerance_of(const Object *object) {
    Box3 box = shape_bounds(object);
    double diagonal = vec3_length(vec3_sub(box.max, box.min));
    return diagonal > 0 && isfinite(diagonal) ? TOLERANCE * diagonal : TOLERANCE;
}

/* A patch of four corners is two triangles. */
static void add_cells(const SurfaceMesh *surface, MeshData *mesh, Arena *arena) {
    uint32_t(*triangles)[3] = arena_push(arena, 2 * surface->cell_count * sizeof *triangles);
    for (size_t i = 0; i < surface->cell_count; i++) {
        const SurfaceCell *cell = &surface->cells[i];
        for (int k = 2; k < cell->corner_count; k++) {
            uint32_t *corner = triangles[mesh->triangle_count++];
            corner[0] = cell->vertex[0];
            corner[1] = cell->vertex[k - 1];
            corner[2] = cell->vertex[k];
        }
    }
    mesh->triangles = (const uint32_t(*)[3])triangles;
}

static const void *prepare(const Object *object, Arena *arena) {
    const Surface *surface = object->as.surface;
    SurfaceMesh cells;
    ShapeRefusal refusal;
    MeshData *mesh = arena_new(arena, MeshData);
    const SurfaceMeshOptions options = {.tolerance = tolerance_of(object)};
    if (surface_mesh_build(surface, &options, arena, &cells, &refusal)) {
        mesh->vertices = cells.vertices;
        mesh->vertex_count = cells.vertex_count;
        mesh->normals = cells.normals;
        mesh->normal_count = cells.vertex_count;
        add_cells(&cells, mesh, arena);
    }
    const Object triangles = {.kind = OBJECT_TRIANGLES, .as.mesh = mesh};
    return solid_mesh_ops.prepare(&triangles, arena);
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) { solid_mesh_ops.cross(data, ray, sink); }

static Vec3 normal(const void *data, Vec3 point, const SolidTag *tag) {
    return solid_mesh_ops.normal(data, point, tag);
}

static Box3 bounds(const void *data) { return solid_mesh_ops.bounds(data); }

const SolidOps solid_surface_ops = {.prepare = prepare, .cross = cross, .normal = normal, .bounds = bounds};
