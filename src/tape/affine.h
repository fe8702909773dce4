/* Reduced affine forms along a line (Gamito & Maddock 2007, section 3.2): what each operation of tape_ops.def does to
 *
 *     value = centre + slope·s + error·e,    s in [-1, 1] the same in all forms, e in [-1, 1] another in each.
 *
 * s is the place on the piece of the line that is looked at, so that a form is a linear function of that place with a bound for
 * what it misses: a first Taylor polynomial whose rest is private. All sums of errors are of absolute values (equations 7 and
 * 13 of the paper as printed let private errors cancel, which loses values). Smooth functions are expanded about the centre with
 * the range of their derivative as the rest, so that errors shrink with the square of the piece (`second order`).
 *
 * As with intervals, forms hold both the exact value and that of tape_scalar.h: each operation adds its rounding to the error.
 * `nan` says that the value may not be a number somewhere. An error of infinity: nothing is known. */
#ifndef VTS_TAPE_AFFINE_H
#define VTS_TAPE_AFFINE_H

#include "tape/interval.h"

typedef struct AffineForm {
    double centre, slope, error;
    bool nan;
} AffineForm;

static inline AffineForm affine_unknown(bool nan) { return (AffineForm){0, 0, HUGE_VAL, nan}; }
static inline AffineForm affine_point(double x) { return isfinite(x) ? (AffineForm){x, 0, 0, false} : affine_unknown(x != x); }

/* The distance from the centre, rounded up. */
static inline double affine_radius(AffineForm a) { return round_up(fabs(a.slope) + a.error); }
static inline double affine_size(AffineForm a) { return round_up(fabs(a.centre) + affine_radius(a)); }

static inline Interval affine_range(AffineForm a) {
    if (a.slope == 0 && a.error == 0) return (Interval){a.centre, a.centre, a.nan}; /* operations know more about constants */
    double radius = affine_radius(a);
    if (!(radius < HUGE_VAL)) return interval_all(a.nan);
    return (Interval){round_down(a.centre - radius), round_up(a.centre + radius), a.nan};
}

/* The form of an interval: all of it is error. */
AffineForm affine_of_interval(Interval a);
/* Of two bounds for the same value the better: the range if it is narrower than the form is off, which then says nothing more. */
AffineForm affine_within(AffineForm form, Interval range);

/* Roundings of an operation with results up to `size`: of centre, slope and error, and of the scalar operation itself. */
static inline AffineForm affine_rounded(double centre, double slope, double error, double size, bool nan) {
    double rounded = error + (size * 0x1p-50 + 4 * DBL_TRUE_MIN);
    if (!(isfinite(centre) && isfinite(slope) && rounded < HUGE_VAL)) return affine_unknown(nan);
    return (AffineForm){centre, slope, round_up(rounded), nan};
}

static inline AffineForm affine_ADD(AffineForm a, AffineForm b) {
    return affine_rounded(a.centre + b.centre, a.slope + b.slope, a.error + b.error, affine_size(a) + affine_size(b), a.nan || b.nan);
}
static inline AffineForm affine_NEG(AffineForm a) { return (AffineForm){-a.centre, -a.slope, a.error, a.nan}; }
static inline AffineForm affine_SUB(AffineForm a, AffineForm b) { return affine_ADD(a, affine_NEG(b)); }

/* s² is in [0, 1]: half of it goes to the centre. */
static inline AffineForm affine_MUL(AffineForm a, AffineForm b) {
    double both = a.slope * b.slope / 2, ra = affine_radius(a), rb = affine_radius(b);
    double error = fabs(both) + fabs(a.centre) * b.error + fabs(b.centre) * a.error + fabs(a.slope) * b.error + fabs(b.slope) * a.error +
                   a.error * b.error;
    if (!(ra < HUGE_VAL && rb < HUGE_VAL)) return affine_of_interval(interval_MUL(affine_range(a), affine_range(b)));
    return affine_rounded(a.centre * b.centre + both, a.centre * b.slope + b.centre * a.slope, error,
                          (fabs(a.centre) + ra) * (fabs(b.centre) + rb) * 2, a.nan || b.nan);
}

