/* Noises along pieces of a line as reduced affine forms: Taylor's theorem to the second or third order, whichever tells more. */
#ifndef VTS_TAPE_AFFINE_NOISE_H
#define VTS_TAPE_AFFINE_NOISE_H

#include "tape/affine_lanes.h"

typedef enum NoiseKind { NOISE_IS_PERLIN, NOISE_IS_POV } NoiseKind;

/* Pieces in the noise's own space: their middles, halves of their ways and the lengths of those, and how far places may be off, summed over
 * the axes. `unknown` is added to errors: 0, or no number where a place may be none. */
typedef struct NoisePieces {
    TaylorWay way;
    double length[AFFINE_LANES], off[AFFINE_LANES], unknown[AFFINE_LANES];
} NoisePieces;

void affine_noise_pieces(AffineLanes *restrict out, const NoisePieces *restrict pieces, NoiseKind kind);
/* Of a place's three coordinates as forms. */
void affine_noise_lanes(AffineLanes *restrict out, const AffineLanes *const p[3], NoiseKind kind);

#endif
