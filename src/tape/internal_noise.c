/* Noise and multifractals. The multifractals follow Musgrave, in: Ebert et al., Texturing and Modeling, with the parameters
 * in POV-Ray's order. */
#include "tape/internal.h"

enum { MOST_OCTAVES = 10000 };

/* Truncated; what is no number or too large becomes the nearest bound. */
static int whole(double a, int most) { return a >= most ? most : a > 0 ? (int)a : 0; }

static int generator(double a) { return fabs(a) < 1e9 ? (int)a & 3 : NOISE_CORRECTED; }

double internal_noise3d(const double *p) { return noise_pov(vec3(p[0], p[1], p[2])); }

double internal_noise_generator(const double *p) {
    return noise_generated(generator(p[3]), vec3(p[0], p[1], p[2]));
}

/* p[3] = H, lacunarity, octaves, offset, exponent of the signal, generator. */
double internal_hetero_mf(const double *p) {
    Vec3 at = vec3(p[0], p[1], p[2]);
    double fall = pow(p[4], -p[3]), weight = fall;
    int kind = generator(p[8]), power = whole(p[7], 1000), octaves = whole(ceil(p[5]), MOST_OCTAVES);
    double signal = 2 * noise_generated(kind, at) - 1 + p[6], part = p[5] - trunc(p[5]);
    at = vec3_scale(at, p[4]);
    for (int i = 1; i < octaves; i++, at = vec3_scale(at, p[4]), weight *= fall) {
        double increment = (2 * noise_generated(kind, at) - 1 + p[6]) * weight;
        for (int k = 0; k < power; k++) increment *= signal;
        signal += increment;
    }
    if (part != 0) signal += part * (2 * noise_generated(kind, at) - 1 + p[6]) * weight * signal;
    return signal;
}

/* p[3] = lambda, octaves, omega, offset, ridge, generator. */
double internal_ridge(const double *p) {
    Vec3 at = vec3(p[0], p[1], p[2]);
    double ridge = p[7], offset = p[6], scale = 1 / double_max(ridge, 1 - ridge);
    int kind = generator(p[8]), octaves = whole(p[4], MOST_OCTAVES);
    double sum = fabs(noise_generated(kind, at) - ridge) * scale - offset, total = 1,
           part = p[4] - trunc(p[4]);
    double frequency = p[3], weight = p[5];
    for (int i = 2; i <= octaves; i++, frequency *= p[3], weight *= p[5]) {
        sum += weight * (fabs(noise_generated(kind, vec3_scale(at, frequency)) - ridge) * scale - offset);
        total += weight;
    }
    if (part != 0) {
        double value = fabs(noise_generated(kind, vec3_scale(at, frequency)) - ridge) * scale - offset;
        sum += weight * part * value;
        total += weight * part;
    }
    return sum / (double_max(offset, 1 - offset) * total);
}

static double ridge_signal(int kind, Vec3 at, double offset) {
    double signal = offset - fabs(2 * noise_generated(kind, at) - 1);
    return signal * signal;
}

/* p[3] = H, lacunarity, octaves, offset, gain, generator. */
double internal_ridged_mf(const double *p) {
    Vec3 at = vec3(p[0], p[1], p[2]);
    int kind = generator(p[8]), octaves = whole(ceil(p[5]), MOST_OCTAVES);
    double signal = ridge_signal(kind, at, p[6]), result = signal, frequency = p[4];
    for (int i = 1; i < octaves; i++, frequency *= p[4]) {
        at = vec3_scale(at, p[4]);
        double weight = double_clamp(signal * p[7], 0, 1);
        signal = weight * ridge_signal(kind, at, p[6]);
        result += signal * pow(frequency, -p[3]);
    }
    return result;
}
