/* Lattice noises over boxes. Within one cell the noise is a mixture of its corners' linear functions with weights in [0, 1],
 * so that (1 − t)·a + t·b, which rises with a and b, lies between its values at the bounds of t: no cancellation is lost. */
#include "tape/noise_interval.h"

/* Boxes over more cells get the bound of the whole noise. */
enum { MOST_CELLS = 8 };

/* Rounding of the sums and products in a cell, of numbers below 4. */
static const double SLACK = 0x1p-46;

static Interval mix(Interval t, Interval a, Interval b) {
    double near_low = a.low + t.low * (b.low - a.low), far_low = a.low + t.high * (b.low - a.low);
    double near_high = a.high + t.low * (b.high - a.high), far_high = a.high + t.high * (b.high - a.high);
    return interval(bound_min(near_low, far_low), bound_max(near_high, far_high));
}

static Interval scaled(double k, Interval x) { return k >= 0 ? interval(k * x.low, k * x.high) : interval(k * x.high, k * x.low); }

static Interval at_corner(const double *w, Interval x, Interval y, Interval z) {
    Interval a = scaled(w[1], x), b = scaled(w[2], y), c = scaled(w[3], z);
    return interval(w[0] * 0.5 + (a.low + b.low + c.low), w[0] * 0.5 + (a.high + b.high + c.high));
}

static Interval less_one(Interval x) { return interval(x.low - 1, x.high - 1); }

/* In a cell, at places from its lowest corner. */
static Interval in_cell(LatticeFind *find, LatticeCurve *curve, const int32_t cell[3], const Interval place[3]) {
    LatticeCorners corners;
    find(cell, corners);
    Interval x = place[0], y = place[1], z = place[2], x1 = less_one(x), y1 = less_one(y), z1 = less_one(z), t[3];
    for (int k = 0; k < 3; k++) t[k] = interval(curve(place[k].low), curve(place[k].high));
    Interval a = mix(t[0], at_corner(corners[0], x, y, z), at_corner(corners[1], x1, y, z));
    Interval b = mix(t[0], at_corner(corners[2], x, y1, z), at_corner(corners[3], x1, y1, z));
    Interval c = mix(t[0], at_corner(corners[4], x, y, z1), at_corner(corners[5], x1, y, z1));
    Interval d = mix(t[0], at_corner(corners[6], x, y1, z1), at_corner(corners[7], x1, y1, z1));
    return mix(t[2], mix(t[1], a, b), mix(t[1], c, d));
}

Interval lattice_over_box(LatticeFind *find, LatticeCurve *curve, double most, const Interval box[3]) {
    Interval whole = interval(-most, most), out = interval_never();
    double first[3], count[3];
    for (int k = 0; k < 3; k++) {
        if (interval_is_never(box[k])) return interval_never();
        whole.nan |= box[k].nan || interval_has_infinity(box[k]);
    }
    for (int k = 0; k < 3; k++) {
        if (!(fabs(box[k].low) < LATTICE_FAR && fabs(box[k].high) < LATTICE_FAR)) return whole;
        first[k] = floor(box[k].low), count[k] = floor(box[k].high) - first[k] + 1;
    }
    if (count[0] * count[1] * count[2] > MOST_CELLS) return whole;
    for (double i = 0; i < count[0]; i++)
        for (double j = 0; j < count[1]; j++)
            for (double k = 0; k < count[2]; k++) {
                int32_t cell[3] = {(int32_t)(first[0] + i), (int32_t)(first[1] + j), (int32_t)(first[2] + k)};
                Interval place[3];
                for (int a = 0; a < 3; a++) place[a] = interval(bound_max(0, box[a].low - cell[a]), bound_min(1, box[a].high - cell[a]));
                out = interval_hull(out, in_cell(find, curve, cell, place));
            }
    return (Interval){bound_max(whole.low, out.low - SLACK), bound_min(whole.high, out.high + SLACK), whole.nan};
}
