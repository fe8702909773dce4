/* Waves, exponentials and kinks over lanes (affine_lanes.h). */
#ifndef VTS_TAPE_AFFINE_LANES_CURVES_H
#define VTS_TAPE_AFFINE_LANES_CURVES_H

#include "tape/affine_lanes.h"
#include "tape/elementary.h"

/* What |centre - c| may be, with what its sum with c rounds. */
static inline double affine_lane_radius(double slope, double error) { return (fabs(slope) + error) * (1 + 0x1p-50); }

/* Whether sine and cosine of all centres are straight lines of operations. */
static inline bool affine_small_angles(const AffineLanes *a) {
    uint64_t large = 0;
    AFFINE_EACH_LANE large |= elementary_sin_usual(a->centre[l]) ? 0 : 1;
    return !large;
}

/* sin(c + d) = sin c + cos c·d - sin c·d²/2 + R, |R| ≤ |d|³/6, for angles that affine_small_angles() has seen; the cosine by its own
 * derivatives. d² is within [0, r²]. */
static inline void affine_wave_lanes(AffineLanes *restrict out, const AffineLanes *restrict a, bool cosine) {
    double sine[AFFINE_LANES], other[AFFINE_LANES];
    AFFINE_EACH_LANE sine[l] = elementary_sin_core(a->centre[l]);
    AFFINE_EACH_LANE other[l] = elementary_cos_core(a->centre[l]);
    AFFINE_EACH_LANE {
        double value = cosine ? other[l] : sine[l], first = cosine ? -sine[l] : other[l];
        double s = a->slope[l], e = a->error[l], r = affine_lane_radius(s, e), square = r * r, bend = value * square / 4;
        double error = affine_lane_error(fabs(first) * e + fabs(bend) + square * r / 6, 16 + 4 * r);
        bool tells = error < 1;
        out->centre[l] = tells ? value - bend : 0, out->slope[l] = tells ? first * s : 0;
        out->error[l] = (tells ? error : 1 + 0x1p-50) + 0 * e; /* no number where nothing is known */
    }
}

/* e^(c + d) = e^c·(1 + d + d²/2) + R, |R| ≤ |d|³/6·e^(c + r); or the range, where that is narrower. */
static inline void affine_exp_lanes(AffineLanes *restrict out, const AffineLanes *restrict a) {
    double middle[AFFINE_LANES], low[AFFINE_LANES], high[AFFINE_LANES];
    AFFINE_EACH_LANE middle[l] = elementary_exp_core(a->centre[l]);
    AFFINE_EACH_LANE low[l] = elementary_exp_core(a->centre[l] - affine_lane_radius(a->slope[l], a->error[l]));
    AFFINE_EACH_LANE high[l] = elementary_exp_core(a->centre[l] + affine_lane_radius(a->slope[l], a->error[l]));
    AFFINE_EACH_LANE {
        double s = a->slope[l], e = a->error[l], r = affine_lane_radius(s, e), square = r * r;
        /* An end c ± r is off by half a unit of its own. */
        double size = 16 * high[l] * (1 + fabs(a->centre[l]) + r), bend = middle[l] * square / 4, half = (high[l] - low[l]) / 2;
        double error = middle[l] * e + bend + square * r / 6 * high[l];
        bool tells = error < half;
        out->centre[l] = tells ? middle[l] + bend : low[l] / 2 + high[l] / 2, out->slope[l] = tells ? middle[l] * s : 0;
        out->error[l] = affine_lane_error(tells ? error : half, size) + 0 * e;
    }
}

/* |x| ≤ k·x + chord, and ≥ k·x: over [l, h] with l < 0 < h the chord, and its parallel through 0. */
typedef struct AffineKink {
    double k, chord;
} AffineKink;

static inline AffineKink affine_kink(double centre, double radius) {
    double low = centre - radius, high = centre + radius, slope = (high + low) / (high - low), chord = 2 * high * (-low / (high - low));
    bool above = low >= 0, below = high <= 0;
    return (AffineKink){above ? 1 : below ? -1 : slope, above || below ? 0 : chord};
}

static inline void affine_abs_lanes(AffineLanes *restrict out, const AffineLanes *restrict a) {
    AFFINE_EACH_LANE {
        double c = a->centre[l], s = a->slope[l], e = a->error[l], r = affine_lane_radius(s, e);
        AffineKink kink = affine_kink(c, r);
        out->centre[l] = kink.k * c + kink.chord / 2, out->slope[l] = kink.k * s;
        out->error[l] = affine_lane_error(fabs(kink.k) * e + kink.chord / 2, 8 * (fabs(c) + r));
    }
}

