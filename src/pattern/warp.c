#include "pattern/warp.h"

#include "tape/noise.h"

/* Mean and deviation of 2·noise - 0.5 and of a component of the vector noise, measured over 4·10⁵ points. */
static const double scalar_mean = 0.512, scalar_deviation = 0.252;
static const double vector_mean = -0.019, vector_deviation = 0.257;
static const double sharpness = 0.4;

Octaves octaves_of(const Pigment *pigment) {
    return (Octaves){pigment->octaves, (float)pigment->lambda, (float)pigment->omega};
}

bool has_turbulence(const Pigment *pigment) { return vec3_length_squared(pigment->turbulence) > 0; }

Spread turbulence(const Spot *spot, Octaves octaves) {
    double sum = 0, variance = 0, frequency = 1, amplitude = 1, size = spot_size(spot);
    for (int k = 0; k < int_max(octaves.count, 1); k++) {
        double kept = noise_kept(size * frequency, sharpness);
        double octave = 2 * noise_pov(vec3_scale(spot->p, frequency)) - 0.5;
        if (k == 0) octave = double_clamp(octave, 0, 1);
        sum += amplitude * (kept < 1 ? scalar_mean + kept * (octave - scalar_mean) : octave);
        variance += amplitude * amplitude * variance_lost(scalar_deviation, kept);
        frequency *= (double)octaves.lambda;
        amplitude *= (double)octaves.omega;
    }
    return (Spread){sum, width_of_variance(variance)};
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

Spot turbulence_warp(const Spot *spot, const Pigment *pigment) {
    Spot warped = *spot;
    double variance;
    Vec3 shift = turbulence_vector(spot, octaves_of(pigment), &variance);
    warped.p = vec3_add(spot->p, vec3_mul(shift, pigment->turbulence));
    double blur = width_of_variance(variance * vec3_length_squared(pigment->turbulence) / 3);
    warped.blur = sqrt(warped.blur * warped.blur + blur * blur);
    return warped;
}
