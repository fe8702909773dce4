#include "tape/affine.h"

#include "tape/derivative.h"
#include "tape/noise.h"
#include "tape/tape_scalar.h"

AffineForm affine_of_interval(Interval a) {
    if (interval_is_never(a)) return (AffineForm){0, 0, 0, true};
    if (!isfinite(a.low) || !isfinite(a.high)) return affine_unknown(a.nan);
    double centre = a.low / 2 + a.high / 2, reach = bound_max(a.high - centre, centre - a.low);
    /* Numbers stay numbers: the least error would leave a truth's sign open. */
    return (AffineForm){centre, 0, reach > 0 ? round_up(reach) : 0, a.nan};
}

AffineForm affine_within(AffineForm form, Interval range) {
    if (interval_is_never(range)) return (AffineForm){0, 0, 0, true};
    AffineForm out = range.high - range.low < 2 * form.error ? affine_of_interval(range) : form;
    out.nan = range.nan;
    return out;
}

/* ---- smooth functions of one: f(x) = f(m) + f'(ξ)·(x − m), the derivative's middle as slope, its spread as error ---- */

static AffineForm expanded(AffineForm a, double at_centre, Interval derivative, Interval range) {
    double low = derivative.low, high = derivative.high, radius = affine_radius(a);
    if (derivative.nan || !isfinite(low) || !isfinite(high) || !isfinite(at_centre) || !(radius < HUGE_VAL))
        return affine_within(affine_unknown(range.nan), range);
    double slope = low / 2 + high / 2, spread = round_up(round_up(high - low) / 2) + 0x1p-51 * fabs(slope);
    double error = fabs(slope) * a.error + spread * radius + INTERVAL_ULPS * 0x1p-52 * fabs(at_centre);
    double size = fabs(at_centre) + (fabs(slope) + spread) * radius;
    return affine_within(affine_rounded(at_centre, slope * a.slope, error, size, range.nan), range);
}

#define AFFINE_SMOOTH(name)                                                                                           \
    AffineForm affine_##name(AffineForm a) {                                                                                  \
        Interval x = affine_range(a), y = interval_##name(x);                                                         \
        return expanded(a, scalar_##name(a.centre), DERIVATIVE_##name(interval, interval_point, x, y), y); \
    }
AFFINE_SMOOTH(SQRT)
AFFINE_SMOOTH(EXP)
AFFINE_SMOOTH(LN)
AFFINE_SMOOTH(LOG)
AFFINE_SMOOTH(SIN)
AFFINE_SMOOTH(COS)
AFFINE_SMOOTH(TAN)
AFFINE_SMOOTH(ASIN)
AFFINE_SMOOTH(ACOS)
AFFINE_SMOOTH(ATAN)
AFFINE_SMOOTH(SINH)
AFFINE_SMOOTH(COSH)
AFFINE_SMOOTH(TANH)
AFFINE_SMOOTH(ASINH)
AFFINE_SMOOTH(ACOSH)
AFFINE_SMOOTH(ATANH)

static AffineForm reciprocal(AffineForm a) {
    Interval x = affine_range(a), y = interval_DIV(interval_point(1), x);
    return expanded(a, 1 / a.centre, interval_NEG(interval_SQR(y)), y);
}

AffineForm affine_DIV(AffineForm a, AffineForm b) {
    Interval range = interval_DIV(affine_range(a), affine_range(b));
    if (interval_has_zero(affine_range(b))) return affine_of_interval(range);
    return affine_within(affine_MUL(a, reciprocal(b)), range);
}

/* x to a constant power: p·x^(p − 1), the division keeping powers near 0 apart; else exp(b·ln a). */
AffineForm affine_POW(AffineForm a, AffineForm b) {
    Interval x = affine_range(a), range = interval_POW(x, affine_range(b));
    bool constant = b.slope == 0 && b.error == 0, whole = constant && b.centre == floor(b.centre);
    if (constant && (x.low > 0 || (whole && b.centre >= 1))) {
        Interval power = interval_POW(x, interval_SUB(interval_point(b.centre), interval_point(1)));
        power.nan = false; /* a whole power of a negative number is one; interval_SUB makes it a span */
        if (x.low <= 0) power = interval_POW(x, interval_point(b.centre - 1));
        bool exact = fabs(b.centre) < 0x1p50; /* b − 1 is a double */
        if (x.low <= 0 && !exact) return affine_of_interval(range);
        return expanded(a, scalar_POW(a.centre, b.centre), interval_MUL(interval_point(b.centre), power), range);
    }
    if (x.low > 0) return affine_within(affine_EXP(affine_MUL(b, affine_LN(a))), range);
    return affine_of_interval(range);
}

