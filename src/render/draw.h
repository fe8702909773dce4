/* What one sample of a pixel draws by lot: its place in the pixel, on the lens, on lights …
 *
 * Each use has two numbers in [0, 1), those of a Sobol' sequence over the samples of the pixel, scrambled by Owen's permutations, which differ
 * from pixel to pixel and use to use (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4), with the hash of Laine and Karras as
 * N. Vegdahl improved it): samples 0 … n − 1 lie well for any n, best for powers of two, and uses know nothing of each other. */
#ifndef VTS_RENDER_DRAW_H
#define VTS_RENDER_DRAW_H

#include "base/random.h"

#include <math.h>

typedef struct Draw {
    uint64_t pixel; /* a hash of the pixel and the seed */
    uint32_t index; /* of the sample in the pixel */
} Draw;

/* Numbers of uses; those of rays further on add DRAW_STEP for each. */
enum { DRAW_PIXEL, DRAW_LENS, DRAW_TIME, DRAW_SKY, DRAW_LIGHT = 8, DRAW_STEP = 64 };

static inline uint32_t draw_reverse(uint32_t x) {
    x = x >> 16 | x << 16;
    x = (x & 0xFF00FF00u) >> 8 | (x & 0x00FF00FFu) << 8;
    x = (x & 0xF0F0F0F0u) >> 4 | (x & 0x0F0F0F0Fu) << 4;
    x = (x & 0xCCCCCCCCu) >> 2 | (x & 0x33333333u) << 2;
    return (x & 0xAAAAAAAAu) >> 1 | (x & 0x55555555u) << 1;
}
/* A permutation in which each bit decides by those below it. */
static inline uint32_t draw_permute(uint32_t x, uint32_t seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526C56u;
    return x ^ x * 0x53A22864u;
}
/* Owen's scrambling: each bit decided by those above it. */
static inline uint32_t draw_scramble(uint32_t x, uint32_t seed) { return draw_reverse(draw_permute(draw_reverse(x), seed)); }

/* The two numbers of a use. */
static inline void draw_pair(const Draw *draw, uint32_t use, double *u, double *v) {
    uint64_t bits = random_mix(draw->pixel + use * 0x9E3779B97F4A7C15u), more = random_mix(bits);
    /* Uses take the samples in different orders, or what lies well in each would not together. */
    uint32_t index = use == DRAW_PIXEL ? draw->index : draw_scramble(draw->index, (uint32_t)(more >> 32));
    uint32_t second = 0;
    for (uint32_t rest = index, column = 1u << 31; rest; rest >>= 1, column ^= column >> 1)
        if (rest & 1) second ^= column;
    *u = draw_scramble(draw_reverse(index), (uint32_t)bits) * 0x1p-32;
    *v = draw_scramble(second, (uint32_t)(bits >> 32)) * 0x1p-32;
}

/* Number `index` of the sequence in three dimensions, each in [0, 1): any 64 from a multiple of 64 on lie one in each of 4 x 4 x 4 boxes, and, by any two of the three, of 8 x 8. */
static inline void draw_three(uint32_t index, uint64_t seed, double out[3]) {
    uint32_t second = 0, third = 0, pascal = 1u << 31, before = 1u << 31, column = 1u << 31 | 1u << 30; /* of the third: of x^2 + x + 1, from 1 and 3 on */
    for (uint32_t rest = index, now = before; rest; rest >>= 1, pascal ^= pascal >> 1) {
        if (rest & 1) second ^= pascal, third ^= now;
        now = column, column = column ^ before ^ before >> 2, before = now;
    }
    const uint64_t bits = random_mix(seed);
    out[0] = draw_scramble(draw_reverse(index), (uint32_t)bits) * 0x1p-32;
    out[1] = draw_scramble(second, (uint32_t)(bits >> 32)) * 0x1p-32;
    out[2] = draw_scramble(third, (uint32_t)random_mix(bits)) * 0x1p-32;
}

/* How wide one of so many samples of a pixel is, in pixels: narrower than the mesh of their net. Wider ones, which blur what is at a pixel's border, are
 * wrong by more than narrower ones are noisy. */
static inline double sample_width(double samples) { return samples > 1 ? 0.7 / sqrt(samples) : 1; }

#endif
