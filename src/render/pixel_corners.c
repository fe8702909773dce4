#include "render/pixel_corners.h"

/* Where a pixel is wider than this part of a texel's tile its line of sight tells little of what it sees of a skin: other copies, and the ground's own
 * shape, lie beside it. */
static const double WIDE = 0.5;

bool pixel_surface(const CompiledScene *compiled, const Cone *cone, bool places, SurfaceHit *hit) {
    const Ray ray = {cone->origin, cone->direction};
    return hierarchy_meet_wide(compiled->hierarchy, RAY_SEES, &ray, cone_width(cone), 1e-9, VTS_INFINITY, places, hit);
}

/* What the pixel's corner sees: 0 and 1 above, 2 and 3 below. */
static bool corner_surface(const CompiledScene *compiled, double x, double y, int corner, SurfaceHit *hit) {
    const Cone cone = view_cone(&compiled->view, x + (corner & 1 ? 0.499 : -0.499), y + (corner & 2 ? 0.499 : -0.499), 1);
    return pixel_surface(compiled, &cone, false, hit);
}

/* The same part, much the same direction and depth. */
static bool alike(const SurfaceHit *a, const SurfaceHit *b) {
    return a->object == b->object && vec3_dot(a->normal, b->normal) > 0.95 &&
           fabs(a->t - b->t) < 0.05 * (a->t + b->t);
}

bool pixel_surfaces_vary(const CompiledScene *compiled, double x, double y, const SurfaceHit *hit) {
    for (int corner = 0; corner < 4; corner++) {
        SurfaceHit other;
        const bool found = corner_surface(compiled, x, y, corner, &other);
        if (found != (hit != NULL) || (found && !alike(hit, &other))) return true;
    }
    return false;
}

bool pixel_is_wide(const CompiledScene *compiled, double x, double y, const SurfaceHit *hit) {
    const double widest = WIDE * compiled->least_tile;
    if (!isfinite(widest)) return false;
    const Cone cone = view_cone(&compiled->view, x, y, 1);
    if (hit) return cone_diameter(&cone, hit->t) > widest;
    for (int corner = 2; corner < 6; corner++) { /* those below come first */
        SurfaceHit found;
        if (corner_surface(compiled, x, y, corner, &found)) return cone_diameter(&cone, found.t) > widest;
    }
    return false;
}
