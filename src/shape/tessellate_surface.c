#include "shape/tessellate_mesh.h"

bool tessellate_surface(const Surface *surface, double tolerance, Arena *arena, TriangleSoup *out,
                        ShapeRefusal *refusal) {
    (void)tolerance, (void)arena, (void)out;
    *refusal = (ShapeRefusal){surface->span, "surfaces have no triangles yet"};
    return false;
}