/* ∂/∂y = x/(x² + y²), ∂/∂x = −y/(x² + y²) */
AffineForm affine_ATAN2(AffineForm a, AffineForm b) {
    Interval y = affine_range(a), x = affine_range(b), range = interval_ATAN2(y, x);
    if (x.low <= 0 && interval_has_zero(y)) return affine_of_interval(range);
    Interval square = interval_ADD(interval_SQR(x), interval_SQR(y));
    AffineForm along_y = expanded((AffineForm){a.centre, a.slope, a.error, a.nan}, 0, interval_DIV(x, square), interval_all(range.nan));
    AffineForm along_x = expanded((AffineForm){b.centre, b.slope, b.error, b.nan}, 0, interval_DIV(interval_NEG(y), square), interval_all(range.nan));
    double centre = scalar_ATAN2(a.centre, b.centre);
    AffineForm at = {centre, 0, INTERVAL_ULPS * 0x1p-52 * fabs(centre), false};
    return affine_within(affine_ADD(at, affine_ADD(along_y, along_x)), range);
}

/* ---- kinks ---- */

/* |x| over [l, h] with l < 0 < h lies between its chord and the parallel to that through 0, which is 2·h·|l|/(h − l) lower. */
AffineForm affine_ABS(AffineForm a) {
    Interval x = affine_range(a);
    if (x.low >= 0) return a;
    if (x.high <= 0) return affine_NEG(a);
    if (!(affine_radius(a) < HUGE_VAL)) return affine_of_interval(interval_ABS(x));
    double slope = (x.high + x.low) / (x.high - x.low), chord = round_up(2 * x.high * (-x.low / (x.high - x.low)));
    AffineForm out = affine_rounded(slope * a.centre + chord / 2, slope * a.slope, fabs(slope) * a.error + chord / 2,
                                4 * (x.high - x.low), a.nan);
    return affine_within(out, interval_ABS(x));
}

/* Both, where each may be meant: the range of either. */
static AffineForm either(AffineForm a, AffineForm b) {
    return affine_of_interval(interval_hull(affine_range(a), affine_range(b)));
}

/* Where one may win here and the other there: (a + b)/2 ∓ |a − b|/2 keeps what both have in common. */
static AffineForm halved(AffineForm a, AffineForm b, bool larger) {
    AffineForm half = affine_point(0.5), sum = affine_ADD(a, b), gap = affine_ABS(affine_SUB(a, b));
    return affine_MUL(half, larger ? affine_ADD(sum, gap) : affine_SUB(sum, gap));
}

AffineForm affine_MIN(AffineForm a, AffineForm b) {
    Interval x = affine_range(a), y = affine_range(b), range = interval_MIN(x, y);
    if (a.nan || b.nan) return affine_of_interval(range);
    if (x.high < y.low) return a;
    if (x.low >= y.high) return b;
    return affine_within(halved(a, b, false), range);
}

AffineForm affine_MAX(AffineForm a, AffineForm b) {
    Interval x = affine_range(a), y = affine_range(b), range = interval_MAX(x, y);
    if (a.nan || b.nan) return affine_of_interval(range);
    if (x.low > y.high) return a;
    if (x.high <= y.low) return b;
    return affine_within(halved(a, b, true), range);
}

AffineForm affine_SELECT(AffineForm a, AffineForm b, AffineForm c) {
    Interval x = affine_range(a);
    if (x.high < 0 && !x.nan) return b;
    return x.low >= 0 ? c : either(b, c);
}

