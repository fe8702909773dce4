#include "tape/interval.h"

#include "tape/tape_scalar.h"

/* ---- monotone functions ---- */

typedef double Function(double x);

/* Of a rising function, whose value at both bounds is within INTERVAL_ULPS; within [least, most], its exact range. */
static Interval rising(Interval a, Function *f, double least, double most) {
    if (interval_is_never(a)) return a;
    return (Interval){bound_max(least, widen_down(f(a.low))), bound_min(most, widen_up(f(a.high))), a.nan};
}

/* The part of a within [low, high]; what is outside has no value. */
static Interval within_domain(Interval a, double low, double high) {
    if (interval_is_never(a)) return a;
    bool outside = a.low < low || a.high > high;
    Interval part = {bound_max(a.low, low), bound_min(a.high, high), a.nan || outside};
    return interval_is_never(part) ? interval_never() : part;
}

Interval interval_SQRT(Interval a) { return rising(within_domain(a, 0, HUGE_VAL), scalar_SQRT, 0, HUGE_VAL); }
Interval interval_EXP(Interval a) { return rising(a, scalar_EXP, 0, HUGE_VAL); }
Interval interval_LN(Interval a) { return rising(within_domain(a, 0, HUGE_VAL), scalar_LN, -HUGE_VAL, HUGE_VAL); }
Interval interval_LOG(Interval a) { return rising(within_domain(a, 0, HUGE_VAL), scalar_LOG, -HUGE_VAL, HUGE_VAL); }
Interval interval_ASIN(Interval a) { return rising(within_domain(a, -1, 1), scalar_ASIN, -HUGE_VAL, HUGE_VAL); }
Interval interval_ATAN(Interval a) { return rising(a, scalar_ATAN, -HUGE_VAL, HUGE_VAL); }
Interval interval_SINH(Interval a) { return rising(a, scalar_SINH, -HUGE_VAL, HUGE_VAL); }
Interval interval_TANH(Interval a) { return rising(a, scalar_TANH, -1, 1); }
Interval interval_ASINH(Interval a) { return rising(a, scalar_ASINH, -HUGE_VAL, HUGE_VAL); }
Interval interval_ACOSH(Interval a) { return rising(within_domain(a, 1, HUGE_VAL), scalar_ACOSH, 0, HUGE_VAL); }
Interval interval_ATANH(Interval a) { return rising(within_domain(a, -1, 1), scalar_ATANH, -HUGE_VAL, HUGE_VAL); }
Interval interval_DEGREES(Interval a) { return rising(a, scalar_DEGREES, -HUGE_VAL, HUGE_VAL); }
Interval interval_RADIANS(Interval a) { return rising(a, scalar_RADIANS, -HUGE_VAL, HUGE_VAL); }
Interval interval_COSH(Interval a) { return rising(interval_ABS(a), scalar_COSH, 1, HUGE_VAL); }

static double minus_acos(double x) { return -scalar_ACOS(x); }
Interval interval_ACOS(Interval a) { return interval_NEG(rising(within_domain(a, -1, 1), minus_acos, -HUGE_VAL, 0)); }

/* ---- periodic functions ---- */

/* Beyond, a double's neighbours are too far apart for its turn to be known from products. */
static const double LARGEST_ANGLE = 0x1p30;

/* Whether a crest, where (x − crest)/period is whole, may lie in [low, high]: a little too often rather than never. */
static bool may_hold_crest(double low, double high, double crest, double period) {
    double slack = 1e-9;
    return floor((high - crest) / period + slack) >= ceil((low - crest) / period - slack);
}

static Interval wave(Interval a, Function *f, double crest) {
    if (interval_is_never(a)) return a;
    bool nan = a.nan || interval_has_infinity(a);
    if (!(fabs(a.low) < LARGEST_ANGLE && fabs(a.high) < LARGEST_ANGLE)) return (Interval){-1, 1, nan};
    double at_low = f(a.low), at_high = f(a.high);
    bool up = may_hold_crest(a.low, a.high, crest, 2 * VTS_PI), down = may_hold_crest(a.low, a.high, crest + VTS_PI, 2 * VTS_PI);
    return (Interval){down ? -1 : bound_max(-1, widen_down(bound_min(at_low, at_high))), up ? 1 : bound_min(1, widen_up(bound_max(at_low, at_high))), nan};
}

Interval interval_SIN(Interval a) { return wave(a, scalar_SIN, VTS_PI / 2); }
Interval interval_COS(Interval a) { return wave(a, scalar_COS, 0); }

Interval interval_TAN(Interval a) {
    if (interval_is_never(a)) return a;
    bool near = fabs(a.low) < LARGEST_ANGLE && fabs(a.high) < LARGEST_ANGLE;
    if (!near || may_hold_crest(a.low, a.high, VTS_PI / 2, VTS_PI)) return interval_all(a.nan || interval_has_infinity(a));
    return rising(a, scalar_TAN, -HUGE_VAL, HUGE_VAL);
}

/* ---- functions of two ---- */

/* atan2(y, x) rises or falls along each side of a box that does not touch the cut (x ≤ 0, y = 0). */
Interval interval_ATAN2(Interval y, Interval x) {
    if (interval_is_never(y) || interval_is_never(x)) return interval_never();
    bool nan = y.nan || x.nan;
    if (x.low <= 0 && interval_has_zero(y)) return (Interval){widen_down(-VTS_PI), widen_up(VTS_PI), nan};
    double a = scalar_ATAN2(y.low, x.low), b = scalar_ATAN2(y.low, x.high), c = scalar_ATAN2(y.high, x.low), d = scalar_ATAN2(y.high, x.high);
    return (Interval){widen_down(bound_min(bound_min(a, b), bound_min(c, d))), widen_up(bound_max(bound_max(a, b), bound_max(c, d))), nan};
}

