#include "shape/solid.h"

static const SolidOps nothing = {0};

static const SolidOps *const rare[] = {
    [SOLID_POLYNOMIAL] = &solid_polynomial_ops,
    [SOLID_QUADRIC] = &solid_quadric_ops,
    [SOLID_POLYGON] = &solid_polygon_ops,
    [SOLID_SUPERELLIPSOID] = &solid_super_ops,
    [SOLID_PATCH] = &solid_patch_ops,
    [SOLID_BLOB] = &solid_blob_ops,
    [SOLID_LATHE] = &solid_lathe_ops,
    [SOLID_SOR] = &solid_sor_ops,
    [SOLID_PRISM] = &solid_prism_ops,
    [SOLID_SWEEP] = &solid_sweep_ops,
    [SOLID_TEXT] = &solid_text_ops,
    [SOLID_JULIA] = &solid_julia_ops,
    [SOLID_OVUS] = &solid_ovus_ops,
    [SOLID_ISOSURFACE] = &solid_isosurface_ops,
    [SOLID_PARAMETRIC] = &solid_parametric_ops,
    [SOLID_HEIGHT_FIELD] = &solid_height_ops,
};

static bool is_ground(const Surface *surface) { return surface->kind == SURFACE_TERRAIN && !surface->deform; }

const SolidOps *solid_ops(const Object *object) {
    switch (object->kind) {
    case OBJECT_SPHERE: return &solid_sphere_ops;
    case OBJECT_BOX: return &solid_box_ops;
    case OBJECT_TORUS: return &solid_torus_ops;
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
    case OBJECT_PLANE:
    case OBJECT_DISC: return &solid_plain_ops;
    case OBJECT_TRIANGLES:
        return object->as.mesh->single && object->as.mesh->triangle_count == 1
                   ? &solid_triangle_ops
                   : &solid_mesh_ops;
    case OBJECT_SURFACE: return is_ground(object->as.surface) ? &solid_terrain_ops : &solid_surface_ops;
    case OBJECT_SOLID: return rare[object->as.solid->kind];
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
    case OBJECT_PARTICLES:
    case OBJECT_BRANCHES:
    case OBJECT_TEXEL:
    case OBJECT_VOLUME:
    case OBJECT_UNMODELLED: break;
    }
    return &nothing;
}
