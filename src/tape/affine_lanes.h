/* Reduced affine forms (affine.h) of several pieces of a line at once, in arrays that compilers turn into vectors.
 *
 * An error that is not below infinity, or no number: nothing is known of that lane, not even that it has a value; the caller asks
 * affine.h then, which knows more about such places. So no operation here needs a branch. */
#ifndef VTS_TAPE_AFFINE_LANES_H
#define VTS_TAPE_AFFINE_LANES_H

#include "tape/affine.h"
#include "tape/noise_taylor.h"

enum { AFFINE_LANES = TAYLOR_LANES };

typedef struct AffineLanes {
    double centre[AFFINE_LANES], slope[AFFINE_LANES], error[AFFINE_LANES];
} AffineLanes;

/* Not unrolled: compilers make vectors of loops more surely than of what is left of them. */
#define AFFINE_EACH_LANE _Pragma("GCC unroll 1") for (int l = 0; l < AFFINE_LANES; l++)

/* `error`, rounded up, and the roundings of an operation whose results and operands add up to at most `size`. */
static inline double affine_lane_error(double error, double size) {
    return (error + size * 0x1p-49) * (1 + 0x1p-50) + 0x1p-1000;
}

static inline AffineForm affine_lane(const AffineLanes *a, int l) {
    if (!(a->error[l] < HUGE_VAL)) return affine_unknown(true);
    return (AffineForm){a->centre[l], a->slope[l], a->error[l], false};
}

static inline void affine_set_lane(AffineLanes *a, int l, AffineForm form) {
    a->centre[l] = form.centre, a->slope[l] = form.slope, a->error[l] = form.nan ? HUGE_VAL : form.error;
}

static inline void affine_fill_lanes(AffineLanes *a, double value) {
    AFFINE_EACH_LANE a->centre[l] = value, a->slope[l] = 0, a->error[l] = isfinite(value) ? 0 : HUGE_VAL;
}

static inline void affine_add_lanes(AffineLanes *restrict out, const AffineLanes *a, const AffineLanes *b) {
    AFFINE_EACH_LANE {
        double c = a->centre[l] + b->centre[l], s = a->slope[l] + b->slope[l], e = a->error[l] + b->error[l];
        double size = fabs(a->centre[l]) + fabs(b->centre[l]) + (fabs(a->slope[l]) + fabs(b->slope[l])) + e;
        out->centre[l] = c, out->slope[l] = s, out->error[l] = affine_lane_error(e, size);
    }
}

static inline void affine_sub_lanes(AffineLanes *restrict out, const AffineLanes *a, const AffineLanes *b) {
    AFFINE_EACH_LANE {
        double c = a->centre[l] - b->centre[l], s = a->slope[l] - b->slope[l], e = a->error[l] + b->error[l];
        double size = fabs(a->centre[l]) + fabs(b->centre[l]) + (fabs(a->slope[l]) + fabs(b->slope[l])) + e;
        out->centre[l] = c, out->slope[l] = s, out->error[l] = affine_lane_error(e, size);
    }
}

/* Numbers change no bits but their exponents: what is neither huge nor tiny is exact. */
static inline bool affine_is_power_of_two(double k) {
    uint64_t bits;
    memcpy(&bits, &k, sizeof bits);
    return bits << 12 == 0 && fabs(k) > 0x1p-64 && fabs(k) < 0x1p64;
}

static inline void affine_scale_lanes(AffineLanes *restrict out, const AffineLanes *a, double k) {
    if (affine_is_power_of_two(k)) {
        /* Of subnormal numbers bits are lost, by less than is added; what becomes infinite makes the error no number. */
        AFFINE_EACH_LANE {
            double c = a->centre[l] * k, slope = a->slope[l] * k;
            out->centre[l] = c, out->slope[l] = slope, out->error[l] = a->error[l] * fabs(k) + 0x1p-1000 + 0 * (c + slope);
        }
        return;
    }
    AFFINE_EACH_LANE {
        double c = a->centre[l] * k, s = a->slope[l] * k, e = a->error[l] * fabs(k);
        out->centre[l] = c, out->slope[l] = s, out->error[l] = affine_lane_error(e, fabs(c) + fabs(s) + e);
    }
}

static inline void affine_shift_lanes(AffineLanes *restrict out, const AffineLanes *a, double k) {
    AFFINE_EACH_LANE {
        double c = a->centre[l] + k, s = a->slope[l], e = a->error[l];
        out->centre[l] = c, out->slope[l] = s,
        out->error[l] = affine_lane_error(e, fabs(a->centre[l]) + fabs(k) + fabs(s) + e);
    }
}

static inline void affine_neg_lanes(AffineLanes *restrict out, const AffineLanes *a) {
    AFFINE_EACH_LANE out->centre[l] = -a->centre[l], out->slope[l] = -a->slope[l],
                     out->error[l] = a->error[l];
}

static inline void affine_mul_lanes(AffineLanes *restrict out, const AffineLanes *a, const AffineLanes *b) {
    AFFINE_EACH_LANE {
        double ac = a->centre[l], as = a->slope[l], ae = a->error[l], bc = b->centre[l], bs = b->slope[l],
               be = b->error[l];
        double both = as * bs / 2, size = (fabs(ac) + fabs(as) + ae) * (fabs(bc) + fabs(bs) + be) * 4;
        double error = fabs(both) + (fabs(ac) + fabs(as)) * be + (fabs(bc) + fabs(bs)) * ae + ae * be;
        out->centre[l] = ac * bc + both, out->slope[l] = ac * bs + bc * as,
        out->error[l] = affine_lane_error(error, size);
    }
}

static inline void affine_sqr_lanes(AffineLanes *restrict out, const AffineLanes *a) {
    AFFINE_EACH_LANE {
        double c = a->centre[l], s = a->slope[l], e = a->error[l], half = s * s / 2, own = e * e / 2;
        double size = fabs(c) + fabs(s) + e, error = half + own + 2 * (fabs(c) + fabs(s)) * e;
        out->centre[l] = c * c + half + own, out->slope[l] = 2 * c * s,
        out->error[l] = affine_lane_error(error, size * size * 4);
    }
}

/* Between the chord over [low, high] and the tangent parallel to it, which is (√high − √low)²/(4(√low + √high)) above. */
static inline void affine_sqrt_lanes(AffineLanes *restrict out, const AffineLanes *a) {
    AFFINE_EACH_LANE {
        double radius = (fabs(a->slope[l]) + a->error[l]) * (1 + 0x1p-50), c = a->centre[l];
        double low = sqrt((c - radius) - fabs(c) * 0x1p-50), high = sqrt((c + radius) + fabs(c) * 0x1p-50);
        double slope = 1 / (low + high), gap = (high - low) * (high - low) * slope / 4;
        out->centre[l] = slope * c + low * high * slope + gap / 2, out->slope[l] = slope * a->slope[l];
        out->error[l] = affine_lane_error(slope * a->error[l] + gap / 2, 32 * high);
    }
}

#endif
