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
    if (wind->gust_amplitude == 0) return wind->gust_mean;
    double wave = (1 + sin(2 * VTS_PI * s / wind->gust_wavelength)) / 2;
    return wind->gust_mean + wind->gust_amplitude * (2 * pow(wave, wind->gust_sharpness) - 1);
}

static Vec3 function_force(const WindField *wind, Vec3 p, double time) {
    double in[4] = {p.x, p.y, p.z, time}, out[3];
    tape_eval_once(wind->function, in, out);
    Vec3 force = vec3(out[0], out[1], out[2]);
    return vec3_is_finite(force) ? force : vec3_splat(0);
}

static Vec3 flow(const WindField *wind, Vec3 p, double time) {
    Vec3 carried = vec3_scale(vec3_madd(p, wind->direction, -wind->speed * time), 1 / wind->turbulence_scale);
    return fbm3(carried, wind->turbulence_octaves, wind->turbulence_seed);
}

/* From 0 to 1 without a kink at either end. */
static double ease(double x) { return x * x * (3 - 2 * x); }

/* Two flows, as far apart as the wind goes in a cycle, know little of each other: divided by the root of their squared shares, their sum is
 * as strong as one. Where they are nearer to each other it would be stronger, by up to 1.4, which the shares' plain sum prevents. */
static Vec3 cyclic_flow(const WindField *wind, Vec3 p, double time) {
    double late = ease(time / wind->cycle), early = 1 - late;
    double apart = double_clamp(fabs(wind->speed) * wind->cycle / wind->turbulence_scale, 0, 1);
    double whole = 1 + apart * (sqrt(late * late + early * early) - 1);
    Vec3 sum = vec3_madd(vec3_scale(flow(wind, p, time), early), flow(wind, p, time - wind->cycle), late);
    return vec3_scale(sum, 1 / whole);
}

double wind_make_cyclic(WindField *wind, double cycle) {
    wind->cycle = cycle > 0 && isfinite(cycle) ? cycle : 0;
    double waves = fabs(wind->speed) * wind->cycle / wind->gust_wavelength;
    if (!(waves > 0 && isfinite(waves)) || wind->gust_amplitude == 0) return 0;
    waves = fmax(floor(waves + 0.5), 1);
    wind->speed = copysign(waves * wind->gust_wavelength / wind->cycle, wind->speed);
    return waves;
}

Vec3 wind_force(const WindField *wind, Vec3 p, double time) {
    Vec3 d = wind->direction;
    double now = wind->cycle > 0 ? time - wind->cycle * floor(time / wind->cycle) : time;
    Vec3 force = vec3_scale(d, 1 + gust(wind, vec3_dot(p, d) - wind->speed * now));
    if (wind->turbulence_amplitude != 0)
        force = vec3_madd(force, wind->cycle > 0 ? cyclic_flow(wind, p, now) : flow(wind, p, now), wind->turbulence_amplitude);
    force = vec3_scale(force, wind->strength);
    return wind->function ? vec3_add(force, function_force(wind, p, time)) : force;
}

/* A hundredth of a degree above the ground: in flatter layers single precision no longer tells one thing from the next. */
static const double MOST_PUSH = 1e4;

Vec3 wind_bend(Vec3 h, Vec3 force, double stiffness) {
    double length = vec3_length(h);
    Vec3 push = vec3_scale(force, 1 / stiffness);
    double largest = fmax(fabs(push.x), fmax(fabs(push.y), fabs(push.z)));
    Vec3 bent = vec3_madd(h, push, largest > MOST_PUSH ? length * (MOST_PUSH / largest) : length);
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

/* Of 2·((1 + sin x)/2)^sharpness − 1: Wallis' integral. Beyond 10⁸ the Gamma functions lose each other's digits. */
static double mean_gust(double sharpness) {
    double ratio = sharpness < 1e8 ? exp(lgamma(sharpness + 0.5) - lgamma(sharpness + 1)) : 1 / sqrt(sharpness);
    return 2 * ratio / sqrt(VTS_PI) - 1;
}

void wind_smooth(WindField *wind, double shortest) {
    double share = double_clamp(2 * wind->gust_wavelength / shortest - 1, 0, 1);
    wind->gust_mean += (1 - share) * wind->gust_amplitude * mean_gust(wind->gust_sharpness);
    wind->gust_amplitude *= share;
    while (wind->turbulence_octaves > 0 && ldexp(wind->turbulence_scale, 1 - wind->turbulence_octaves) < 0.75 * shortest) wind->turbulence_octaves--;
    if (wind->turbulence_octaves == 0) wind->turbulence_amplitude = 0;
}
