#include "grow/wind.h"

#include "tape/noise.h"
#include "tape/tape.h"

static Vec3 fbm3(Vec3 p, int octaves, uint32_t seed) {
    Vec3 sum = vec3_splat(0);
    double frequency = 1;
    for (int k = 0; k < octaves; k++, frequency *= 2)
        sum = vec3_madd(sum, noise_perlin3(vec3_scale(p, frequency), seed + (uint32_t)k), 1 / frequency);
    return sum;
}

static double gust(const WindField *wind, double s) {
    if (wind->gust_amplitude == 0) return 0;
    double wave = (1 + sin(2 * VTS_PI * s / wind->gust_wavelength)) / 2;
    return wind->gust_amplitude * (2 * pow(wave, wind->gust_sharpness) - 1);
}

static Vec3 function_force(const WindField *wind, Vec3 p, double time) {
    double in[4] = {p.x, p.y, p.z, time}, out[3];
    tape_eval_once(wind->function, in, out);
    Vec3 force = vec3(out[0], out[1], out[2]);
    return vec3_is_finite(force) ? force : vec3_splat(0);
}

Vec3 wind_force(const WindField *wind, Vec3 p, double time) {
    Vec3 d = wind->direction;
    Vec3 force = vec3_scale(d, 1 + gust(wind, vec3_dot(p, d) - wind->speed * time));
    if (wind->turbulence_amplitude != 0) {
        Vec3 carried = vec3_scale(vec3_madd(p, d, -wind->speed * time), 1 / wind->turbulence_scale);
        force = vec3_madd(force, fbm3(carried, wind->turbulence_octaves, wind->turbulence_seed), wind->turbulence_amplitude);
    }
    force = vec3_scale(force, wind->strength);
    return wind->function ? vec3_add(force, function_force(wind, p, time)) : force;
}

Vec3 wind_bend(Vec3 h, Vec3 force, double stiffness) {
    double length = vec3_length(h);
    Vec3 bent = vec3_madd(h, force, length / stiffness);
    double bent_length = vec3_length(bent);
    return bent_length > 0 && isfinite(bent_length) ? vec3_scale(bent, length / bent_length) : h;
}

double wind_wavelength(const WindField *wind) {
    double shortest = HUGE_VAL;
    if (wind->strength == 0) return shortest;
    if (wind->gust_amplitude != 0) shortest = wind->gust_wavelength;
    if (wind->turbulence_amplitude != 0) shortest = fmin(shortest, ldexp(wind->turbulence_scale, 1 - wind->turbulence_octaves));
    return shortest;
}
