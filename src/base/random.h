/* Random numbers. Sampling in the renderer uses hashes of what the number is for, never a running state, so that
 * pictures do not depend on the schedule of threads. */
#ifndef VTS_BASE_RANDOM_H
#define VTS_BASE_RANDOM_H

#include "base/common.h"

/* One step of SplitMix64 (Steele, Lea & Flood 2014): a good mixing function of 64 bits. */
static inline uint64_t random_mix(uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}
/* A hash of up to four numbers: pixel, sample, dimension, seed … */
static inline uint64_t random_hash(uint64_t a, uint64_t b, uint64_t c, uint64_t d) {
    return random_mix(random_mix(random_mix(random_mix(a) ^ b) ^ c) ^ d);
}
/* [0, 1) from the top bits. */
static inline double random_unit(uint64_t bits) { return (double)(bits >> 11) * 0x1p-53; }
static inline float random_unitf(uint64_t bits) { return (float)(bits >> 40) * 0x1p-24f; }

/* A small generator for tests and builders. */
typedef struct RandomStream {
    uint64_t state;
} RandomStream;
static inline uint64_t random_next(RandomStream *s) { return random_mix(s->state += 0x9E3779B97F4A7C15u); }
static inline double random_next_unit(RandomStream *s) { return random_unit(random_next(s)); }

/* POV-Ray's stream (language.md section 7): s ← 1812433253·s + 12345 mod 2³²; value s / (2³² − 1). */
static inline double random_pov_next(uint32_t *state) {
    *state = *state * 1812433253u + 12345u;
    return (double)*state / 4294967295.0;
}

#endif
