/* Elementary functions that are the same, bit for bit, one at a time and in vectors: straight lines of additions,
 * multiplications, divisions and bit operations, without branches, tables or fused operations, so that compilers turn a loop
 * over them into vector instructions and every build gives the same digits.
 *
 * Each function has three forms:
 *
 *   …_core(x)    the straight line
 *   …_usual(x)   whether the straight line is right for x
 *   name(x)      the function: the core where that is right, else C's function of that name
 *
 * Errors are below 1 ulp (0.9 in the worst of millions of arguments; test_tape_elementary.c measures them against long
 * double); special values are those of C's Annex F. The polynomials
 * interpolate at Chebyshev's nodes; their relative errors are below 2^-57. */
#ifndef VTS_TAPE_ELEMENTARY_H
#define VTS_TAPE_ELEMENTARY_H

#include "base/common.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- bits ---- */

static inline uint64_t elementary_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double elementary_from_bits(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#define ELEMENTARY_SIGN 0x8000000000000000u
#define ELEMENTARY_ROUND                                                                                     \
    0x1.8p52 /* x + this has the nearest whole number in its lowest bits, for |x| < 2^51 */

/* mask: all ones or all zeros */
static inline double elementary_pick(uint64_t mask, double yes, double no) {
    return elementary_from_bits((elementary_bits(yes) & mask) | (elementary_bits(no) & ~mask));
}

/* Of ±0, whose sign a sum would lose; no comparison, which compilers would make a branch of. */
static inline uint64_t elementary_zero_mask(double x) {
    uint64_t bits = elementary_bits(x) << 1;
    return ((bits | (0 - bits)) >> 63) - 1;
}

static inline double elementary_with_sign(double magnitude, double sign) {
    return elementary_from_bits((elementary_bits(magnitude) & ~ELEMENTARY_SIGN) |
                                (elementary_bits(sign) & ELEMENTARY_SIGN));
}

/* ---- sums and products with their rounding errors: hi + lo is the exact value ---- */

typedef struct Double2 {
    double hi, lo;
} Double2;

/* Dekker's sum: |a| ≥ |b|, or a = 0. */
static inline Double2 double2_fast_sum(double a, double b) {
    double hi = a + b;
    return (Double2){hi, (a - hi) + b};
}

/* Knuth's sum: any a and b. */
static inline Double2 double2_sum(double a, double b) {
    double hi = a + b, part = hi - a;
    return (Double2){hi, (a - (hi - part)) + (b - part)};
}

static inline double double2_upper_half(double a) {
    return elementary_from_bits(elementary_bits(a) & ~(uint64_t)0x7FFFFFF);
}

/* Dekker's product, but for an error of 2^-105. */
static inline Double2 double2_product(double a, double b) {
    double hi = a * b, a1 = double2_upper_half(a), b1 = double2_upper_half(b), a2 = a - a1, b2 = b - b1;
    return (Double2){hi, ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2};
}

static inline Double2 double2_multiply(Double2 a, Double2 b) {
    Double2 p = double2_product(a.hi, b.hi);
    return (Double2){p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi)};
}

static inline Double2 double2_divide(Double2 a, Double2 b) {
    double inverse = 1 / b.hi, q = a.hi * inverse;
    Double2 p = double2_product(q, b.hi);
    return (Double2){q, (((a.hi - p.hi) - p.lo) + (a.lo - q * b.lo)) * inverse};
}

/* ---- sine, cosine, tangent ---- */

#define ELEMENTARY_ANGLE_LIMIT 0x1p13

typedef struct ReducedAngle {
    Double2 r;        /* in about [-pi/4, pi/4] */
    uint64_t quarter; /* x = quarter·pi/2 + r; only its two lowest bits count */
} ReducedAngle;

/* Cody and Waite: pi/2 in pieces of 40 bits, whose multiples are exact, and a rest. */
static inline ReducedAngle elementary_reduced(double x) {
    double shifted = x * 0x1.45f306dc9c883p-1 + ELEMENTARY_ROUND, n = shifted - ELEMENTARY_ROUND;
    Double2 r = double2_sum(x - n * 0x1.921fb54442p+0, -(n * 0x1.a308d31318p-41));
    return (ReducedAngle){double2_fast_sum(r.hi, r.lo - n * 0x1.8a2e03707344ap-81), elementary_bits(shifted)};
}

/* sin r = r.hi + this */
static inline double elementary_sine_rest(Double2 r) {
    double z = r.hi * r.hi, z2 = z * z;
    double p =
        (-0x1.5555555555555p-3 + z * 0x1.111111111111p-7) +
        z2 * ((-0x1.a01a01a019926p-13 + z * 0x1.71de3a545e7p-19) +
              z2 * ((-0x1.ae64540f0ba18p-26 + z * 0x1.61217c1864fa1p-33) + z2 * -0x1.ab161757f0c63p-41));
    return r.hi * z * p + (r.lo - 0.5 * z * r.lo);
}

