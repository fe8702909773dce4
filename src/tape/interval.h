/* Intervals: what each operation of tape_ops.def does to sets of doubles.
 *
 * An interval stands for all numbers of [low, high], infinities included; `nan` says that the value may not be a number at
 * some place. low > high: it is never a number. Every function returns an interval that holds what the operation gives, both
 * in exact arithmetic and in that of tape_scalar.h, for all choices of operands from theirs: bounds are rounded outwards
 * where the machine's operation rounds, and widened by INTERVAL_ULPS units in the last place where it is not correctly rounded.
 * Moore, Kearfott & Cloud, Introduction to Interval Analysis, 2009; IEEE 1788-2015 for what infinities do. */
#ifndef VTS_TAPE_INTERVAL_H
#define VTS_TAPE_INTERVAL_H

#include "base/common.h"

#include <float.h>
#include <math.h>

typedef struct Interval {
    double low, high;
    bool nan;
} Interval;

/* Elementary functions, ours and C's, are within one unit in the last place (C's: two); see elementary.h. */
#define INTERVAL_ULPS 4

/* Of two numbers; C's fmin() and fmax() are calls, since they look for what is none. */
static inline double bound_min(double a, double b) { return a < b ? a : b; }
static inline double bound_max(double a, double b) { return a > b ? a : b; }

static inline Interval interval(double low, double high) { return (Interval){low, high, false}; }
static inline Interval interval_point(double x) { return x == x ? interval(x, x) : (Interval){HUGE_VAL, -HUGE_VAL, true}; }
static inline Interval interval_all(bool nan) { return (Interval){-HUGE_VAL, HUGE_VAL, nan}; }
static inline Interval interval_never(void) { return (Interval){HUGE_VAL, -HUGE_VAL, true}; }
static inline bool interval_is_never(Interval a) { return !(a.low <= a.high); }
static inline bool interval_is_point(Interval a) { return a.low == a.high && !a.nan; }
static inline bool interval_holds(Interval a, double x) { return x == x ? a.low <= x && x <= a.high : a.nan; }
static inline Interval interval_hull(Interval a, Interval b) {
    return (Interval){bound_min(a.low, b.low), bound_max(a.high, b.high), a.nan || b.nan};
}

/* The next double or the one after it, in few operations: |x|·2⁻⁵² is one or two units, the least double is for zeros. An
 * infinity that stands where a bound may be finite (a sum that overflowed) becomes the largest double. */
static inline double round_down(double x) { return x == HUGE_VAL ? DBL_MAX : x - (fabs(x) * 0x1p-52 + DBL_TRUE_MIN); }
static inline double round_up(double x) { return x == -HUGE_VAL ? -DBL_MAX : x + (fabs(x) * 0x1p-52 + DBL_TRUE_MIN); }
static inline double widen_down(double x) { return x == HUGE_VAL ? DBL_MAX : x - (INTERVAL_ULPS * 0x1p-52 * fabs(x) + INTERVAL_ULPS * DBL_TRUE_MIN); }
static inline double widen_up(double x) { return x == -HUGE_VAL ? -DBL_MAX : x + (INTERVAL_ULPS * 0x1p-52 * fabs(x) + INTERVAL_ULPS * DBL_TRUE_MIN); }

/* Products and quotients of bounds, where 0·∞ is 0: a bound of 0 is exact, one of ∞ is never reached by finite numbers; what
 * infinite operands themselves give is in `nan`. */
static inline double bound_product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

/* The hull of four bounds of a rounded operation. */
static inline Interval interval_corners(double a, double b, double c, double d, bool nan) {
    return (Interval){round_down(bound_min(bound_min(a, b), bound_min(c, d))), round_up(bound_max(bound_max(a, b), bound_max(c, d))), nan};
}

static inline bool interval_has_zero(Interval a) { return a.low <= 0 && a.high >= 0; }
static inline bool interval_has_infinity(Interval a) { return a.low == -HUGE_VAL || a.high == HUGE_VAL; }

/* ---- arithmetic ---- */

