/* POV-Ray's third noise: gradients at the corners of a lattice, as in Perlin, An image synthesizer, 1985. Its tables follow
 * from s ← 1812433253·s + 12345 mod 2³², whose numbers are r = (s >> 16) mod 2¹⁵:
 *
 *   vectors  from s = 1: three r mod 4096 - 2048 each, taken again while their length is not within (10⁻²·⁵, 1]·2048;
 *   order    of 0 … 2047, the numbers going on: for i = 2048, 2046 … 2 the entries i and r mod 2048 are swapped, entry
 *            2048 being 0 at first and forgotten at last (so that one number is missing and 0 is there twice). */
#include "tape/noise.h"

#include "tape/noise_gradient_tables.inc"

enum { PERIOD = 2048 };

/* The lattice is moved by this much in each axis; to the last digit, for it rounds the place. */
static const double origin = 10000000.023157213;

static unsigned cell(double x, double *fraction) {
    double moved = x + origin, whole = floor(moved);
    *fraction = moved - whole;
    return (unsigned)(whole - PERIOD * floor(whole / PERIOD));
}

static double corner(unsigned index, double x, double y, double z) {
    const int16_t *v = gradient_vectors[index % PERIOD];
    double a = v[0] / 2048., b = v[1] / 2048., c = v[2] / 2048.;
    return (a * x + b * y + c * z) / sqrt(a * a + b * b + c * c);
}

static unsigned order(unsigned i) { return gradient_order[i % PERIOD]; }
static double curve(double t) { return t * t * (3 - 2 * t); }
static double mix(double t, double a, double b) { return a + t * (b - a); }

double noise_gradient(Vec3 p) {
    if (!vec3_is_finite(p)) return (double)NAN;
    double x, y, z, plane[2];
    unsigned i = cell(p.x, &x), j = cell(p.y, &y), k = cell(p.z, &z);
    unsigned near = order(i), far = order((i + 1) % PERIOD);
    for (unsigned side = 0; side < 2; side++) {
        double row[2], height = z - side;
        unsigned layer = (k + side) % PERIOD;
        for (unsigned step = 0; step < 2; step++) {
            unsigned line = (j + step) % PERIOD;
            double depth = y - step;
            row[step] = mix(curve(x), corner(order(near + line) + layer, x, depth, height),
                            corner(order(far + line) + layer, x - 1, depth, height));
        }
        plane[side] = mix(curve(y), row[0], row[1]);
    }
    return mix(curve(z), plane[0], plane[1]);
}

double noise_pov_gradient(Vec3 p) {
    /* POV-Ray's authors found the factors that spread the values over [0, 1]. */
    double value = 0.5 * (1.59 * noise_gradient(p) + 0.985);
    return isfinite(value) ? double_clamp(value, 0, 1) : value;
}

double noise_generated(int generator, Vec3 p) {
    switch (generator) {
    case NOISE_CORRECTED: return noise_pov(p);
    case NOISE_GRADIENT: return noise_pov_gradient(p);
    default: return noise_pov_original(p);
    }
}