/* cos r as a sum of two. */
static inline Double2 elementary_cosine(Double2 r) {
    double z = r.hi * r.hi, z2 = z * z;
    double p = (0x1.5555555555555p-5 + z * -0x1.6c16c16c1696p-10) +
               z2 * ((0x1.a01a019f4d0edp-16 + z * -0x1.27e4fa15bd814p-22) +
                     z2 * (0x1.1eeb66b683028p-29 + z * -0x1.907c0e63adbb6p-37));
    Double2 near = double2_fast_sum(1, -0.5 * z);
    return (Double2){near.hi, near.lo + (z2 * p - r.hi * r.lo)};
}

/* The sine of r and `quarter` quarter turns. */
static inline double elementary_turned_sine(Double2 r, uint64_t quarter) {
    Double2 c = elementary_cosine(r);
    double sine = r.hi + elementary_sine_rest(r), cosine = c.hi + c.lo;
    uint64_t odd = 0 - (quarter & 1), negative = (quarter & 2) << 62;
    return elementary_from_bits(elementary_bits(elementary_pick(odd, cosine, sine)) ^ negative);
}

static inline bool elementary_sin_usual(double x) { return fabs(x) < ELEMENTARY_ANGLE_LIMIT; }
static inline double elementary_sin_core(double x) {
    ReducedAngle a = elementary_reduced(x);
    return elementary_pick(elementary_zero_mask(x), x, elementary_turned_sine(a.r, a.quarter));
}

static inline bool elementary_cos_usual(double x) { return fabs(x) < ELEMENTARY_ANGLE_LIMIT; }
static inline double elementary_cos_core(double x) {
    ReducedAngle a = elementary_reduced(x);
    return elementary_turned_sine(a.r, a.quarter + 1);
}

static inline bool elementary_tan_usual(double x) { return fabs(x) < ELEMENTARY_ANGLE_LIMIT; }
static inline double elementary_tan_core(double x) {
    ReducedAngle a = elementary_reduced(x);
    Double2 s = double2_fast_sum(a.r.hi, elementary_sine_rest(a.r)), c = elementary_cosine(a.r);
    /* The cosine took the rounded square of r. */
    c = double2_fast_sum(c.hi, c.lo - 0.5 * double2_product(a.r.hi, a.r.hi).lo);
    uint64_t odd = 0 - (a.quarter & 1);
    Double2 above = {elementary_pick(odd, -c.hi, s.hi), elementary_pick(odd, -c.lo, s.lo)};
    Double2 below = {elementary_pick(odd, s.hi, c.hi), elementary_pick(odd, s.lo, c.lo)};
    Double2 q = double2_divide(above, below);
    return elementary_pick(elementary_zero_mask(x), x, q.hi + q.lo);
}

/* ---- exponential ---- */

#define ELEMENTARY_LN2_HI 0x1.62e42fefa3p-1 /* 41 bits: multiples by exponents are exact */
#define ELEMENTARY_LN2_LO 0x1.3de6af278ece6p-42

static inline bool elementary_exp_usual(double x) { return (void)x, true; }
static inline double elementary_exp_core(double x) {
    /* Beyond ±746 nothing changes any more; NaN stays. */
    double clamped = x > 746 ? 746 : x < -746 ? -746 : x;
    double shifted = clamped * 0x1.71547652b82fep+0 + ELEMENTARY_ROUND, n = shifted - ELEMENTARY_ROUND;
    Double2 r = double2_fast_sum(clamped - n * ELEMENTARY_LN2_HI, -(n * ELEMENTARY_LN2_LO));
    double t = r.hi, z = t * t, z2 = z * z;
    double low = (0x1p-1 + t * 0x1.5555555555557p-3) + z * (0x1.5555555555556p-5 + t * 0x1.11111111100bep-7);
    double middle = (0x1.6c16c16c162c3p-10 + t * 0x1.a01a01abf85abp-13) +
                    z * (0x1.a01a01a6e1e2ap-16 + t * 0x1.71de01fdbf9cap-19);
    double high = (0x1.27e4db46cddd1p-22 + t * 0x1.af4e554377204p-26) + z * 0x1.1f7340dbc337ep-29;
    double value = 1 + (t + (r.lo + z * (low + z2 * (middle + z2 * high))));
    /* 2^n in two halves, so that they are normal numbers and a result below those is rounded once. */
    uint64_t whole = elementary_bits(shifted) - elementary_bits(ELEMENTARY_ROUND) + 2046, half = whole >> 1;
    return value * elementary_from_bits(half << 52) * elementary_from_bits((whole - half) << 52);
}

/* ---- logarithm ---- */

typedef struct Decomposed {
    double exponent, mantissa; /* x = mantissa·2^exponent, mantissa in [sqrt(1/2), sqrt(2)) */
} Decomposed;

