/* Terms of sums that are noises of linear functions of the place, as the octaves of fractals are: along a line they need no walk of their tape. */
#ifndef VTS_TAPE_TAPE_NOISE_H
#define VTS_TAPE_TAPE_NOISE_H

#include "base/vec.h"
#include "tape/affine_noise.h"
#include "tape/tape.h"

/* noise(by·p + plus). `size`, `plus_size`: the same with absolute values all the way, and `rounding`: what the tape's own operations
 * are off, as a share of that. */
typedef struct TapeNoise {
    NoiseKind kind;
    double by[3][3], plus[3], size[3][3], plus_size[3], rounding;
} TapeNoise;

/* NULL: the tape, of three inputs and one output, is none. Lives in `arena`. */
const TapeNoise *tape_noise_of(const Tape *tape, Arena *arena);

/* What it needs to know of a line: places in the noise's space, and what they are off, at `off` + |t|·off_by. */
typedef struct TapeNoiseWay {
    double origin[3], along[3], length, off, off_by;
} TapeNoiseWay;

TapeNoiseWay tape_noise_along(const TapeNoise *noise, Vec3 origin, Vec3 direction);
/* On the pieces of the line at middle ± half. What it holds is the tape's value, too, where the place is vec3_madd(origin, direction, t). */
void tape_noise_lanes(const TapeNoise *noise, const TapeNoiseWay *way, const double *restrict middle, const double *restrict half,
                      AffineLanes *restrict out);

#endif