/* (a + b ∓ |a - b|)/2, whose parts of a and b are between 0 and 1. */
static inline void affine_lesser_lanes(AffineLanes *restrict out, const AffineLanes *restrict a, const AffineLanes *restrict b, bool greater) {
    AFFINE_EACH_LANE {
        double ac = a->centre[l], as = a->slope[l], ae = a->error[l], bc = b->centre[l], bs = b->slope[l], be = b->error[l];
        double size = 8 * (fabs(ac) + fabs(bc) + (fabs(as) + fabs(bs)) + (ae + be));
        AffineKink kink = affine_kink(ac - bc, affine_lane_radius(as - bs, ae + be) + size * 0x1p-53);
        double of_a = (greater ? 1 + kink.k : 1 - kink.k) / 2, of_b = (greater ? 1 - kink.k : 1 + kink.k) / 2, part = kink.chord / 4;
        out->centre[l] = of_a * ac + of_b * bc + (greater ? part : -part), out->slope[l] = of_a * as + of_b * bs;
        out->error[l] = affine_lane_error(of_a * ae + of_b * be + part, size);
    }
}

/* Round one of its folds it is the absolute value of the way to there; period: not 0. */
static inline void affine_fold_lanes(AffineLanes *restrict out, const AffineLanes *restrict a, double period) {
    const double half = fabs(period) / 2, one = 1 / period;
    AFFINE_EACH_LANE {
        double c = a->centre[l], s = a->slope[l], e = a->error[l], r = affine_lane_radius(s, e), turns = c * one;
        double over = c - period * ((turns + ELEMENTARY_ROUND) - ELEMENTARY_ROUND), under = over < 0 ? over + half : over - half;
        bool low = fabs(under) + r <= half, high = fabs(over) + r <= half;
        AffineKink kink = affine_kink(low ? under : over, r);
        double sign = low ? 1 : -1, k = sign * kink.k, centre = (low ? 0 : half) + sign * (kink.k * (low ? under : over) + kink.chord / 2);
        double error = affine_lane_error(fabs(k) * e + kink.chord / 2, 16 * (fabs(c) + half + r));
        bool tells = low || high;
        out->centre[l] = tells ? centre : half / 2, out->slope[l] = tells ? k * s : 0;
        out->error[l] = (tells ? error : affine_lane_error(half / 2, half)) + (fabs(turns) < 0x1p40 ? 0 * e : HUGE_VAL);
    }
}

/* c^p + p·c^(p - 1)·d and p·(p - 1)/2·ξ^(p - 2)·d², which is between 0 and its value at one of the ends with d² = r²; or the range, where that
 * is narrower. What may be below 0 is unknown, and what has powers far from 1, which would be no normal numbers. */
static inline void affine_pow_lanes(AffineLanes *restrict out, const AffineLanes *restrict a, double power) {
    double low[AFFINE_LANES], high[AFFINE_LANES], logs[3][AFFINE_LANES], middle[AFFINE_LANES], first[AFFINE_LANES], last[AFFINE_LANES];
    const double curved = power * (power - 1) / 2;
    AFFINE_EACH_LANE {
        double c = a->centre[l], r = affine_lane_radius(a->slope[l], a->error[l]);
        low[l] = (c - r) - fabs(c) * 0x1p-50, high[l] = (c + r) + fabs(c) * 0x1p-50;
    }
    AFFINE_EACH_LANE logs[0][l] = elementary_ln_core(a->centre[l]);
    AFFINE_EACH_LANE logs[1][l] = elementary_ln_core(low[l]);
    AFFINE_EACH_LANE logs[2][l] = elementary_ln_core(high[l]);
    AFFINE_EACH_LANE middle[l] = elementary_exp_core(power * logs[0][l]);
    AFFINE_EACH_LANE first[l] = elementary_exp_core((power - 2) * logs[1][l]);
    AFFINE_EACH_LANE last[l] = elementary_exp_core((power - 2) * logs[2][l]);
    AFFINE_EACH_LANE {
        double c = a->centre[l], s = a->slope[l], e = a->error[l], r = affine_lane_radius(s, e), slope = power * (middle[l] / c);
        double bend = curved * (first[l] > last[l] ? first[l] : last[l]) * (r * r) / 2, error = fabs(slope) * e + fabs(bend);
        double at_low = first[l] * (low[l] * low[l]), at_high = last[l] * (high[l] * high[l]), half = fabs(at_high - at_low) / 2;
        double most = (at_low > at_high ? at_low : at_high) + middle[l] + fabs(bend) + fabs(slope) * r;
        double exponents = (fabs(power) + 2) * (1 + fabs(logs[1][l]) + fabs(logs[2][l])), size = 16 * most * (1 + exponents);
        bool tells = error < half, known = low[l] >= 0x1p-200 && high[l] <= 0x1p200 && exponents < 600;
        out->centre[l] = tells ? middle[l] + bend : at_low / 2 + at_high / 2, out->slope[l] = tells ? slope * s : 0;
        out->error[l] = known ? affine_lane_error(tells ? error : half, size) + 0 * e : HUGE_VAL;
    }
}

