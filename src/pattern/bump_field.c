/* Normals that are vector fields, not slopes of a value. Each fades as the footprint outgrows its waves. */
#include "pattern/bump.h"
#include "pattern/numbers.h"
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
    return vec3_scale(d, quilt_curve(normal->pattern, vec3_length(d)) * noise_kept(spot_size(spot), 2));
}

Vec3 bump_field(const Normal *normal, const Spot *spot, Vec3 n) {
    (void)n;
    switch (normal->form) {
    case NORMAL_BUMPS: return bumps(spot);
    case NORMAL_DENTS: return dents(normal, spot);
    case NORMAL_WRINKLES: return wrinkles(spot);
    case NORMAL_QUILTED: return quilted(normal, spot);
    case NORMAL_RIPPLES:
    case NORMAL_WAVES: return water_bump(normal->pattern, spot, normal->form == NORMAL_WAVES);
    default: return vec3(0, 0, 0);
    }
}
