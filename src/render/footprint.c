#include "render/footprint.h"

static const double MOST_STRETCH = 100;
/* The rays beside the axis lie so many diameters off: far enough that rounding does not count. */
static const double BESIDE = 0.5;
static const double LEAST_BESIDE = 1e-5; /* of the distance */

void footprint_axes(const Cone *cone, double t, Vec3 normal, Vec3 axes[2]) {
    double width = cone_diameter(cone, t), cosine = fabs(vec3_dot(cone->direction, normal));
    Vec3 along = vec3_madd(cone->direction, normal, -vec3_dot(cone->direction, normal));
    if (vec3_length_squared(along) < 1e-12) {
        vec3_frame(normal, &axes[0], &axes[1]);
    } else {
        axes[0] = vec3_normalize(along);
        axes[1] = vec3_cross(normal, axes[0]);
    }
    axes[0] = vec3_scale(axes[0], width / double_clamp(cosine, 1 / MOST_STRETCH, 1));
    axes[1] = vec3_scale(axes[1], width);
}

static bool is_flat(const SurfaceHit *hit) {
    if (!hit->solid) return false;
    switch (hit->solid->kind) {
    case OBJECT_PLANE:
    case OBJECT_BOX:
    case OBJECT_DISC: return true;
    default: return false;
    }
}

/* Bent alike in all directions, unless what it stands in is stretched. */
static bool is_ball(const SurfaceHit *hit) {
    if (!hit->solid || hit->solid->kind != OBJECT_SPHERE) return false;
    if (!hit->solid->place) return true;
    const Vec3 *c = hit->solid->place->linear.c;
    const double size = vec3_length_squared(c[0]);
    double off = 0;
    for (int k = 0; k < 3; k++) off = fmax(off, fmax(fabs(vec3_length_squared(c[k]) - size), fabs(vec3_dot(c[k], c[(k + 1) % 3]))));
    return off < 1e-6 * size;
}

double footprint_curvature(const Hierarchy *hierarchy, RayPurpose purpose, const Cone *cone, const SurfaceHit *hit) {
    if (is_flat(hit)) return 0;
    Vec3 across[2], here = cone_point(cone, hit->t);
    vec3_frame(cone->direction, &across[0], &across[1]);
    double off = fmax(BESIDE * cone_diameter(cone, hit->t), LEAST_BESIDE * hit->t), sum = 0;
    int met = 0;
    for (int k = 0; k < 2 && !(met && is_ball(hit)); k++) {
        Vec3 target = vec3_madd(here, across[k], off);
        Ray ray = {cone->origin, vec3_normalize(vec3_sub(target, cone->origin))};
        SurfaceHit beside;
        if (!hierarchy_meet_wide(hierarchy, purpose, &ray, cone_width(cone), 0, 2 * hit->t + off, false, &beside)) continue;
        if (beside.solid != hit->solid || beside.leaving != hit->leaving || vec3_dot(beside.normal, hit->normal) < 0.5) continue;
        Vec3 step = vec3_sub(vec3_madd(ray.origin, ray.direction, beside.t), here), turn = vec3_sub(beside.normal, hit->normal);
        double length = vec3_length_squared(step);
        if (!(length > 0) || length > 100 * off * off) continue;
        sum += vec3_dot(turn, step) / length;
        met++;
    }
    return met ? sum / met : 0;
}

Cone footprint_leave(const Cone *cone, double t, Vec3 origin, Vec3 direction, double curvature, double bend) {
    double width = cone_diameter(cone, t), spread = cone->spread + bend * curvature * width;
    Cone out = {origin, direction, width, fabs(spread)};
    /* A bundle that is gathered: it is narrow up to where its rays cross, and then opens as fast as it had closed. */
    if (spread < 0) out.width = 0;
    return out;
}