/* The same for sums, which are exact where 2⁻⁵² of them is below the least double: nothing need be added there, and sums of numbers that are not
 * negative stay so, as square roots of them need. */
static inline double sum_down(double x) { return x == HUGE_VAL ? DBL_MAX : x - fabs(x) * 0x1p-52; }
static inline double sum_up(double x) { return x == -HUGE_VAL ? -DBL_MAX : x + fabs(x) * 0x1p-52; }

static inline Interval interval_ADD(Interval a, Interval b) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || (a.low == -HUGE_VAL && b.high == HUGE_VAL) || (a.high == HUGE_VAL && b.low == -HUGE_VAL);
    double low = a.low + b.low, high = a.high + b.high; /* ∞ − ∞: nothing is known */
    return (Interval){low == low ? sum_down(low) : -HUGE_VAL, high == high ? sum_up(high) : HUGE_VAL, nan};
}

static inline Interval interval_NEG(Interval a) { return (Interval){-a.high, -a.low, a.nan}; }
static inline Interval interval_SUB(Interval a, Interval b) { return interval_ADD(a, interval_NEG(b)); }

static inline Interval interval_MUL(Interval a, Interval b) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || (interval_has_zero(a) && interval_has_infinity(b)) || (interval_has_zero(b) && interval_has_infinity(a));
    return interval_corners(bound_product(a.low, b.low), bound_product(a.low, b.high), bound_product(a.high, b.low),
                            bound_product(a.high, b.high), nan);
}

static inline double bound_quotient(double a, double b) { return a == 0 || isinf(b) ? 0 : a / b; }

/* Zeros of the divisor have signs: all quotients of either sign are possible there. */
static inline Interval interval_DIV(Interval a, Interval b) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || (interval_has_zero(a) && interval_has_zero(b)) || (interval_has_infinity(a) && interval_has_infinity(b));
    if (interval_has_zero(b)) return interval_all(nan);
    Interval q = interval_corners(bound_quotient(a.low, b.low), bound_quotient(a.low, b.high), bound_quotient(a.high, b.low),
                                  bound_quotient(a.high, b.high), nan);
    /* An infinite dividend over a finite divisor stays infinite, whatever the other bound of the divisor is. */
    if (a.high == HUGE_VAL) q = b.low > 0 ? (Interval){q.low, HUGE_VAL, nan} : (Interval){-HUGE_VAL, q.high, nan};
    if (a.low == -HUGE_VAL) q = b.low > 0 ? (Interval){-HUGE_VAL, q.high, nan} : (Interval){q.low, HUGE_VAL, nan};
    return q;
}

static inline Interval interval_ABS(Interval a) {
    if (interval_is_never(a) || a.low >= 0) return a;
    if (a.high <= 0) return interval_NEG(a);
    return (Interval){0, bound_max(-a.low, a.high), a.nan};
}

static inline Interval interval_SQR(Interval a) {
    Interval m = interval_ABS(a);
    if (interval_is_never(m)) return m;
    return (Interval){m.low == 0 ? 0 : bound_max(0, round_down(m.low * m.low)), round_up(m.high * m.high), m.nan};
}

/* a < b ? a : b is b where either is no number. */
static inline Interval interval_MIN(Interval a, Interval b) {
    if (interval_is_never(b)) return b;
    if (interval_is_never(a)) return b;
    return (Interval){bound_min(a.low, b.low), a.nan ? b.high : bound_min(a.high, b.high), b.nan};
}

static inline Interval interval_MAX(Interval a, Interval b) {
    if (interval_is_never(b)) return b;
    if (interval_is_never(a)) return b;
    return (Interval){a.nan ? b.low : bound_max(a.low, b.low), bound_max(a.high, b.high), b.nan};
}

/* ---- truths: 1 or 0; comparisons with what is no number are false, but for != ---- */

static inline Interval interval_truth(bool may_be_false, bool may_be_true) { return interval(may_be_false ? 0 : 1, may_be_true ? 1 : 0); }

