/* Normals that are vector fields, not slopes of a value. Each fades as the footprint outgrows its waves. */
#include "pattern/bump.h"
#include "pattern/numbers.h"
#include "pattern/picture_map.h"
#include "pattern/warp.h"

#include "tape/noise.h"

static Vec3 bumps(const Spot *spot) { return vec3_scale(noise_pov_vector(spot->p), noise_kept(spot_size(spot), 0.4)); }

static Vec3 dents(const Normal *normal, const Spot *spot) {
    double noise = noise_generated(generator_of(normal->pattern), spot->p);
    return vec3_scale(noise_pov_vector(spot->p), noise * noise * noise * noise_kept(spot_size(spot), 0.8));
}

static Vec3 wrinkles(const Spot *spot) {
    Vec3 sum = {0, 0, 0};
    double frequency = 1, size = spot_size(spot);
    for (int k = 0; k < 10; k++) {
        Vec3 octave = noise_pov_vector(vec3_scale(spot->p, frequency));
        double kept = noise_kept(size * frequency, 0.4) / frequency;
        sum = vec3_madd(sum, vec3(fabs(octave.x), fabs(octave.y), fabs(octave.z)), kept);
        frequency *= 2;
    }
    return sum;
}

static Vec3 quilted(const Normal *normal, const Spot *spot) {
    Vec3 p = spot->p, d = vec3(p.x - floor(p.x) - 0.5, p.y - floor(p.y) - 0.5, p.z - floor(p.z) - 0.5);
    return vec3_scale(d, 1.154700538 * quilt_curve(normal->pattern, vec3_length(d)) * noise_kept(spot_size(spot), 2));
}

/* Each cell about a random point is a facet: of space, which turns the normal by that point's noise, or of the sphere of normals. */
static Vec3 facets(const Normal *normal, const Spot *spot, Vec3 n) {
    const Pigment *pattern = normal->pattern;
    double metric = pattern->crackle.metric, kept = noise_kept(spot_size(spot) / normal->facet_size, 2);
    n = vec3_normalize(n);
    if (!(normal->facet_coords > 0)) {
        Vec3 point = crackle_point(vec3_scale(n, 1 / normal->facet_size), metric);
        return vec3_sub(point, n);
    }
    Vec3 noise = noise_pov_vector(crackle_point(vec3_scale(spot->p, 1 / normal->facet_size), metric));
    return vec3_scale(vec3_madd(noise, n, -vec3_dot(noise, n)), kept * normal->facet_coords);
}

/* The normal of the triangle that three neighbours of the picture make, as high as they are bright; its height is along `n`. */
static Vec3 picture_bump(const Normal *normal, const Spot *spot, Vec3 n) {
    double h[3];
    if (!normal->pattern->image || !picture_map_heights(normal->pattern->image, spot, h)) return vec3(0, 0, 0);
    Vec3 a = vec3(1, normal->amount * (h[0] - h[1]), -1), b = vec3(2, normal->amount * (h[2] - h[1]), 0);
    Vec3 bent = vec3_normalize(vec3_cross(b, a));
    double length = vec3_length(n);
    n = vec3_normalize(n);
    Vec3 across = vec3_cross(n, vec3(0, 1, 0));
    if (vec3_length(across) < 1e-9) across = vec3(1, 0, 0);
    across = vec3_normalize(across);
    Vec3 along = vec3_normalize(vec3_cross(across, n));
    Vec3 out = vec3_madd(vec3_madd(vec3_scale(across, bent.x), n, bent.y), along, -bent.z);
    return vec3_scale(vec3_sub(out, n), length);
}

Vec3 bump_field(const Normal *normal, const Spot *spot, Vec3 n) {
    switch (normal->form) {
    case NORMAL_BUMPS: return bumps(spot);
    case NORMAL_DENTS: return dents(normal, spot);
    case NORMAL_WRINKLES: return wrinkles(spot);
    case NORMAL_QUILTED: return quilted(normal, spot);
    case NORMAL_RIPPLES:
    case NORMAL_WAVES: return water_bump(normal->pattern, spot, normal->form == NORMAL_WAVES);
    case NORMAL_FACETS: return facets(normal, spot, n);
    case NORMAL_PICTURE: return picture_bump(normal, spot, n);
    default: return vec3(0, 0, 0);
    }
}