static inline AffineForm affine_SQR(AffineForm a) {
    double both = a.slope * a.slope / 2, r = affine_radius(a);
    if (!(r < HUGE_VAL)) return affine_of_interval(interval_SQR(affine_range(a)));
    /* Of the error, too, only the square counts: (e)² is in [0, 1]. */
    double private = a.error * a.error / 2, size = (fabs(a.centre) + r) * (fabs(a.centre) + r) * 2;
    return affine_rounded(a.centre * a.centre + both + private, 2 * a.centre * a.slope,
                          fabs(both) + private + 2 * (fabs(a.centre) + fabs(a.slope)) * a.error, size, a.nan);
}

AffineForm affine_DIV(AffineForm a, AffineForm b);
AffineForm affine_ABS(AffineForm a);
AffineForm affine_MIN(AffineForm a, AffineForm b);
AffineForm affine_MAX(AffineForm a, AffineForm b);
AffineForm affine_SELECT(AffineForm a, AffineForm b, AffineForm c);
AffineForm affine_MOD(AffineForm a, AffineForm b);
AffineForm affine_FOLD(AffineForm a, AffineForm b);
AffineForm affine_SQRT(AffineForm a);
AffineForm affine_EXP(AffineForm a);
AffineForm affine_LN(AffineForm a);
AffineForm affine_LOG(AffineForm a);
AffineForm affine_POW(AffineForm a, AffineForm b);
AffineForm affine_SIN(AffineForm a);
AffineForm affine_COS(AffineForm a);
AffineForm affine_TAN(AffineForm a);
AffineForm affine_ASIN(AffineForm a);
AffineForm affine_ACOS(AffineForm a);
AffineForm affine_ATAN(AffineForm a);
AffineForm affine_ATAN2(AffineForm a, AffineForm b);
AffineForm affine_SINH(AffineForm a);
AffineForm affine_COSH(AffineForm a);
AffineForm affine_TANH(AffineForm a);
AffineForm affine_ASINH(AffineForm a);
AffineForm affine_ACOSH(AffineForm a);
AffineForm affine_ATANH(AffineForm a);
AffineForm affine_PERLIN(AffineForm a, AffineForm b, AffineForm c);
AffineForm affine_POV_NOISE(AffineForm a, AffineForm b, AffineForm c);

static inline AffineForm affine_DEGREES(AffineForm a) { return affine_MUL(a, affine_point(180.0 / VTS_PI)); }
static inline AffineForm affine_RADIANS(AffineForm a) { return affine_MUL(a, affine_point(VTS_RADIANS)); }

/* Operations with jumps: only their range is known. */
#define AFFINE_BY_INTERVAL_1(name) \
    static inline AffineForm affine_##name(AffineForm a) { return affine_of_interval(interval_##name(affine_range(a))); }
#define AFFINE_BY_INTERVAL_2(name) \
    static inline AffineForm affine_##name(AffineForm a, AffineForm b) { return affine_of_interval(interval_##name(affine_range(a), affine_range(b))); }
AFFINE_BY_INTERVAL_1(FLOOR)
AFFINE_BY_INTERVAL_1(CEIL)
AFFINE_BY_INTERVAL_1(INT)
AFFINE_BY_INTERVAL_2(IDIV)
AFFINE_BY_INTERVAL_2(BITWISE_AND)
AFFINE_BY_INTERVAL_2(BITWISE_OR)
AFFINE_BY_INTERVAL_2(BITWISE_XOR)
AFFINE_BY_INTERVAL_2(LT)
AFFINE_BY_INTERVAL_2(LE)
AFFINE_BY_INTERVAL_2(GT)
AFFINE_BY_INTERVAL_2(GE)
AFFINE_BY_INTERVAL_2(EQ)
AFFINE_BY_INTERVAL_2(NE)
AFFINE_BY_INTERVAL_2(AND)
AFFINE_BY_INTERVAL_2(OR)
#undef AFFINE_BY_INTERVAL_2
#undef AFFINE_BY_INTERVAL_1

#endif
