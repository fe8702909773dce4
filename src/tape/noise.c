/* Perlin, Improving noise, SIGGRAPH 2002. */
#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/noise_floats.h"
#include "tape/tape_rows.h"

#include "base/random.h"

/* The paper's published permutation of 0 … 255. */
static const uint8_t permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

static unsigned hash(unsigned i) { return permutation[i & 255]; }

static double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/* No value, and one of the twelve directions to the edges of a cube (four of them twice). */
static const double directions[16][4] = {{0, 1, 1, 0}, {0, -1, 1, 0}, {0, 1, -1, 0}, {0, -1, -1, 0},
                                         {0, 1, 0, 1}, {0, -1, 0, 1}, {0, 1, 0, -1}, {0, -1, 0, -1},
                                         {0, 0, 1, 1}, {0, 0, -1, 1}, {0, 0, 1, -1}, {0, 0, -1, -1},
                                         {0, 1, 1, 0}, {0, 0, -1, 1}, {0, -1, 1, 0}, {0, 0, -1, -1}};

static const float float_directions[16][4] = {{0, 1, 1, 0}, {0, -1, 1, 0}, {0, 1, -1, 0}, {0, -1, -1, 0}, {0, 1, 0, 1}, {0, -1, 0, 1},
                                              {0, 1, 0, -1}, {0, -1, 0, -1}, {0, 0, 1, 1}, {0, 0, -1, 1}, {0, 0, 1, -1}, {0, 0, -1, -1},
                                              {0, 1, 1, 0}, {0, 0, -1, 1}, {0, -1, 1, 0}, {0, 0, -1, -1}};

/* The directions of the eight corners, by their numbers. */
static inline void hash_corners(const int32_t cell[3], unsigned corners[8]) {
    unsigned i = (unsigned)cell[0], j = (unsigned)cell[1], k = (unsigned)cell[2];
    unsigned near = hash(i) + j, far = hash(i + 1) + j;
    unsigned columns[4] = {hash(near) + k, hash(far) + k, hash(near + 1) + k, hash(far + 1) + k};
    for (int c = 0; c < 4; c++) corners[c] = hash(columns[c]) & 15, corners[c + 4] = hash(columns[c] + 1) & 15;
}

static void find_corners(const int32_t cell[3], LatticeCorners corners) {
    unsigned at[8];
    hash_corners(cell, at);
    for (int c = 0; c < 8; c++) corners[c] = directions[at[c]];
}

static inline void find_floats(const int32_t cell[3], FloatCorners corners) {
    unsigned at[8];
    hash_corners(cell, at);
    for (int c = 0; c < 8; c++) corners[c] = float_directions[at[c]];
}

/* The lattice cell modulo 256, exact for doubles of any size; *fraction gets the place in the cell. */
static int32_t cell(double x, double *fraction) {
    double whole = floor(x);
    *fraction = x - whole;
    return (int32_t)(whole - 256 * floor(whole / 256));
}

double noise_perlin(Vec3 p) {
    if (!vec3_is_finite(p)) return (double)NAN;
    double x, y, z;
    LatticeCorners corners;
    find_corners((int32_t[3]){cell(p.x, &x), cell(p.y, &y), cell(p.z, &z)}, corners);
    return lattice_between(corners, 0, x, y, z, fade(x), fade(y), fade(z));
}

static double fade_slope(double t) { return 30 * t * t * (t - 1) * (t - 1); }

double noise_perlin_gradient(Vec3 p, double gradient[3]) {
    double place[3], curve[3], slope[3];
    LatticeCorners corners;
    gradient[0] = gradient[1] = gradient[2] = (double)NAN;
    if (!vec3_is_finite(p)) return (double)NAN;
    find_corners((int32_t[3]){cell(p.x, &place[0]), cell(p.y, &place[1]), cell(p.z, &place[2])}, corners);
    for (int k = 0; k < 3; k++) curve[k] = fade(place[k]), slope[k] = fade_slope(place[k]);
    return lattice_gradient(corners, place, curve, slope, gradient);
}

static inline void fade_taylor(double t, double out[3]) {
    out[0] = fade(t);
    out[1] = fade_slope(t);
    out[2] = 30 * t * (2 * t * t - 3 * t + 1);
}

void noise_perlin_taylor(const TaylorWay *way, TaylorTerms *out) { taylor_along(way, find_corners, fade_taylor, out); }

static inline void fade_floats(const Floats *at, Floats out[3]) {
    const Floats t = *at, back = 1 - t;
    out[0] = t * t * t * (t * (t * 6 - 15) + 10);
    out[1] = 30 * (t * t) * (back * back);
    out[2] = 30 * t * back * (1 - 2 * t);
}

void noise_perlin_floats(const TaylorWay *way, FloatTerms *out) { floats_along(way, find_floats, fade_floats, out); }

/* At a place of a cell each corner gives at most the sum of the two largest distances from it along the axes, times its weight.
 * The largest sum of the eight is 1.0363539 (test_tape_interval.c): NOISE_PERLIN_MOST. */
Interval interval_PERLIN(Interval a, Interval b, Interval c) {
    return lattice_over_box(find_corners, fade, NOISE_PERLIN_MOST, (Interval[3]){a, b, c});
}

void row_PERLIN(double *restrict out, const double *restrict a, const double *restrict b,
                const double *restrict c, size_t lanes) {
    for (size_t l = 0; l < lanes; l += LATTICE_LANES)
        lattice_rows(out + l, a + l, b + l, c + l, size_min(LATTICE_LANES, lanes - l), find_corners, fade,
                     noise_perlin);
}

/* One of the six orders of the coordinates, mirrored in any of them: the lattice has no other turns. */
static Vec3 turn(Vec3 p, uint64_t bits) {
    double x = bits & 1 ? -p.x : p.x, y = bits & 2 ? -p.y : p.y, z = bits & 4 ? -p.z : p.z;
    switch ((bits >> 3) % 6) {
    case 0: return vec3(x, y, z);
    case 1: return vec3(x, z, y);
    case 2: return vec3(y, x, z);
    case 3: return vec3(y, z, x);
    case 4: return vec3(z, x, y);
    default: return vec3(z, y, x);
    }
}

double noise_perlin_seeded(Vec3 p, uint32_t seed) {
    Vec3 shift =
        vec3(256 * random_unit(random_hash(seed, 0, 0, 1)), 256 * random_unit(random_hash(seed, 1, 0, 1)),
             256 * random_unit(random_hash(seed, 2, 0, 1)));
    return noise_perlin(vec3_add(turn(p, random_hash(seed, 3, 0, 1) >> 8), shift));
}

Vec3 noise_perlin3(Vec3 p, uint32_t seed) {
    uint32_t base = (uint32_t)random_mix(seed);
    return vec3(noise_perlin_seeded(p, base), noise_perlin_seeded(p, base + 1),
                noise_perlin_seeded(p, base + 2));
}

double noise_fbm(Vec3 p, int octaves, double lacunarity, double gain) {
    double sum = 0, frequency = 1, amplitude = 1;
    for (int k = 0; k < octaves; k++) {
        sum += amplitude * noise_perlin(vec3_scale(p, frequency));
        frequency *= lacunarity;
        amplitude *= gain;
    }
    return sum;
}
