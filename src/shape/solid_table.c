#include "shape/solid.h"

static const SolidOps nothing = {0};

const SolidOps *solid_ops(const Object *object) {
    switch (object->kind) {
    case OBJECT_SPHERE:
    case OBJECT_BOX:
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
    case OBJECT_PLANE:
    case OBJECT_DISC:
    case OBJECT_TORUS: return &solid_plain_ops;
    case OBJECT_TRIANGLES: return &solid_mesh_ops;
    case OBJECT_UNION:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_MERGE:
    case OBJECT_PARTICLES:
    case OBJECT_SURFACE:
    case OBJECT_TEXEL:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
    return &nothing;
}