static inline Interval interval_LT(Interval a, Interval b) {
    bool number = !interval_is_never(a) && !interval_is_never(b);
    return interval_truth(a.nan || b.nan || !number || a.high >= b.low, number && a.low < b.high);
}
static inline Interval interval_LE(Interval a, Interval b) {
    bool number = !interval_is_never(a) && !interval_is_never(b);
    return interval_truth(a.nan || b.nan || !number || a.high > b.low, number && a.low <= b.high);
}
static inline Interval interval_GT(Interval a, Interval b) { return interval_LT(b, a); }
static inline Interval interval_GE(Interval a, Interval b) { return interval_LE(b, a); }

static inline Interval interval_EQ(Interval a, Interval b) {
    bool number = !interval_is_never(a) && !interval_is_never(b), same = number && a.low == a.high && b.low == b.high && a.low == b.low;
    return interval_truth(a.nan || b.nan || !same, number && a.low <= b.high && b.low <= a.high);
}
static inline Interval interval_NE(Interval a, Interval b) {
    Interval same = interval_EQ(a, b);
    return interval_truth(same.high != 0, same.low == 0);
}

static inline bool interval_may_be_true(Interval a) { return a.nan || (!interval_is_never(a) && (a.low != 0 || a.high != 0)); }
static inline bool interval_may_be_false(Interval a) { return !interval_is_never(a) && interval_has_zero(a); }
static inline Interval interval_AND(Interval a, Interval b) {
    return interval_truth(interval_may_be_false(a) || interval_may_be_false(b), interval_may_be_true(a) && interval_may_be_true(b));
}
static inline Interval interval_OR(Interval a, Interval b) {
    return interval_truth(interval_may_be_false(a) && interval_may_be_false(b), interval_may_be_true(a) || interval_may_be_true(b));
}

/* a < 0 ? b : c */
static inline Interval interval_SELECT(Interval a, Interval b, Interval c) {
    bool below = !interval_is_never(a) && a.low < 0, not_below = a.nan || interval_is_never(a) || a.high >= 0;
    if (below && not_below) return interval_hull(b, c);
    return below ? b : c;
}

/* ---- rounding: monotone and exact ---- */

static inline Interval interval_FLOOR(Interval a) { return (Interval){floor(a.low), floor(a.high), a.nan}; }
static inline Interval interval_CEIL(Interval a) { return (Interval){ceil(a.low), ceil(a.high), a.nan}; }
static inline Interval interval_INT(Interval a) { return (Interval){trunc(a.low), trunc(a.high), a.nan}; }
static inline Interval interval_IDIV(Interval a, Interval b) { return interval_INT(interval_DIV(a, b)); }

/* Of the larger operations: tape_interval.c. */
Interval interval_MOD(Interval a, Interval b);
Interval interval_FOLD(Interval a, Interval b);
Interval interval_BITWISE_AND(Interval a, Interval b);
Interval interval_BITWISE_OR(Interval a, Interval b);
Interval interval_BITWISE_XOR(Interval a, Interval b);
Interval interval_SQRT(Interval a);
Interval interval_EXP(Interval a);
Interval interval_LN(Interval a);
Interval interval_LOG(Interval a);
Interval interval_POW(Interval a, Interval b);
Interval interval_SIN(Interval a);
Interval interval_COS(Interval a);
Interval interval_TAN(Interval a);
Interval interval_ASIN(Interval a);
Interval interval_ACOS(Interval a);
Interval interval_ATAN(Interval a);
Interval interval_ATAN2(Interval a, Interval b);
Interval interval_SINH(Interval a);
Interval interval_COSH(Interval a);
Interval interval_TANH(Interval a);
Interval interval_ASINH(Interval a);
Interval interval_ACOSH(Interval a);
Interval interval_ATANH(Interval a);
Interval interval_DEGREES(Interval a);
Interval interval_RADIANS(Interval a);
/* Of noises over a box: noise_interval.c. */
Interval interval_PERLIN(Interval a, Interval b, Interval c);
Interval interval_POV_NOISE(Interval a, Interval b, Interval c);

#endif
