/* POV-Ray's noise: a lattice noise whose corners have a value and a gradient. Its tables follow from
 *
 *   hash     0 … 4095, shuffled from the last down: swap i with (s >> 16) mod 4096, where s ← 1812433253·s + 12345
 *            mod 2³² from s = 0;
 *   weights  of i = 0 … 266: c·2/65535 - 1 to six digits, c the CRC-16 (polynomial 0xA001 reversed, start 0) of three
 *            big-endian doubles i·0.12345;
 *   random   the Mersenne twister MT19937 with its default seed 5489. */
#include "tape/noise.h"
#include "tape/noise_interval.h"
#include "tape/noise_floats.h"
#include "tape/tape_rows.h"

#include "tape/noise_pov_tables.inc"

static const float float_weights[] = {
#define WEIGHT(x) x##f
#include "tape/noise_pov_weights.inc"
#undef WEIGHT
};

enum { HASH_SIZE = 4096, LATTICE_ORIGIN = 10000 };

static unsigned hash3(unsigned i, unsigned j, unsigned k) {
    unsigned mask = HASH_SIZE - 1;
    return pov_hash[pov_hash[pov_hash[i & mask] ^ (j & mask)] ^ (k & mask)];
}

/* A whole number modulo 4096, exact for doubles of any size. */
static unsigned wrap(double whole) { return (unsigned)(whole - HASH_SIZE * floor(whole / HASH_SIZE)); }

typedef struct Lattice {
    unsigned cell[3];
    double x, y, z, u, v, w; /* the place in the cell, and its curves, 3t² - 2t³ */
} Lattice;

/* The place in its cell, the cell's number modulo 4096 from the lattice's origin. Small coordinates, which all are, need no
 * floor(). */
static inline unsigned cell_at(double x, double *fraction) {
    if (fabs(x) < 0x1p30) {
        int whole = (int)x;
        whole -= x < whole;
        *fraction = x - whole;
        return (unsigned)whole + LATTICE_ORIGIN;
    }
    *fraction = x - floor(x);
    return wrap(floor(x)) + LATTICE_ORIGIN;
}

static inline double curve_at(double t) { return t * t * (3 - 2 * t); }

/* In line, so that nothing of it goes through memory. */
static inline Lattice lattice_at(Vec3 p) {
    double x, y, z;
    unsigned i = cell_at(p.x, &x), j = cell_at(p.y, &y), k = cell_at(p.z, &z);
    return (Lattice){{i, j, k}, x, y, z, curve_at(x), curve_at(y), curve_at(z)};
}

/* Where the weights of the eight corners are: hashed in x and y first, which the layers share. */
static inline void hash_corners(const unsigned cell[3], unsigned corners[8]) {
    unsigned mask = HASH_SIZE - 1, near = pov_hash[cell[0] & mask], far = pov_hash[(cell[0] + 1) & mask];
    unsigned y = cell[1] & mask, above = (cell[1] + 1) & mask, z = cell[2] & mask,
             behind = (cell[2] + 1) & mask;
    unsigned columns[4] = {pov_hash[near ^ y], pov_hash[far ^ y], pov_hash[near ^ above],
                           pov_hash[far ^ above]};
    for (int k = 0; k < 4; k++) {
        corners[k] = pov_hash[columns[k] ^ z] & 0xFF;
        corners[k + 4] = pov_hash[columns[k] ^ behind] & 0xFF;
    }
}

static inline void find_corners(const unsigned cell[3], LatticeCorners corners) {
    unsigned at[8];
    hash_corners(cell, at);
    for (int k = 0; k < 8; k++) corners[k] = &pov_weights[at[k]];
}

/* The rows of another output are four numbers further. */
static inline double between_corners(const double *const corners[8], int skip, const Lattice *l) {
    return lattice_between(corners, skip, l->x, l->y, l->z, l->u, l->v, l->w);
}

static double raw_noise(Vec3 p) {
    if (!vec3_is_finite(p)) return (double)NAN;
    Lattice lattice = lattice_at(p);
    LatticeCorners corners;
    find_corners(lattice.cell, corners);
    return between_corners(corners, 0, &lattice);
}

/* The sum's range, measured by POV-Ray's authors, is moved to [0, 1]. */
static inline double corrected(double raw) { return double_clamp((raw + 1.05242) * 0.48985582, 0, 1); }

double noise_pov(Vec3 p) { return corrected(raw_noise(p)); }
double noise_pov_original(Vec3 p) { return double_clamp(raw_noise(p) + 0.5, 0, 1); }

