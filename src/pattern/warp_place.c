/* Where warps take a place, as POV-Ray 3.7 computes it. */
#include "pattern/warp.h"

#include "tape/noise.h"

static Vec3 repeat(const Warp *w, Vec3 p) {
    double x = vec3_get(p, w->axis), block = (double)(float)floor(x / w->width), rest = x - block * w->width;
    double c[3] = {p.x, p.y, p.z};
    c[w->axis] = rest;
    if (fmod(block, 2) != 0) {
        c[0] *= w->flip.x, c[1] *= w->flip.y, c[2] *= w->flip.z;
        if (vec3_get(w->flip, w->axis) < 0) c[w->axis] += w->width;
    }
    return vec3_madd(vec3(c[0], c[1], c[2]), w->turbulence, block);
}

/* ---- black holes ---- */

static double block_of(double x, double size) { return size >= 1e-10 ? floor(x / size) : 0; }

static Vec3 hole_center(const Warp *w, Vec3 p) {
    if (!w->repeated) return w->center;
    Vec3 block = vec3(block_of(p.x, w->repeat.x), block_of(p.y, w->repeat.y), block_of(p.z, w->repeat.z));
    Vec3 random = vec3_sub(noise_pov_cell_point(block), block);
    return vec3_add(vec3_add(w->center, vec3_mul(random, w->uncertainty)), vec3_mul(w->repeat, block));
}

static Vec3 black_hole(const Warp *w, Vec3 p) {
    Vec3 delta = vec3_sub(p, hole_center(w, p));
    double length = vec3_length(delta);
    if (!(length < w->radius)) return p;
    double pull = fmin(pow((w->radius - length) / w->radius, w->falloff) * w->strength, 1);
    return vec3_madd(p, delta, w->inverse ? -pull : pull);
}

/* ---- mappings ---- */

/* The mapping's x and y, z its distance, along the orientation. */
static Vec3 oriented(const Warp *w, Vec3 p) {
    Vec3 o = w->orientation;
    if (o.x == 0 && o.y == 0 && o.z == 1) return p;
    return vec3(o.x * p.z + o.y * p.x + o.z * p.x, o.x * p.y - o.y * p.z + o.z * p.y,
                -o.x * p.x + o.y * p.y + o.z * p.z);
}

/* From the positive x axis towards positive z, in turns from 0 to 1. */
static double turn(double x, double z, double length) {
    if (length == 0) return 0;
    if (z == 0) return x > 0 ? 0 : 0.5;
    double angle = acos(double_clamp(x / length, -1, 1));
    return (z < 0 ? 2 * VTS_PI - angle : angle) / (2 * VTS_PI);
}

static double stretch(const Warp *w, double distance) {
    return w->exponent == 1 ? distance : w->exponent == 0 ? 1 : pow(distance, w->exponent);
}

static Vec3 cylindrical(const Warp *w, Vec3 p) {
    double length = sqrt(p.x * p.x + p.z * p.z);
    if (length == 0) return p;
    return oriented(w, vec3(turn(p.x, p.z, length) * stretch(w, length), p.y, length));
}

static Vec3 spherical(const Warp *w, Vec3 p) {
    double distance = vec3_length(p), scale = stretch(w, distance);
    if (distance == 0) return p;
    Vec3 unit = vec3_scale(p, 1 / distance);
    double up = 0.5 + asin(double_clamp(unit.y, -1, 1)) / VTS_PI;
    double around = turn(unit.x, unit.z, sqrt(unit.x * unit.x + unit.z * unit.z));
    return oriented(w, vec3(around * scale, up * scale, distance));
}

static Vec3 toroidal(const Warp *w, Vec3 p) {
    double length = sqrt(p.x * p.x + p.z * p.z);
    if (length == 0) return p;
    double across = length - w->major_radius, minor = sqrt(across * across + p.y * p.y);
    double around = acos(double_clamp(minor > 0 ? -across / minor : 1, -1, 1)), scale = stretch(w, minor);
    if (p.y > 0) around = 2 * VTS_PI - around;
    return oriented(w, vec3(turn(p.x, p.z, length) * scale, around / (2 * VTS_PI) * scale, minor));
}

/* The faces of a cube unfolded into a cross four wide and three high. */
static Vec3 cubic(Vec3 p) {
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z);
    double third = 1 / 3.0;
    if (p.x >= 0 && x >= y && x >= z)
        return vec3(0.75 - 0.125 * (p.z / x + 1), third + third * (p.y / x + 1) / 2, x);
    if (p.y >= 0 && y >= x && y >= z)
        return vec3(0.25 + 0.125 * (p.x / y + 1), 1 - third * (p.z / y + 1) / 2, y);
    if (p.z >= 0 && z >= x && z >= y)
        return vec3(0.25 + 0.125 * (p.x / z + 1), third + third * (p.y / z + 1) / 2, z);
    if (p.x < 0 && x >= y && x >= z) return vec3(0.125 * (p.z / x + 1), third + third * (p.y / x + 1) / 2, x);
    if (p.y < 0 && y >= x && y >= z) return vec3(0.25 + 0.125 * (p.x / y + 1), third * (p.z / y + 1) / 2, y);
    return vec3(1 - 0.125 * (p.x / z + 1), third + third * (p.y / z + 1) / 2, z);
}

Vec3 warp_place(const Warp *w, Vec3 p) {
    switch (w->kind) {
    case WARP_REPEAT: return repeat(w, p);
    case WARP_BLACK_HOLE: return black_hole(w, p);
    case WARP_CYLINDRICAL: return cylindrical(w, p);
    case WARP_SPHERICAL: return spherical(w, p);
    case WARP_TOROIDAL: return toroidal(w, p);
    case WARP_PLANAR: return oriented(w, vec3(p.x, p.y, w->exponent));
    case WARP_CUBIC: return cubic(p);
    default: return p;
    }
}
