#include "shape/surface_mesh.h"
#include "shape/tessellate_mesh.h"

enum { MOST_CUTS = 64 };

typedef struct PatchGrid {
    const SurfaceMesh *mesh;
    const SurfaceCell *cell;
    int cuts;
} PatchGrid;

static Vec3 bilinear(const Vec3 c[4], double s, double t) {
    return vec3_lerp(vec3_lerp(c[0], c[1], s), vec3_lerp(c[3], c[2], s), t);
}

static SoupVertex patch_point(const void *context, int i, int j) {
    const PatchGrid *grid = context;
    double s = (double)j / grid->cuts, t = (double)i / grid->cuts;
    Vec3 corner[4], normal[4], uv[4];
    for (int k = 0; k < 4; k++) {
        TexCoord at = grid->mesh->uvs[grid->cell->uv[k]];
        corner[k] = grid->mesh->vertices[grid->cell->vertex[k]];
        normal[k] = grid->mesh->normals[grid->cell->vertex[k]];
        uv[k] = vec3(at.u, at.v, 0);
    }
    Vec3 at = bilinear(uv, s, t);
    return (SoupVertex){
        bilinear(corner, s, t), vec3_normalize(bilinear(normal, s, t)), {at.x, at.y}, NULL, NULL};
}

/* A bilinear patch leaves its two triangles by a quarter of c0 - c1 + c2 - c3 in the middle, a square less when cut. */
static int patch_cuts(const SurfaceMesh *mesh, const SurfaceCell *cell, double tolerance) {
    Vec3 twist = vec3_sub(vec3_add(mesh->vertices[cell->vertex[0]], mesh->vertices[cell->vertex[2]]),
                          vec3_add(mesh->vertices[cell->vertex[1]], mesh->vertices[cell->vertex[3]]));
    double cuts = ceil(sqrt(vec3_length(twist) / 4 / tolerance));
    return cuts > 1 ? (int)double_min(cuts, MOST_CUTS) : 1;
}

static void push_triangle(const SurfaceMesh *mesh, const SurfaceCell *cell, Arena *arena, TriangleSoup *out) {
    uint32_t v[3];
    for (int i = 0; i < 3; i++) {
        TexCoord uv = mesh->uvs[cell->uv[i]];
        v[i] = soup_vertex(arena, out, mesh->vertices[cell->vertex[i]], mesh->normals[cell->vertex[i]], uv.u,
                           uv.v);
    }
    soup_triangle(arena, out, v[0], v[1], v[2], false);
}

bool tessellate_surface(const Surface *surface, double tolerance, Arena *arena, TriangleSoup *out,
                        ShapeRefusal *refusal) {
    const SurfaceMeshOptions options = {.tolerance = tolerance};
    SurfaceMesh mesh;
    int cuts = 1; /* the same for all, so that edges meet */
    if (!surface_mesh_build(surface, &options, arena, &mesh, refusal)) return false;
    for (size_t c = 0; c < mesh.cell_count; c++) {
        if (mesh.cells[c].corner_count == 4)
            cuts = int_max(cuts, patch_cuts(&mesh, &mesh.cells[c], tolerance));
    }
    for (size_t c = 0; c < mesh.cell_count; c++) {
        const PatchGrid context = {&mesh, &mesh.cells[c], cuts};
        const SoupGrid grid = {cuts, cuts, false, false, false};
        if (mesh.cells[c].corner_count == 3)
            push_triangle(&mesh, &mesh.cells[c], arena, out);
        else
            soup_grid(arena, out, &grid, patch_point, &context);
    }
    return true;
}
