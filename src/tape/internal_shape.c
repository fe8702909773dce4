/* Distances, blobs and helices. Where a formula looks odd (an angle taken at a point moved off the axis, a millionth that is
 * taken away), it is POV-Ray's and scenes are tuned to it. */
#include "tape/internal.h"

static double square(double a) { return a * a; }
/* Of the pair, the second where they cannot be compared. */
static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

double internal_r(const double *p) { return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }
double internal_th(const double *p) { return atan2(p[0], p[2]); }
double internal_ph(const double *p) { return atan2(hypot(p[0], p[2]), p[1]); }
double internal_sphere(const double *p) { return internal_r(p) - p[3]; }

double internal_ellipsoid(const double *p) {
    return sqrt(square(p[0] * p[3]) + square(p[1] * p[4]) + square(p[2] * p[5]));
}

double internal_torus(const double *p) {
    double ring = sqrt(p[0] * p[0] + p[2] * p[2]) - p[3];
    return sqrt(ring * ring + p[1] * p[1]) - p[4];
}

double internal_superellipsoid(const double *p) {
    double east = 2 / p[3], north = 1 / p[4];
    double side = pow(pow(fabs(p[0]), east) + pow(fabs(p[1]), east), p[3] * north);
    return 1 - pow(side + pow(fabs(p[2]), 2 * north), p[4] / 2);
}

double internal_rounded_box(const double *p) {
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += square(larger(0, fabs(p[k]) - (p[4 + k] - p[3])));
    return sqrt(sum) - p[3] - 1e-6;
}

/* ---- sums of bumps ---- */

double internal_blob(const double *p) {
    double half = p[3] / 2, off = p[1] * p[1] + p[2] * p[2];
    double first = smaller((square(p[0] + half) + off) * p[5] * p[5], 1);
    double second = smaller((square(p[0] - half) + off) * p[7] * p[7], 1);
    return -(p[4] * square(1 - first) + p[6] * square(1 - second));
}

double internal_blob2(const double *p) {
    double off = p[1] * p[1] + p[2] * p[2];
    double bumps = exp(-(p[0] * p[0] + off) * p[4]) + exp(-(square(p[0] - p[3]) + off) * p[4]);
    return p[6] - bumps * p[5];
}

/* Three bumps, each long in one axis: the squares of the others count `flat` times. */
typedef struct Bumps {
    double along[3];
} Bumps;

static Bumps bumps(const double *p, double flat, double steep) {
    double x = p[0] * p[0], y = p[1] * p[1], z = p[2] * p[2];
    return (Bumps){{exp(-(x + (y + z) * flat) * steep), exp(-(y + (x + z) * flat) * steep),
                    exp(-(z + (x + y) * flat) * steep)}};
}

double internal_cross_ellipsoids(const double *p) {
    Bumps b = bumps(p, p[3], p[4]);
    return p[6] - larger(larger(b.along[2], b.along[1]), b.along[0]) * p[5];
}

double internal_isect_ellipsoids(const double *p) {
    Bumps b = bumps(p, p[3], p[4]);
    return p[6] - smaller(smaller(b.along[2], b.along[1]), b.along[0]) * p[5];
}

double internal_flange_cover(const double *p) {
    Bumps b = bumps(p, p[3], p[4]);
    return p[6] - (b.along[2] + b.along[1] + b.along[0]) * p[5];
}