/* Without a jump between, fmod(a, b) is a less a constant. */
AffineForm affine_MOD(AffineForm a, AffineForm b) {
    Interval x = affine_range(a), y = affine_range(b), range = interval_MOD(x, y);
    if (!interval_is_point(y) || !(affine_radius(a) < HUGE_VAL) || range.nan) return affine_of_interval(range);
    double period = fabs(b.centre), shift = a.centre - fmod(a.centre, period);
    bool between = x.low >= 0 || x.high <= 0;
    between &= x.low >= shift - (shift <= 0 ? period : 0) && x.high <= shift + (shift >= 0 ? period : 0);
    if (!between || (shift > 0 && x.low < shift) || (shift < 0 && x.high > shift)) return affine_of_interval(range);
    return affine_within(affine_rounded(a.centre - shift, a.slope, a.error, affine_size(a), a.nan), range);
}

/* Round one of its folds it is the absolute value of the way to there. */
AffineForm affine_FOLD(AffineForm a, AffineForm b) {
    Interval y = affine_range(b), range = interval_FOLD(affine_range(a), y);
    double radius = affine_radius(a), period = fabs(b.centre), half = period / 2;
    if (!interval_is_point(y) || !(radius <= half) || range.nan) return affine_of_interval(range);
    double rest = fmod(a.centre, period), at = rest < 0 ? rest + period : rest, size = affine_size(a) + 4 * period;
    if (fabs(at - half) + radius <= half) return affine_within(affine_ABS(affine_rounded(at - half, a.slope, a.error, size, false)), range);
    double over = at < half ? at : at - period;
    if (fabs(over) + radius > half) return affine_of_interval(range);
    return affine_within(affine_SUB(affine_point(half), affine_ABS(affine_rounded(over, a.slope, a.error, size, false))), range);
}

/* ---- noises: the linear part about the centre, the curvature's bound for the rest (Taylor's theorem along the line from the
 * centre to any place that the three forms allow) ---- */

typedef double NoiseGradient(Vec3 p, double gradient[3]);

/* Beyond this way the curvature says less than the bound of the whole noise. The cell's own bounds (interval_PERLIN) would save
 * one evaluation in six, and take longer than the others together. */
static const double LONGEST_WAY = 0.6;

static AffineForm noise_expanded(NoiseGradient *noise, double curvature, const AffineForm p[3]) {
    double gradient[3], centre = noise(vec3(p[0].centre, p[1].centre, p[2].centre), gradient);
    double slope = 0, error = 0, way = 0, steepest = 0;
    for (int k = 0; k < 3; k++) {
        double radius = affine_radius(p[k]);
        slope += gradient[k] * p[k].slope;
        error += fabs(gradient[k]) * p[k].error;
        way += radius * radius;
        steepest += fabs(gradient[k]) * radius;
    }
    /* Numbers in a cell are below 8, and its places and curves are right to a few units of 2⁻⁵². */
    return affine_rounded(centre, slope, error + curvature / 2 * way, 32 + 4 * steepest, false);
}

static double way_of(const AffineForm p[3]) {
    double way = 0;
    for (int k = 0; k < 3; k++) way = bound_max(way, p[k].nan ? HUGE_VAL : affine_radius(p[k]));
    return way;
}

AffineForm affine_PERLIN(AffineForm a, AffineForm b, AffineForm c) {
    const AffineForm p[3] = {a, b, c};
    double way = way_of(p);
    AffineForm whole = {0, 0, NOISE_PERLIN_MOST, !(way < HUGE_VAL)};
    if (!(way < LONGEST_WAY)) return whole;
    AffineForm out = noise_expanded(noise_perlin_gradient, NOISE_PERLIN_CURVATURE, p);
    return out.error < whole.error ? out : whole;
}

AffineForm affine_POV_NOISE(AffineForm a, AffineForm b, AffineForm c) {
    const AffineForm p[3] = {a, b, c};
    double way = way_of(p);
    AffineForm whole = {0.5, 0, 0.5, !(way < HUGE_VAL)};
    if (!(way < LONGEST_WAY)) return whole;
    AffineForm out = noise_expanded(noise_pov_gradient3, NOISE_POV_CURVATURE, p);
    if (!(out.error < whole.error)) return whole;
    Interval span = affine_range(out);
    return span.low >= 0 && span.high <= 1 ? out : affine_within(affine_MAX(affine_point(0), affine_MIN(affine_point(1), out)), interval(0, 1));
}