/* Whether the angles of all centres are straight lines of operations. */
static inline bool affine_plain_angles(const AffineLanes *y, const AffineLanes *x) {
    uint64_t other = 0;
    AFFINE_EACH_LANE other |= elementary_atan2_usual(y->centre[l], x->centre[l]) ? 0 : 1;
    return !other;
}

/* atan2(y, x), whose second derivative along any direction is at most 1/ρ² at the distance ρ from the origin; where the cut may be crossed
 * (x ≤ 0, y = 0), any angle. For centres that affine_plain_angles() has seen. */
static inline void affine_angle_lanes(AffineLanes *restrict out, const AffineLanes *restrict y, const AffineLanes *restrict x) {
    const double most = VTS_PI * (1 + 0x1p-50);
    double angle[AFFINE_LANES];
    AFFINE_EACH_LANE angle[l] = elementary_atan2_core(y->centre[l], x->centre[l]);
    AFFINE_EACH_LANE {
        double yc = y->centre[l], ys = y->slope[l], ye = y->error[l], xc = x->centre[l], xs = x->slope[l], xe = x->error[l];
        double yr = affine_lane_radius(ys, ye) + fabs(yc) * 0x1p-50, xr = affine_lane_radius(xs, xe) + fabs(xc) * 0x1p-50;
        double square = xc * xc + yc * yc, way = xr * xr + yr * yr, nearest = (sqrt(square) - sqrt(way)) * (1 - 0x1p-40);
        double by_y = xc / square, by_x = -yc / square, error = fabs(by_y) * ye + fabs(by_x) * xe + way / (nearest * nearest) / 2;
        double size = 64 + 16 * (fabs(by_y) * yr + fabs(by_x) * xr);
        bool cut = xc - xr <= 0 && fabs(yc) <= yr, tells = !cut && nearest > 0 && error < most;
        out->centre[l] = tells ? angle[l] : 0, out->slope[l] = tells ? by_y * ys + by_x * xs : 0;
        out->error[l] = (tells ? affine_lane_error(error, size) : most) + 0 * (ye + xe);
    }
}

/* The one, the other, or what holds both. */
static inline void affine_select_lanes(AffineLanes *restrict out, const AffineLanes *restrict a, const AffineLanes *restrict b,
                                       const AffineLanes *restrict c) {
    AFFINE_EACH_LANE {
        double radius = affine_lane_radius(a->slope[l], a->error[l]), slack = fabs(a->centre[l]) * 0x1p-50;
        bool below = a->centre[l] + radius + slack < 0, above = a->centre[l] - radius - slack >= 0;
        double br = affine_lane_radius(b->slope[l], b->error[l]), cr = affine_lane_radius(c->slope[l], c->error[l]);
        double b_low = b->centre[l] - br, c_low = c->centre[l] - cr, b_high = b->centre[l] + br, c_high = c->centre[l] + cr;
        double low = b_low < c_low ? b_low : c_low, high = b_high > c_high ? b_high : c_high;
        double half = affine_lane_error(high / 2 - low / 2, 8 * (fabs(low) + fabs(high))) + 0 * (br + cr);
        out->centre[l] = below ? b->centre[l] : above ? c->centre[l] : low / 2 + high / 2;
        out->slope[l] = below ? b->slope[l] : above ? c->slope[l] : 0;
        out->error[l] = below ? b->error[l] : above ? c->error[l] : half;
    }
}

#endif
