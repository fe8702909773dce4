#include "tape/affine_noise.h"

#include "tape/noise.h"
#include "tape/noise_floats.h"

typedef struct NoiseBounds {
    double low, high;               /* of the noise */
    double steepest, curved, third; /* of its derivatives along unit directions */
    double jump;                    /* of the second derivative along an axis, from cell to cell across it */
    bool cut;                       /* to its range, where what is expanded gets beyond */
} NoiseBounds;

typedef struct NoiseFunctions {
    void (*taylor)(const TaylorWay *way, TaylorTerms *out);
    void (*floats)(const TaylorWay *way, FloatTerms *out);
} NoiseFunctions;

static const NoiseBounds bounds[] = {
    [NOISE_IS_PERLIN] = {-NOISE_PERLIN_MOST, NOISE_PERLIN_MOST, NOISE_PERLIN_STEEPEST, NOISE_PERLIN_CURVATURE, NOISE_PERLIN_THIRD, 0, false},
    [NOISE_IS_POV] = {0, 1, NOISE_POV_STEEPEST, NOISE_POV_CURVATURE, NOISE_POV_THIRD, NOISE_POV_JUMP, true},
};
static const NoiseFunctions functions[] = {
    [NOISE_IS_PERLIN] = {noise_perlin_taylor, noise_perlin_floats},
    [NOISE_IS_POV] = {noise_pov_taylor, noise_pov_floats},
};

/* Shorter pieces of a noise are not left to floats. */
static const double FLOAT_SHORTEST = 0x1p-7;

/* In both: numbers that stores cannot change, and nothing that branches, else there are no vectors. A noise that is cut to its range may be below
 * the form by what that gets above it, and above by what it gets below. */

static void by_doubles(AffineLanes *restrict out, const NoisePieces *restrict pieces, NoiseKind kind) {
    const NoiseBounds *known = &bounds[kind];
    TaylorTerms terms;
    const double low = known->low, high = known->high, middle = (low + high) / 2, half = (high - low) / 2;
    const double steepest = known->steepest, curved = known->curved / 2, third = known->third / 6, jump = known->jump / 2,
                 cut = known->cut ? 0.5 : 0;
    functions[kind].taylor(&pieces->way, &terms);
    AFFINE_EACH_LANE {
        double length = pieces->length[l], square = length * length, bend = curved * square, second = terms.second[l] / 2;
        double rest = fabs(second) + (third * square * length + jump * terms.outside[l]);
        double shift = rest < bend ? second : 0, least = rest < bend ? rest : bend;
        double first = terms.first[l], value = terms.value[l] + shift;
        double error = affine_lane_error(least + pieces->off[l] * steepest, 256);
        double reach = fabs(first) + error, above = (value + reach) - high, below = low - (value - reach);
        above = (above > 0 ? above : 0) * cut, below = (below > 0 ? below : 0) * cut;
        double centre = (value - above) + below, total = error + above + below;
        error = value == value ? error : HUGE_VAL;
        out->centre[l] = error < half ? centre : middle;
        out->slope[l] = error < half ? first : 0;
        out->error[l] = (error < half ? total : half) + pieces->unknown[l];
    }
}

/* What floats round is little beside what such pieces leave open. */
static void by_floats(AffineLanes *restrict out, const NoisePieces *restrict pieces, NoiseKind kind) {
    const NoiseBounds *known = &bounds[kind];
    FloatTerms terms;
    float centres[AFFINE_LANES], slopes[AFFINE_LANES], errors[AFFINE_LANES];
    const float low = (float)known->low, high = (float)known->high, middle = (low + high) / 2, half = (high - low) / 2;
    const float steepest = (float)known->steepest, curved = (float)known->curved / 2, third = (float)known->third / 6,
                jump = (float)known->jump / 2, cut = known->cut ? 0.5f : 0;
    functions[kind].floats(&pieces->way, &terms);
    AFFINE_EACH_LANE {
        float length = (float)pieces->length[l], square = length * length, bend = curved * square, second = terms.second[l] / 2;
        float rest = fabsf(second) + (third * square * length + jump * terms.outside[l]);
        float shift = rest < bend ? second : 0, least = rest < bend ? rest : bend;
        float first = terms.first[l], value = terms.value[l] + shift;
        float error = (least + (float)pieces->off[l] * steepest) + (float)NOISE_FLOAT_ERROR;
        float reach = fabsf(first) + error, above = (value + reach) - high, below = low - (value - reach);
        above = (above > 0 ? above : 0) * cut, below = (below > 0 ? below : 0) * cut;
        float centre = (value - above) + below, total = error + above + below;
        error = value == value ? error : HUGE_VALF;
        centres[l] = error < half ? centre : middle;
        slopes[l] = error < half ? first : 0;
        errors[l] = error < half ? total : half + (float)NOISE_FLOAT_ERROR;
    }
    AFFINE_EACH_LANE out->centre[l] = (double)centres[l], out->slope[l] = (double)slopes[l], out->error[l] = (double)errors[l] + pieces->unknown[l];
}

void affine_noise_pieces(AffineLanes *restrict out, const NoisePieces *restrict pieces, NoiseKind kind) {
    const NoiseBounds *known = &bounds[kind];
    double middle = (known->low + known->high) / 2, half = (known->high - known->low) / 2;
    /* Beyond, even a noise without a slope would not be known better than as a whole. */
    double longest = 2 * half / known->curved;
    uint64_t some_short = 0, all_long = 1;
    AFFINE_EACH_LANE some_short |= pieces->length[l] * pieces->length[l] < longest ? 1 : 0;
    AFFINE_EACH_LANE all_long &= pieces->length[l] >= FLOAT_SHORTEST ? 1 : 0;
    if (!some_short)
        AFFINE_EACH_LANE out->centre[l] = middle, out->slope[l] = 0, out->error[l] = half + pieces->unknown[l];
    else if (all_long)
        by_floats(out, pieces, kind);
    else
        by_doubles(out, pieces, kind);
}

void affine_noise_lanes(AffineLanes *restrict out, const AffineLanes *const p[3], NoiseKind kind) {
    NoisePieces pieces;
    AFFINE_EACH_LANE {
        double square = 0, sum = 0, at = 0;
        for (int k = 0; k < 3; k++) {
            pieces.way.at[k][l] = p[k]->centre[l], pieces.way.way[k][l] = p[k]->slope[l];
            square += p[k]->slope[l] * p[k]->slope[l];
            sum += p[k]->error[l], at += p[k]->centre[l];
        }
        double length = sqrt(square) * (1 + 0x1p-48);
        /* Places too far away for cells have no value; places that are no numbers have no noise. */
        pieces.length[l] = length, pieces.off[l] = sum * (1 + 0x1p-48), pieces.unknown[l] = 0 * (sum + length + at);
    }
    affine_noise_pieces(out, &pieces, kind);
}
