/* Algebraic surfaces: a polynomial times the field strength p[3], kept within ±10. */
#include "tape/internal.h"

#define LIMIT 10.0

typedef struct Powers {
    double x, y, z, x2, y2, z2, r2;
} Powers;

static Powers powers(const double *p) {
    Powers q = {.x = p[0], .y = p[1], .z = p[2], .x2 = p[0] * p[0], .y2 = p[1] * p[1], .z2 = p[2] * p[2]};
    q.r2 = q.x2 + q.y2 + q.z2;
    return q;
}

static double cube(double a) { return a * a * a; }
static double square(double a) { return a * a; }
static double scaled(const double *p, double value) { return double_clamp(p[3] * value, -LIMIT, LIMIT); }

double internal_bicorn(const double *p) {
    Powers q = powers(p);
    double scale = square(p[4]), disc = q.x2 + q.z2;
    return scaled(p, q.y2 * (scale - disc) - square(disc + 2 * p[4] * q.y - scale));
}

double internal_bifolia(const double *p) {
    Powers q = powers(p);
    return scaled(p, p[4] * (q.x2 + q.z2) * q.y - square(q.r2));
}

/* Boy's surface in Apéry's implicit form. */
double internal_boy_surface(const double *p) {
    Powers q = powers(p);
    double under = 1 - q.z, disc = q.x2 + q.y2, root = sqrt(2.0);
    double third = 64 * cube(under) * cube(q.z) - 48 * square(under) * q.z2 * (3 * disc + 2 * q.z2);
    double leaves =
        12 * under * q.z *
        (27 * square(disc) - 24 * q.z2 * disc + 36 * root * q.y * q.z * (q.y2 - 3 * q.x2) + 4 * square(q.z2));
    double rest = (9 * disc - 2 * q.z2) * (-81 * square(disc) - 72 * q.z2 * disc +
                                           108 * root * q.x * q.z * (q.x2 - 3 * q.y2) + 4 * square(q.z2));
    return scaled(p, p[4] * (third + leaves + rest));
}

double internal_crossed_trough(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.x2 * q.z2 - q.y);
}

double internal_cubic_saddle(const double *p) { return scaled(p, p[2] - cube(p[0]) + cube(p[1])); }

static double pillow_with_dents(const double *p) {
    Powers q = powers(p);
    double flat = q.x2 * (q.z2 - 2 * q.z + 1) - q.z2 * (q.z2 - 2 * q.z + 1);
    return flat - square(q.x2 - q.z) - q.y2 * (q.y2 + 2 * q.x2 + q.z2 - 2 * q.z - 1);
}

double internal_cushion(const double *p) { return scaled(p, pillow_with_dents(p)); }
double internal_odd(const double *p) { return scaled(p, pillow_with_dents(p)); }

double internal_devils_curve(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.y2 * (q.y2 - 0.25) - q.x2 * (q.x2 + 2 * q.z2 - 0.36) - square(q.z2));
}

/* Parameters: major and minor radius of the torus, its place in x and y, the radius of inversion. */
double internal_dupin_cyclid(const double *p) {
    Powers q = powers(p);
    double major = square(p[4]), minor = square(p[5]), dx = square(p[6]), dy = square(p[7]), r = square(p[8]);
    double far = minor - dy - square(p[6] + p[4]), near = minor - dy - square(p[6] - p[4]);
    double shift = p[6] * q.x + p[7] * q.y;
    double linear = (minor + major - dy - dx) * (2 * shift - r) - 4 * p[7] * minor * q.y;
    double sum = far * near * square(q.r2) + 2 * r * linear * q.r2;
    return scaled(p, -(sum + 4 * r * r * (shift * (shift - r) + major * q.y2) + square(square(r))));
}

/* POV-Ray computes the surface's fractions 2/3, 1/4 and 2/9 as whole numbers: they vanish. */
double internal_enneper(const double *p) {
    Powers q = powers(p);
    double z = fabs(q.z) < 0.2 ? 0.2 : q.z, saddle = (q.y2 - q.x2) / (2 * z);
    return scaled(p, 6 * square(saddle / 2) - cube(saddle + 2 * q.z2 / 9));
}

double internal_folium_surface(const double *p) {
    Powers q = powers(p);
    return scaled(p, (q.y2 + q.z2) * (1 + (p[5] - 4 * p[4]) * q.x) + q.x2 * (1 + p[5]));
}

double internal_glob(const double *p) {
    Powers q = powers(p);
    return scaled(p, 0.5 * square(q.x2) * (q.x + 1) - (q.y2 + q.z2));
}

double internal_heart(const double *p) {
    Powers q = powers(p);
    return scaled(p, 0.1 * q.x2 * cube(q.z) + q.y2 * cube(q.z) - cube(q.r2 + q.x2 - 1));
}

