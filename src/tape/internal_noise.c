/* Noise and multifractals. The multifractals follow Musgrave, in: Ebert et al., Texturing and Modeling, with the parameters
 * in POV-Ray's order. */
#include "tape/internal_parts.h"
#include "tape/noise.h"

#include <math.h>

enum { MOST_OCTAVES = 10000, MOST_POWER = 1000, MOST_UNROLLED = 32 };

/* Truncated; what is no number or too large becomes the nearest bound. */
static int whole(double a, int most) { return a >= most ? most : a > 0 ? (int)a : 0; }

static int generator(double a) { return fabs(a) < 1e9 ? (int)a & 3 : NOISE_CORRECTED; }

double internal_noise_generator(const double *p) {
    return noise_generated(generator(p[3]), vec3(p[0], p[1], p[2]));
}

/* p[3] = H, lacunarity, octaves, offset, exponent of the signal, generator. */
double internal_hetero_mf(const double *p) {
    Vec3 at = vec3(p[0], p[1], p[2]);
    double fall = pow(p[4], -p[3]), weight = fall;
    int kind = generator(p[8]), power = whole(p[7], MOST_POWER), octaves = whole(ceil(p[5]), MOST_OCTAVES);
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

/* ---- the same as operations, for constant parameters ---- */

typedef struct Unroll {
    TapeBuilder *builder;
    Span span;
    int kind;
    double p[9]; /* from p[3] on */
    TapeRef at[3];
} Unroll;

static TapeRef number(const Unroll *u, double value) { return tape_constant(u->builder, value); }
static TapeRef add(const Unroll *u, TapeRef a, TapeRef b) { return tape_binary(u->builder, TAPE_ADD, a, b, u->span); }
static TapeRef times(const Unroll *u, TapeRef a, double k) { return tape_binary(u->builder, TAPE_MUL, a, number(u, k), u->span); }
static TapeRef shift(const Unroll *u, TapeRef a, double k) { return add(u, a, number(u, k)); }
static TapeRef size_of(const Unroll *u, TapeRef a) { return tape_unary(u->builder, TAPE_ABS, a, u->span); }

static TapeRef clamped(const Unroll *u, TapeRef a) {
    TapeRef above = tape_binary(u->builder, TAPE_MAX, number(u, 0), a, u->span);
    return tape_binary(u->builder, TAPE_MIN, number(u, 1), above, u->span);
}

/* Generator 1, and what is none, is the second before its range is corrected, moved otherwise; where it is not cut, the other is not. */
static TapeRef noise(const Unroll *u, double scale) {
    TapeRef p[3];
    for (int k = 0; k < 3; k++) p[k] = times(u, u->at[k], scale);
    TapeRef value = tape_ternary(u->builder, TAPE_POV_NOISE, p[0], p[1], p[2], u->span);
    return u->kind != NOISE_CORRECTED ? clamped(u, shift(u, times(u, value, 1 / 0.48985582), 0.5 - 1.05242)) : value;
}

/* The third generator's noise is no operation. */
static bool begin_unroll(Unroll *u, TapeBuilder *builder, const TapeRef *in, int inputs, Span span) {
    *u = (Unroll){.builder = builder, .span = span, .at = {in[0], in[1], in[2]}};
    for (int k = 3; k < inputs; k++)
        if (!tape_is_constant(builder, in[k], &u->p[k]) || !isfinite(u->p[k])) return false;
    u->kind = generator(u->p[inputs - 1]);
    return u->kind != NOISE_GRADIENT;
}

bool unroll_noise_generator(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out) {
    Unroll u;
    if (!begin_unroll(&u, builder, in, 4, span)) return false;
    return *out = noise(&u, 1), true;
}

bool unroll_hetero_mf(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out) {
    Unroll u;
    if (!begin_unroll(&u, builder, in, 9, span)) return false;
    const double *p = u.p;
    double fall = pow(p[4], -p[3]), weight = fall, frequency = p[4], part = p[5] - trunc(p[5]);
    int power = whole(p[7], MOST_POWER), octaves = whole(ceil(p[5]), MOST_OCTAVES);
    if (octaves * (power + 1) > MOST_UNROLLED * 2) return false;
    TapeRef signal = shift(&u, times(&u, noise(&u, 1), 2), p[6] - 1);
    for (int i = 1; i < octaves; i++, frequency *= p[4], weight *= fall) {
        TapeRef increment = times(&u, shift(&u, times(&u, noise(&u, frequency), 2), p[6] - 1), weight);
        for (int k = 0; k < power; k++) increment = tape_binary(builder, TAPE_MUL, increment, signal, span);
        signal = add(&u, signal, increment);
    }
    if (part != 0) {
        TapeRef last = times(&u, shift(&u, times(&u, noise(&u, frequency), 2), p[6] - 1), part * weight);
        signal = add(&u, signal, tape_binary(builder, TAPE_MUL, last, signal, span));
    }
    return *out = signal, true;
}

bool unroll_ridge(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out) {
    Unroll u;
    if (!begin_unroll(&u, builder, in, 9, span)) return false;
    const double *p = u.p;
    double ridge = p[7], offset = p[6], scale = 1 / double_max(ridge, 1 - ridge), part = p[4] - trunc(p[4]);
    double total = 1, frequency = 1, weight = 1;
    int octaves = whole(p[4], MOST_OCTAVES);
    if (octaves > MOST_UNROLLED) return false;
    octaves = octaves > 1 ? octaves : 1;
    TapeRef sum = number(&u, 0);
    for (int i = 0; i < octaves + (part != 0); i++, frequency *= p[3], weight *= p[5]) {
        double own = i == octaves ? weight * part : weight;
        TapeRef value = shift(&u, times(&u, size_of(&u, shift(&u, noise(&u, frequency), -ridge)), scale), -offset);
        sum = add(&u, sum, times(&u, value, own));
        if (i > 0) total += own;
    }
    return *out = times(&u, sum, 1 / (double_max(offset, 1 - offset) * total)), true;
}

bool unroll_ridged_mf(TapeBuilder *builder, const TapeRef *in, Span span, TapeRef *out) {
    Unroll u;
    if (!begin_unroll(&u, builder, in, 9, span)) return false;
    const double *p = u.p;
    int octaves = whole(ceil(p[5]), MOST_OCTAVES);
    double frequency = 1;
    TapeRef signal = 0, result = number(&u, 0);
    if (octaves > MOST_UNROLLED) return false;
    for (int i = 0; i == 0 || i < octaves; i++, frequency *= p[4]) {
        TapeRef centred = size_of(&u, shift(&u, times(&u, noise(&u, frequency), 2), -1));
        TapeRef ridges = tape_unary(builder, TAPE_SQR, tape_binary(builder, TAPE_SUB, number(&u, p[6]), centred, span), span);
        signal = i ? tape_binary(builder, TAPE_MUL, clamped(&u, times(&u, signal, p[7])), ridges, span) : ridges;
        result = add(&u, result, times(&u, signal, i ? pow(frequency, -p[3]) : 1));
    }
    return *out = result, true;
}