/* x: a normal positive number. */
static inline Decomposed elementary_decomposed(double x) {
    const uint64_t root_half = 0x3FE6A09E667F3BCDu, one = 0x3FF0000000000000u;
    uint64_t bits = elementary_bits(x) + (one - root_half), exponent = bits >> 52;
    double mantissa = elementary_from_bits((bits & 0x000FFFFFFFFFFFFFu) + root_half);
    return (Decomposed){elementary_from_bits(exponent | 0x4330000000000000u) - (0x1p52 + 1023), mantissa};
}

static inline bool elementary_ln_usual(double x) { return x >= DBL_MIN && x <= DBL_MAX; }
static inline double elementary_ln_core(double x) {
    Decomposed d = elementary_decomposed(x);
    /* With s = f/(2 + f), ln(1 + f) = 2s + 2s³/3 + … = f - (f²/2 - s·(f²/2 + …)). */
    double f = d.mantissa - 1, s = f / (2 + f), z = s * s, z2 = z * z, half = 0.5 * f * f;
    double series =
        z * ((0x1.5555555555558p-1 + z * 0x1.9999999995204p-2) +
             z2 * ((0x1.2492492e09d4dp-2 + z * 0x1.c71c62c639fdep-3) +
                   z2 * ((0x1.7462bd8f7796ep-3 + z * 0x1.39fd392179a95p-3) + z2 * 0x1.2b6688a387e03p-3)));
    double rest = s * (half + series) + d.exponent * ELEMENTARY_LN2_LO;
    return d.exponent * ELEMENTARY_LN2_HI - ((half - rest) - f);
}

/* ---- arc tangent ---- */

/* The angle of the point (x, y), not both 0, between the x axis and the point: atan2(). */
static inline double elementary_angle(double y, double x) {
    double across = fabs(x), up = fabs(y);
    double large = across > up ? across : up, small = across > up ? up : across;
    /* Beyond pi/8 the point is turned by pi/4: tan(a - pi/4) = (small - large)/(small + large). */
    bool turned = small > 0.41421356237309503 * large;
    Double2 minus = double2_sum(small, -large), plus = double2_sum(small, large);
    Double2 above = {turned ? minus.hi : small, turned ? minus.lo : 0};
    Double2 below = {turned ? plus.hi : large, turned ? plus.lo : 0};
    Double2 t = double2_divide(above, below);
    double z = t.hi * t.hi, z2 = z * z, z4 = z2 * z2;
    double p = ((-0x1.5555555555555p-2 + z * 0x1.9999999999349p-3) +
                z2 * (-0x1.2492492435f94p-3 + z * 0x1.c71c718525179p-4)) +
               z4 * (((-0x1.745d0b24c84b9p-4 + z * 0x1.3b1262ac559fcp-4) +
                      z2 * (-0x1.10fa72be60a88p-4 + z * 0x1.dfe5f37f19c8bp-5)) +
                     z4 * ((-0x1.a097da67e4438p-5 + z * 0x1.415dac51cd10bp-5) + z2 * -0x1.3a254249c2220p-6));
    double rest = t.lo + t.hi * z * p;
    /* The angle is a number of eighths of a turn, and t's angle added or taken away. */
    bool steep = up >= across, left = x < 0;
    double eighths = turned ? 1 : 0, sign = 1;
    eighths = steep ? 2 - eighths : eighths, sign = steep ? -sign : sign;
    eighths = left ? 4 - eighths : eighths, sign = left ? -sign : sign;
    Double2 sum = double2_fast_sum(eighths * 0x1.921fb54442d18p-1, sign * t.hi);
    double angle = sum.hi + (sum.lo + (sign * rest + eighths * 0x1.1a62633145c07p-55));
    return elementary_with_sign(angle, y);
}

static inline bool elementary_angle_usual(double a) { return fabs(a) >= 0x1p-400 && fabs(a) <= 0x1p400; }

static inline bool elementary_atan_usual(double x) { return elementary_angle_usual(x) || x == 0; }
static inline double elementary_atan_core(double x) { return elementary_angle(x, 1); }

static inline bool elementary_atan2_usual(double y, double x) {
    return elementary_angle_usual(x) && elementary_atan_usual(y);
}
static inline double elementary_atan2_core(double y, double x) { return elementary_angle(y, x); }

/* ---- the functions ---- */

#define ELEMENTARY_1(name, c_name)                                                                           \
    static inline double elementary_##name(double x) {                                                       \
        return elementary_##name##_usual(x) ? elementary_##name##_core(x) : c_name(x);                       \
    }
#define ELEMENTARY_2(name, c_name)                                                                           \
    static inline double elementary_##name(double x, double y) {                                             \
        return elementary_##name##_usual(x, y) ? elementary_##name##_core(x, y) : c_name(x, y);              \
    }
ELEMENTARY_1(sin, sin)
ELEMENTARY_1(cos, cos)
ELEMENTARY_1(tan, tan)
ELEMENTARY_1(exp, exp)
ELEMENTARY_1(ln, log)
ELEMENTARY_1(atan, atan)
ELEMENTARY_2(atan2, atan2)
#undef ELEMENTARY_1
#undef ELEMENTARY_2

#endif