double internal_hunt_surface(const double *p) {
    Powers q = powers(p);
    return scaled(p, -4 * cube(q.r2 - 13) - 27 * square(3 * q.x2 + q.y2 - 4 * q.z2 - 12));
}

double internal_hyperbolic_torus(const double *p) {
    Powers q = powers(p);
    double sum = square(p[4]) + square(p[5]), difference = square(p[4]) - square(p[5]);
    double form = square(q.x2 + q.y2 - q.z2) + 2 * (difference * q.y2 - sum * q.x2 + sum * q.z2);
    return scaled(p, -(form + square(difference)));
}

double internal_kampyle_of_eudoxus(const double *p) {
    Powers q = powers(p);
    double scale = square(p[5]);
    return scaled(p, scale * q.x2 * (q.x2 - square(p[4])) - (q.y2 + q.z2));
}

double internal_klein_bottle(const double *p) {
    Powers q = powers(p);
    double inner = q.r2 - 2 * q.y - 1, outer = q.r2 + 2 * q.y - 1;
    return scaled(p, -outer * (square(inner) - 8 * q.z2) - 16 * q.x * q.z * inner);
}

static double mixed_squares(Powers q) { return q.x2 * q.y2 + q.x2 * q.z2 + q.y2 * q.z2; }
static double fourth_powers(Powers q) { return square(q.x2) + square(q.y2) + square(q.z2); }

double internal_kummer_surface_v1(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.r2 + mixed_squares(q) - fourth_powers(q) - 1);
}

double internal_kummer_surface_v2(const double *p) {
    Powers q = powers(p);
    return scaled(p, 1 - fourth_powers(q) - p[4] * q.r2 - p[5] * mixed_squares(q) - p[6] * q.x * q.y * q.z);
}

double internal_lemniscate_of_gerono(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.x2 - square(q.x2) - q.y2 - q.z2);
}

double internal_mitre(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.y2 * (1 - q.y2 - q.z2) - 4 * q.x2 * q.r2);
}

double internal_nodal_cubic(const double *p) { return scaled(p, 6 * p[1] * p[2] - cube(p[1]) - cube(p[2])); }

double internal_ovals_of_cassini(const double *p) {
    Powers q = powers(p);
    double foci = square(p[4]);
    return scaled(p, p[6] * foci * (q.x2 + q.z2) + square(p[5]) - square(q.r2 + foci));
}

double internal_paraboloid(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.y - q.x2 - q.z2);
}

double internal_parabolic_torus(const double *p) {
    Powers q = powers(p);
    double sum = square(p[4]) + square(p[5]), difference = square(p[4]) - square(p[5]);
    double form = square(q.x2 + q.y2 - q.z) - sum * q.x2 + difference * q.y2 + sum * q.z;
    return scaled(p, -(form + square(difference)));
}

double internal_pillow(const double *p) {
    Powers q = powers(p);
    return scaled(p, fourth_powers(q) - q.r2);
}

double internal_piriform(const double *p) {
    Powers q = powers(p);
    return scaled(p, square(q.x2) - q.x2 * q.x + q.y2 + q.z2);
}

double internal_quartic_paraboloid(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.y - square(q.x2) - square(q.z2));
}

double internal_quartic_saddle(const double *p) {
    Powers q = powers(p);
    return scaled(p, q.y - square(q.x2) + square(q.z2));
}

double internal_quartic_cylinder(const double *p) {
    Powers q = powers(p);
    double around = q.x2 + q.z2, across = square(p[5]);
    return scaled(p, across * square(p[4]) - around * (q.y2 + across));
}

double internal_steiners_roman(const double *p) {
    Powers q = powers(p);
    return scaled(p, -mixed_squares(q) - q.x * q.y * q.z);
}

double internal_strophoid(const double *p) {
    Powers q = powers(p);
    return scaled(p, square(p[6]) * q.x2 * (p[4] + q.x) - (p[5] - q.x) * (q.y2 + q.z2));
}

double internal_torus2(const double *p) {
    Powers q = powers(p);
    double sum = square(p[4]) + square(p[5]), difference = square(p[4]) - square(p[5]);
    return scaled(p, 2 * (sum * (q.x2 + q.z2) - difference * q.y2) - square(q.r2) - square(difference));
}

double internal_torus_gumdrop(const double *p) {
    Powers q = powers(p);
    double disc = q.y2 + q.z2;
    return scaled(p, 20 * q.r2 - 17 - 17 * q.x2 * disc - 4 * (square(q.x2) + square(disc)));
}

double internal_umbrella(const double *p) { return scaled(p, p[1] * square(p[2]) - square(p[0])); }

double internal_witch_of_agnesi(const double *p) {
    Powers q = powers(p);
    return scaled(p, p[4] * (1 - q.y) - (q.x2 + q.z2) * q.y);
}