double noise_pov_gradient3(Vec3 p, double gradient[3]) {
    gradient[0] = gradient[1] = gradient[2] = (double)NAN;
    if (!vec3_is_finite(p)) return (double)NAN;
    Lattice lattice = lattice_at(p);
    LatticeCorners corners;
    double slope[3];
    find_corners(lattice.cell, corners);
    const double place[3] = {lattice.x, lattice.y, lattice.z}, curve[3] = {lattice.u, lattice.v, lattice.w};
    for (int k = 0; k < 3; k++) slope[k] = 6 * place[k] * (1 - place[k]);
    double raw = lattice_gradient(corners, place, curve, slope, gradient);
    for (int k = 0; k < 3; k++) gradient[k] *= 0.48985582;
    return (raw + 1.05242) * 0.48985582;
}

static void find_near(const int32_t cell[3], LatticeCorners corners) {
    unsigned moved[3];
    for (int k = 0; k < 3; k++) moved[k] = (unsigned)cell[k] + LATTICE_ORIGIN;
    find_corners(moved, corners);
}

static inline void curve_taylor(double t, double out[3]) {
    out[0] = curve_at(t);
    out[1] = 6 * t * (1 - t);
    out[2] = 3 - 6 * t;
}

void noise_pov_taylor(const TaylorWay *way, TaylorTerms *out) {
    taylor_along(way, find_near, curve_taylor, out);
    for (int l = 0; l < TAYLOR_LANES; l++) {
        out->value[l] = (out->value[l] + 1.05242) * 0.48985582;
        out->first[l] *= 0.48985582;
        out->second[l] *= 0.48985582;
    }
}

static inline void curve_floats(const Floats *at, Floats out[3]) {
    const Floats t = *at;
    out[0] = t * t * (3 - 2 * t);
    out[1] = 6 * t * (1 - t);
    out[2] = 3 - 6 * t;
}

static inline void find_floats(const int32_t cell[3], FloatCorners corners) {
    unsigned moved[3], at[8];
    for (int k = 0; k < 3; k++) moved[k] = (unsigned)cell[k] + LATTICE_ORIGIN;
    hash_corners(moved, at);
    for (int k = 0; k < 8; k++) corners[k] = &float_weights[at[k]];
}

void noise_pov_floats(const TaylorWay *way, FloatTerms *out) {
    floats_along(way, find_floats, curve_floats, out);
    out->value = (out->value + 1.05242f) * 0.48985582f;
    out->first *= 0.48985582f;
    out->second *= 0.48985582f;
}

void row_POV_NOISE(double *restrict out, const double *restrict a, const double *restrict b,
                   const double *restrict c, size_t lanes) {
    for (size_t l = 0; l < lanes; l += LATTICE_LANES)
        lattice_rows(out + l, a + l, b + l, c + l, size_min(LATTICE_LANES, lanes - l), find_near, curve_at,
                     raw_noise);
    for (size_t l = 0; l < lanes; l++) out[l] = corrected(out[l]);
}

/* A corner's value and gradient are within ±1 each: half the value, and the distances along the axes, at most 3/2 on average. */
static const double MOST_RAW = 3.5;

Interval interval_POV_NOISE(Interval a, Interval b, Interval c) {
    Interval raw = lattice_over_box(find_near, curve_at, MOST_RAW, (Interval[3]){a, b, c});
    if (interval_is_never(raw)) return raw;
    return (Interval){fmax(0, corrected(raw.low) - 0x1p-46), fmin(1, corrected(raw.high) + 0x1p-46), raw.nan};
}

Vec3 noise_pov_vector(Vec3 p) {
    if (!vec3_is_finite(p)) return vec3_splat((double)NAN);
    Lattice lattice = lattice_at(p);
    LatticeCorners corners;
    find_corners(lattice.cell, corners);
    return vec3(between_corners(corners, 0, &lattice), between_corners(corners, 4, &lattice),
                between_corners(corners, 8, &lattice));
}

/* Cells count from 0, not from the lattice's origin. */
static unsigned cell_hash(Vec3 corner) {
    return vec3_is_finite(corner) ? hash3(wrap(corner.x), wrap(corner.y), wrap(corner.z)) : 0;
}

double noise_pov_cell(Vec3 corner) { return pov_random[cell_hash(corner)] * 0x1p-32; }

Vec3 noise_pov_cell_point(Vec3 corner) {
    const uint32_t *random = &pov_random[cell_hash(corner)];
    return vec3_add(corner, vec3(random[0] * 0x1p-32, random[1] * 0x1p-32, random[2] * 0x1p-32));
}
