#include "pattern/warp.h"

#include "pattern/pattern.h"

#include "tape/noise.h"

/* Mean and deviation of 2·noise - 0.5 and of a component of the vector noise, measured over 4·10⁵ points. */
static const double scalar_mean = 0.512, scalar_deviation = 0.252;
static const double vector_mean = -0.019, vector_deviation = 0.257;
static const double sharpness = 0.4;

int generator_of(const Pigment *pigment) {
    return pigment->noise_generator ? pigment->noise_generator : NOISE_CORRECTED;
}

Octaves octaves_of(const Pigment *pigment) {
    return (Octaves){pigment->octaves, (float)pigment->lambda, (float)pigment->omega, generator_of(pigment)};
}

bool has_turbulence(const Pigment *pigment) { return vec3_length_squared(pigment->turbulence) > 0; }

/* The first noise of POV-Ray is taken as it is, the later ones are spread as it is. */
static double scalar_octave(int generator, Vec3 p, bool first) {
    double noise = noise_generated(generator, p);
    if (generator < NOISE_CORRECTED) return noise;
    return first ? double_clamp(2 * noise - 0.5, 0, 1) : 2 * noise - 0.5;
}

Spread turbulence(const Spot *spot, Octaves octaves) {
    double sum = 0, variance = 0, frequency = 1, amplitude = 1, size = spot_size(spot);
    for (int k = 0; k < int_max(octaves.count, 1); k++) {
        double kept = noise_kept(size * frequency, sharpness);
        double octave = scalar_octave(octaves.generator, vec3_scale(spot->p, frequency), k == 0);
        sum += amplitude * (kept < 1 ? scalar_mean + kept * (octave - scalar_mean) : octave);
        variance += amplitude * amplitude * variance_lost(scalar_deviation, kept);
        frequency *= (double)octaves.lambda;
        amplitude *= (double)octaves.omega;
    }
    return (Spread){sum, width_of_variance(variance), false};
}

Vec3 turbulence_vector(const Spot *spot, Octaves octaves, double *variance) {
    Vec3 sum = {0, 0, 0}, mean = vec3_splat(vector_mean);
    double frequency = 1, amplitude = 1, size = spot_size(spot);
    *variance = 0;
    for (int k = 0; k < int_max(octaves.count, 1); k++) {
        double kept = noise_kept(size * frequency, sharpness);
        Vec3 octave = noise_pov_vector(vec3_scale(spot->p, frequency));
        if (kept < 1) octave = vec3_lerp(mean, octave, kept);
        sum = vec3_madd(sum, octave, amplitude);
        *variance += amplitude * amplitude * variance_lost(vector_deviation, kept);
        frequency *= (double)octaves.lambda;
        amplitude *= (double)octaves.omega;
    }
    return sum;
}

Spot turbulence_warp(const Spot *spot, Vec3 amount, Octaves octaves) {
    Spot warped = *spot;
    double variance;
    Vec3 shift = turbulence_vector(spot, octaves, &variance);
    warped.p = vec3_add(spot->p, vec3_mul(shift, amount));
    double blur = width_of_variance(variance * vec3_length_squared(amount) / 3);
    warped.blur = sqrt(warped.blur * warped.blur + blur * blur);
    return warped;
}

/* How far the warp takes the ends of one axis of the footprint apart; across a seam the axis stays as long as it was. */
static Vec3 warped_axis(const Warp *warp, Vec3 p, Vec3 axis) {
    enum { TORN = 8 };
    Vec3 a = warp_place(warp, vec3_madd(p, axis, -0.5)), b = warp_place(warp, vec3_madd(p, axis, 0.5));
    Vec3 out = vec3_sub(b, a);
    double length = vec3_length(axis);
    return vec3_length(out) <= TORN * length ? out : vec3(length, 0, 0);
}

static Spot warp_spot(const Warp *warp, const Spot *spot) {
    if (warp->kind == WARP_TURBULENCE) {
        Octaves octaves = {warp->octaves, (float)warp->lambda, (float)warp->omega, NOISE_CORRECTED};
        return turbulence_warp(spot, warp->turbulence, octaves);
    }
    Spot warped = *spot;
    warped.p = warp_place(warp, spot->p);
    for (int k = 0; k < 3; k++)
        if (vec3_length_squared(spot->axes[k]) > 0)
            warped.axes[k] = warped_axis(warp, spot->p, spot->axes[k]);
    return warped;
}

/* POV-Ray's limit of coordinates. Patterns never see what is no number: that becomes the origin. */
static double kept(double x) { return isnan(x) ? 0 : double_clamp(x, -1e17, 1e17); }

static Spot spot_kept(Spot spot) {
    spot.p = vec3(kept(spot.p.x), kept(spot.p.y), kept(spot.p.z));
    return spot;
}

Spot spot_in_pattern(const Pigment *pigment, const Spot *outer, bool warps_itself) {
    if (pigment->kind == PATTERN_UV) return spot_in_uv(outer);
    Spot spot = spot_back(outer, &pigment->transform);
    for (size_t i = pigment->warp_count; i-- > 0;) {
        spot = warp_spot(&pigment->warps[i], &spot);
        spot = spot_back(&spot, &pigment->warps[i].inner);
    }
    if (!warps_itself && has_turbulence(pigment))
        spot = turbulence_warp(&spot, pigment->turbulence, octaves_of(pigment));
    return spot_kept(spot);
}

double pigment_turbulence(const Pigment *pigment, Vec3 point) {
    Spot spot = spot_make(vec3(kept(point.x), kept(point.y), kept(point.z)), vec3(0, 0, 0), 0);
    return turbulence(&spot, octaves_of(pigment)).value;
}