double internal_spikes(const double *p) {
    Bumps b = bumps(p, p[3], p[4]);
    double ball = exp(-(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * p[6]) * p[7];
    return -(ball - b.along[2] - b.along[1] - b.along[0]) * p[5];
}

double internal_spikes_2d(const double *p) {
    double fade = exp(-p[6] * (p[0] * p[0] + p[2] * p[2]));
    return p[1] - p[3] * cos(p[4] * p[0]) * cos(p[5] * p[2]) * fade;
}

/* ---- along y ---- */

double internal_poly4(const double *p) {
    double y = p[1], radius = p[3] + y * (p[4] + y * (p[5] + y * (p[6] + y * p[7])));
    return sqrt(p[0] * p[0] + p[2] * p[2]) - larger(radius, -5);
}

double internal_polytubes(const double *p) {
    enum { MOST = 100000 };
    double y = p[1], radius = p[4] + y * (p[5] + y * (p[6] + y * (p[7] + y * p[8]))), nearest = 10000;
    int count = p[3] > 0 ? (int)double_min(p[3], MOST) : 0;
    for (int i = 0; i < count; i++) {
        double angle = 2 * VTS_PI / p[3] * i;
        double x = p[0] - radius * sin(angle), z = p[2] - radius * cos(angle);
        nearest = smaller(sqrt(x * x + z * z), nearest);
    }
    return nearest;
}

double internal_quantum(const double *p) {
    double across = sqrt(p[0] == 0 && p[2] == 0 ? 1e-12 : p[0] * p[0] + p[2] * p[2]);
    double cosine = cos(atan2(across, p[1])), radius = 2 * sqrt(across * across + p[1] * p[1]);
    double wave = radius * radius * exp(-radius * 0.33333333) * (3 * cosine * cosine - 1);
    return -0.1 * (wave * wave - 12);
}

double internal_comma(const double *p) {
    double size = p[3], x = p[0] == 0 && p[2] == 0 ? 0.0001 : p[0], z = p[2], y2 = p[1] * p[1];
    double tail =
        cos(atan2(z, x) / 2) * size / 2 - sqrt(square(sqrt(square(x + size / 4) + z * z) - size * 0.75) + y2);
    double head = size / 2 - sqrt(square(x - size / 2) + z * z + y2);
    return -larger(smaller(z, tail), head);
}

/* ---- helices ---- */

/* How far (a, b) is from the middle of a cross section: 1 round, 2 a diamond, towards 0 a rectangle. */
static double section_radius(double a, double b, double shape) {
    if (shape == 1) return sqrt(a * a + b * b);
    if (shape == 0) return larger(fabs(a), fabs(b));
    double power = 2 / shape;
    return pow(pow(fabs(a), power) + pow(fabs(b), power), shape / 2);
}

static double positive_mod(double a, double period) {
    double rest = fmod(a, period);
    return rest < 0 ? rest + period : rest;
}

/* The axis has no angle: it is taken at a point beside it. */
static double angle_at(double first, double second, bool on_axis, double beside_first, double beside_second) {
    return on_axis ? atan2(beside_first, beside_second) : atan2(first, second);
}

/* Parameters: windings, turns per unit, minor and major radius, shape, cross section, its angle. */
double internal_helix1(const double *p) {
    bool axis = p[0] == 0 && p[2] == 0;
    double r = sqrt(p[0] * p[0] + p[2] * p[2]), angle = angle_at(p[2], p[0], axis, 0, 0.000001);
    double phase = positive_mod(angle * p[3] + p[1] * p[4] * p[3], 2 * VTS_PI);
    double along = (phase - VTS_PI) / p[7] / (p[4] * p[3]), across = r - p[6];
    if (p[8] != 1 && p[9] != 0) {
        double turn = p[9] * VTS_RADIANS, x = across;
        across = x * cos(turn) - along * sin(turn);
        along = x * sin(turn) + along * cos(turn);
    }
    return smaller(p[6] + r, section_radius(across, along, p[8])) - p[5];
}

double internal_helix2(const double *p) {
    double c = cos(p[1] * p[4]), s = sin(p[1] * p[4]), x = p[0] - p[6] * c, z = p[2] - p[6] * s;
    return section_radius(x * c + z * s, z * c - x * s, p[8]) - p[5];
}

double internal_spiral(const double *p) {
    bool axis = p[0] == 0 && p[2] == 0;
    double angle = angle_at(p[2], p[0], axis, 0, 0.000001);
    double winding = sqrt(p[0] * p[0] + p[2] * p[2]) + p[3] * angle / (2 * VTS_PI);
    double tube = section_radius(fmod(winding, p[3]) - p[3] / 2, p[1], p[8]);
    double r = sqrt((axis ? 1e-12 : p[0] * p[0] + p[2] * p[2]) + p[1] * p[1]);
    return -smaller(p[5] - r, p[4] - smaller(tube, r));
}

double internal_helical_torus(const double *p) {
    bool axis = p[0] == 0 && p[2] == 0;
    double across = sqrt(p[0] * p[0] + p[2] * p[2]), round = angle_at(p[0], p[2], axis, 0.000001, 0);
    double tube = sqrt(square(across - p[3]) + p[1] * p[1]);
    double phase = positive_mod(round * p[4] + atan2(across - p[3], p[1]) * p[5], 2 * VTS_PI) - VTS_PI;
    double groove = cos(atan2(phase * p[11], tube - p[8]) * p[10] + round * p[12]) * p[6] + p[7];
    double ridge = groove - smaller(sqrt(square(tube - p[8]) + phase * phase * p[9]), tube + p[8]);
    return -larger(p[7] + p[8] - p[3] - across, ridge);
}

/* ---- grids ---- */

/* Into the twelfth of a hexagonal cell, as POV-Ray folds it. */
static void hex_fold(const double *p, double *x, double *y) {
    double width = sqrt(3.0);
    *x = fabs(fmod(fabs(p[0]), width) - width / 2);
    *y = fabs(fmod(fabs(p[1]), 3) - 1.5);
    double other_x = width / 2 - *x, other_y = 1.5 - *y;
    if (*x * *x + *y * *y > other_x * other_x + other_y * other_y) *x = other_x, *y = other_y;
}

double internal_hex_x(const double *p) {
    double x, y;
    hex_fold(p, &x, &y);
    return atan2(y, x) < VTS_PI / 6 ? x : cos(VTS_PI / 3) * x + sin(VTS_PI / 3) * y;
}

double internal_hex_y(const double *p) {
    double x, y;
    hex_fold(p, &x, &y);
    return atan2(y, x) < VTS_PI / 6 ? y : fabs(cos(VTS_PI / 3) * y - sin(VTS_PI / 3) * x);
}

/* A thread along the other axis, going up and down as a cosine: its distance from (place, height). */
static double thread(double place, double spacing, double stretch, double height, double flat) {
    double off = fabs(positive_mod(place, 2 * spacing) - spacing) * stretch;
    return sqrt(square(height * flat) + off * off);
}

/* Parameters: distances of the threads in x and z, their stretch, height of the waves, stretch in y. */
double internal_mesh1(const double *p) {
    double over_x = cos(p[0] * VTS_PI / p[3]) * p[6], over_z = cos(p[2] * VTS_PI / p[4]) * p[6];
    double a = thread(p[0], p[3], p[5], p[1] - over_z, p[7]);
    double b = thread(p[0] - p[3], p[3], p[5], p[1] + over_z, p[7]);
    double c = thread(p[2], p[4], p[5], p[1] + over_x, p[7]);
    double d = thread(p[2] - p[4], p[4], p[5], p[1] - over_x, p[7]);
    return smaller(smaller(a, b), smaller(c, d));
}