static Interval power_corners(double a0, double a1, double b0, double b1) {
    double p = scalar_POW(a0, b0), q = scalar_POW(a0, b1), r = scalar_POW(a1, b0), s = scalar_POW(a1, b1);
    return (Interval){bound_max(0, widen_down(bound_min(bound_min(p, q), bound_min(r, s)))), widen_up(bound_max(bound_max(p, q), bound_max(r, s))), false};
}

/* For a base above 0 the power is monotone in base and exponent; below 0 it has a value for whole exponents only. A power of
 * exactly 0 or 1 is one whatever the other is, which lies between the corners. */
Interval interval_POW(Interval a, Interval b) {
    if (interval_is_never(a) && interval_is_never(b)) return interval_never();
    /* pow(1, NaN) and pow(NaN, 0) are 1 in C. */
    if (interval_is_never(a)) return interval_has_zero(b) ? (Interval){1, 1, true} : interval_never();
    if (interval_is_never(b)) return interval_holds(a, 1) ? (Interval){1, 1, true} : interval_never();
    bool nan = a.nan || b.nan;
    Interval out = {HUGE_VAL, -HUGE_VAL, false};
    if (nan) out = interval_point(1);
    if (a.high >= 0) out = interval_hull(out, power_corners(bound_max(a.low, 0), a.high, b.low, b.high));
    if (a.low < 0 || (a.low == 0 && b.low < 0)) { /* −0 to a negative odd power is −∞ */
        Interval size = power_corners(bound_max(-a.high, 0), -a.low, b.low, b.high);
        bool whole = interval_is_point(b) && b.low == floor(b.low), even = whole && (isinf(b.low) || fmod(b.low, 2) == 0);
        nan |= !whole && isfinite(b.low) && isfinite(b.high);
        nan |= !isfinite(b.low) || !isfinite(b.high);
        if (!even) out = interval_hull(out, interval_NEG(size));
        if (!whole || even) out = interval_hull(out, size);
    }
    out.nan = nan;
    return out;
}

/* fmod(a, b): as a where |a| < |b|; of a's sign, below |b|, not above |a|; rising in a between jumps. */
Interval interval_MOD(Interval a, Interval b) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || interval_has_infinity(a) || interval_has_zero(b);
    Interval size = interval_ABS(b);
    double most = bound_min(size.high, bound_max(fabs(a.low), fabs(a.high)));
    if (interval_is_point(b) && isfinite(a.low) && isfinite(a.high) && b.low != 0) {
        double low = fmod(a.low, b.low), high = fmod(a.high, b.low);
        /* No jump between: the remainders are as far apart as what they are of. */
        bool same_side = a.low >= 0 || a.high <= 0;
        if (same_side && a.high - a.low < size.high && low <= high && fabs((high - low) - (a.high - a.low)) <= 0.25 * size.high) return (Interval){low, high, nan};
    }
    if (bound_max(fabs(a.low), fabs(a.high)) < size.low) return (Interval){a.low, a.high, nan};
    return (Interval){a.low < 0 ? -most : 0, a.high > 0 ? most : 0, nan};
}

/* fmod() is exact, and a difference's rounding keeps its order: between folds the ends are the ends. */
Interval interval_FOLD(Interval a, Interval b) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || interval_has_infinity(a) || interval_has_zero(b) || interval_has_infinity(b);
    double period = interval_ABS(b).high, half = period / 2, length = round_up(a.high - a.low);
    Interval all = {0, half, nan};
    if (nan || !interval_is_point(b) || !(length < period)) return all;
    double rest = fmod(a.low, period), start = rest < 0 ? rest + period : rest, end = start + length, slack = 1e-9 * period;
    bool lowest = (start <= half + slack && end >= half - slack) || end >= half + period - slack, highest = start <= slack || end >= period - slack;
    double low = scalar_FOLD(a.low, period), high = scalar_FOLD(a.high, period);
    if (!lowest) all.low = bound_min(low, high);
    if (!highest) all.high = bound_max(low, high);
    return all;
}

/* ---- bits ---- */

static bool fits(Interval a) { return a.low > -0x1p63 && a.high < 0x1p63; }

static Interval bitwise(Interval a, Interval b, double (*op)(double a, double b)) {
    if (interval_is_never(a) || interval_is_never(b)) return interval_never();
    bool nan = a.nan || b.nan || !fits(a) || !fits(b);
    if (trunc(a.low) == trunc(a.high) && trunc(b.low) == trunc(b.high)) {
        Interval out = interval_point(op(a.low, b.low));
        out.nan |= nan;
        return out;
    }
    double bits = 1, most = bound_max(bound_max(fabs(a.low), fabs(a.high)), bound_max(fabs(b.low), fabs(b.high)));
    while (bits <= most && bits < 0x1p63) bits *= 2;
    return (Interval){a.low >= 0 && b.low >= 0 ? 0 : -bits, bits, nan};
}

Interval interval_BITWISE_AND(Interval a, Interval b) { return bitwise(a, b, scalar_BITWISE_AND); }
Interval interval_BITWISE_OR(Interval a, Interval b) { return bitwise(a, b, scalar_BITWISE_OR); }
Interval interval_BITWISE_XOR(Interval a, Interval b) { return bitwise(a, b, scalar_BITWISE_XOR); }
