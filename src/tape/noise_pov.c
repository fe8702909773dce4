/* POV-Ray's noise: a lattice noise whose corners have a value and a gradient. Its tables follow from
 *
 *   hash     0 … 4095, shuffled from the last down: swap i with (s >> 16) mod 4096, where s ← 1812433253·s + 12345
 *            mod 2³² from s = 0;
 *   weights  of i = 0 … 266: c·2/65535 - 1 to six digits, c the CRC-16 (polynomial 0xA001 reversed, start 0) of three
 *            big-endian doubles i·0.12345;
 *   random   the Mersenne twister MT19937 with its default seed 5489. */
#include "tape/noise.h"

#include "tape/noise_pov_tables.inc"

enum { HASH_SIZE = 4096, LATTICE_ORIGIN = 10000 };

static unsigned hash3(unsigned i, unsigned j, unsigned k) {
    unsigned mask = HASH_SIZE - 1;
    return pov_hash[pov_hash[pov_hash[i & mask] ^ (j & mask)] ^ (k & mask)];
}

/* A whole number modulo 4096, exact for doubles of any size. */
static unsigned wrap(double whole) { return (unsigned)(whole - HASH_SIZE * floor(whole / HASH_SIZE)); }

typedef struct Lattice {
    unsigned cell[3];
    double fraction[3], curve[3]; /* curve: 3t² - 2t³ */
} Lattice;

static Lattice lattice_at(Vec3 p) {
    Lattice l;
    for (int k = 0; k < 3; k++) {
        double x = vec3_get(p, k), whole = floor(x), t = x - whole;
        l.cell[k] = wrap(whole) + LATTICE_ORIGIN;
        l.fraction[k] = t;
        l.curve[k] = t * t * (3 - 2 * t);
    }
    return l;
}

/* Adds the eight corners: each row of four weights is a value (halved) and a gradient, four apart for each output. */
static void sum_corners(const Lattice *l, int outputs, double *sum) {
    for (unsigned corner = 0; corner < 8; corner++) {
        double weight = 1, offset[3];
        unsigned at[3];
        for (unsigned k = 0; k < 3; k++) {
            unsigned far = corner >> (2 - k) & 1;
            at[k] = l->cell[k] + far;
            offset[k] = far ? l->fraction[k] - 1 : l->fraction[k];
            weight *= far ? l->curve[k] : 1 - l->curve[k];
        }
        const double *w = &pov_weights[hash3(at[0], at[1], at[2]) & 0xFF];
        for (int k = 0; k < outputs; k++, w += 4)
            sum[k] += weight * (w[0] * 0.5 + w[1] * offset[0] + w[2] * offset[1] + w[3] * offset[2]);
    }
}

static double raw_noise(Vec3 p) {
    Lattice lattice = lattice_at(p);
    double sum = 0;
    sum_corners(&lattice, 1, &sum);
    return sum;
}

double noise_pov(Vec3 p) {
    /* The sum's range, measured by POV-Ray's authors, is moved to [0, 1]. */
    return vec3_is_finite(p) ? double_clamp((raw_noise(p) + 1.05242) * 0.48985582, 0, 1) : (double)NAN;
}

double noise_pov_original(Vec3 p) {
    return vec3_is_finite(p) ? double_clamp(raw_noise(p) + 0.5, 0, 1) : (double)NAN;
}

Vec3 noise_pov_vector(Vec3 p) {
    if (!vec3_is_finite(p)) return vec3_splat((double)NAN);
    Lattice lattice = lattice_at(p);
    double sum[3] = {0, 0, 0};
    sum_corners(&lattice, 3, sum);
    return vec3(sum[0], sum[1], sum[2]);
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
