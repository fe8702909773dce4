/* In the limit of small angles turns add up as on a plane, so that moments multiply: n turns by the peak, of moments c_l, have c_l^n; n is distributed as Poisson's law says, whose
 * mean over c_l^n is exp(-depth (1 - c_l)). Light comes to the eye either by one turn that is none of the peak's, with others before and after it, or by the peak's alone: then the
 * last of them is the one that is asked for. (Nakajima & Tanaka 1988 correct delta-M for the first two turns.) */
#include "volume/phase_spread.h"

#include <math.h>

enum { DEPTHS = 24, ANGLES = 160, MOST_DEGREE = 256, QUANTILES = 2048 };
/* Moments whose square is less add nothing. */
static const double LEAST_MOMENT = 3e-3;

/* Both as multiples of the phase function. */
struct PhaseSpread {
    float rest[DEPTHS][ANGLES + 1], peak[DEPTHS][ANGLES + 1];
};

/* Depth 0 first; the last is 23 as deep as the middle one. */
static double depth_of(int i) { return (double)i / (DEPTHS - i); }
/* Closer together forwards: the sine of half the angle goes as the square. */
static double mu_of(int i) {
    double s = (double)i / ANGLES;
    return 1 - 2 * s * s * s * s;
}

/* Of the degrees below `count`, as means over cosines that split the distribution evenly. */
static void moments_by_quantiles(const Phase *phase, int count, double *out) {
    for (int l = 0; l < count; l++) out[l] = 0;
    for (int lobe = 0; lobe < phase->count; lobe++) {
        Phase alone = {.count = 1};
        alone.lobes[0] = phase->lobes[lobe];
        double weight = alone.lobes[0].weight / QUANTILES;
        for (int q = 0; q < QUANTILES; q++) {
            double mu = phase_draw(&alone, 0, (q + 0.5) / QUANTILES), before = 0, here = 1;
            for (int l = 0; l < count; l++) {
                out[l] += weight * here;
                double next = ((2 * l + 1) * mu * here - l * before) / (l + 1);
                before = here, here = next;
            }
        }
    }
}

/* What the peak's turns make of a distribution of the moments `m` and this value; `more`: by how much each moment has more of it left than what is not turned. */
static double turned(double value, const double *m, const double *more, int count, double mu, double depth) {
    double sum = 0, before = 0, here = 1;
    for (int l = 0; l < count; l++) {
        sum += (2 * l + 1) * m[l] * more[l] * here;
        double next = ((2 * l + 1) * mu * here - l * before) / (l + 1);
        before = here, here = next;
    }
    return exp(-depth) * value + sum / (4 * VTS_PI);
}

PhaseSpread *phase_spread_make(const Phase *phase, const Phase *rest, double peak, Arena *arena) {
    double whole[MOST_DEGREE], left[MOST_DEGREE], off[MOST_DEGREE], turns[MOST_DEGREE];
    int count = 4;
    if (!(peak > 0)) return NULL;
    PhaseSpread *out = arena_new(arena, PhaseSpread);
    moments_by_quantiles(phase, MOST_DEGREE, whole);
    moments_by_quantiles(rest, MOST_DEGREE, left);
    for (int l = 0; l < MOST_DEGREE; l++) {
        left[l] *= 1 - peak, off[l] = whole[l] - left[l];
        turns[l] = double_clamp(off[l] / peak, -1, 1);
        if (fabs(whole[l]) > LEAST_MOMENT) count = l + 1;
    }
    for (int d = 0; d < DEPTHS; d++) {
        double depth = depth_of(d), more[MOST_DEGREE];
        for (int l = 0; l < count; l++) more[l] = exp(-depth * (1 - turns[l])) - exp(-depth);
        for (int a = 0; a <= ANGLES; a++) {
            double mu = mu_of(a), value = double_max(phase_value(phase, mu), 1e-12), kept = (1 - peak) * phase_value(rest, mu);
            out->rest[d][a] = (float)(turned(kept, left, more, count, mu, depth) / value);
            out->peak[d][a] = (float)(turned(value - kept, off, more, count, mu, depth) / value);
        }
    }
    return out;
}

static double lerp_of(double a, double b, double t) { return a + t * (b - a); }

static double look_up(const float table[DEPTHS][ANGLES + 1], double mu, double depth) {
    double d = double_min(depth / (1 + depth) * DEPTHS, DEPTHS - 1), a = sqrt(sqrt(double_clamp((1 - mu) / 2, 0, 1))) * ANGLES;
    int i = double_to_int(d, 0, DEPTHS - 2), j = double_to_int(a, 0, ANGLES - 1);
    const float *near = table[i], *far = table[i + 1];
    return lerp_of(lerp_of((double)near[j], (double)near[j + 1], a - j), lerp_of((double)far[j], (double)far[j + 1], a - j), d - i);
}

double phase_spread(const PhaseSpread *spread, double mu, double before, double after) {
    if (!spread) return 1;
    return look_up(spread->rest, mu, before + after) + exp(-after) * look_up(spread->peak, mu, before);
}
