/* Fogs and rainbows as POV-Ray 3.7 has them: formulas of its documentation, and measured where that is silent. */
#include "base/random.h"
#include "pattern/pattern.h"
#include "render/lighting.h"

#include <string.h>

/* The length of constant fog that is as thick as ground fog over t of the ray: it is 1/(1 + h²) as dense at height h = (y − offset)/altitude,
 * below 0 as at 0 (the formula is POV-Ray's program's; its manual has another). */
static double ground_length(const Fog *fog, const Ray *ray, double t) {
    double rise = vec3_dot(ray->direction, fog->up) / fog->altitude, h0 = (vec3_dot(ray->origin, fog->up) - fog->offset) / fog->altitude;
    if (fabs(rise) * fmin(t, 1e9) < 1e-7) return t * (h0 > 0 ? 1 / (1 + h0 * h0) : 1);
    double h1 = h0 + rise * t, low = fmin(h0, h1), high = fmax(h0, h1);
    double dense = fmin(high, 0) - fmin(low, 0), thin = atan(fmax(high, 0)) - atan(fmax(low, 0));
    return (dense + thin) / fabs(rise);
}

/* Turbulence takes length away: by its value in the middle of the way, less where the fog is thick. */
static double fog_length(const Fog *fog, const Ray *ray, double t) {
    double length = fog->ground ? ground_length(fog, ray, t) : t;
    if (!fog->turbulence || !(t < VTS_INFINITY)) return length;
    Vec3 middle = vec3_mul(vec3_madd(ray->origin, ray->direction, t / 2), fog->turbulence->turbulence);
    double swirl = fmin(1, pigment_turbulence(fog->turbulence, middle) * fog->turbulence_depth);
    return length * (1 - swirl * exp(-length / fog->distance));
}

static Vec3f rgb_of(Color c) { return vec3f((float)c.red, (float)c.green, (float)c.blue); }

static Vec3f tint_of(Vec3f own, float filter) { return vec3f_madd(vec3f(1 - filter, 1 - filter, 1 - filter), own, filter); }

static void lay_fog(Air *air, const Fog *fog, const Ray *ray, double t) {
    Color c = fog->color;
    float keep = (float)fmax(exp(-fog_length(fog, ray, t) / fog->distance), c.transmit);
    Vec3f own = rgb_of(c), tint = tint_of(own, (float)c.filter);
    air->keep = vec3f_mul(air->keep, vec3f_scale(tint, keep));
    air->add = vec3f_madd(air->add, own, 1 - keep);
}

/* ---- rainbows ---- */

static double degrees_between(Vec3 a, Vec3 b) { return acos(double_clamp(vec3_dot(a, b), -1, 1)) / VTS_RADIANS; }

/* The same for the same ray: of its direction's bits. */
static double scattered(Vec3 d) {
    uint64_t x, y, z;
    memcpy(&x, &d.x, sizeof x), memcpy(&y, &d.y, sizeof y), memcpy(&z, &d.z, sizeof z);
    return 2 * random_unit(random_hash(x, y, z, 0)) - 1;
}

/* How much of the bow is there on this side of it. */
static double bow_strength(const Rainbow *bow, Vec3 direction) {
    if (bow->arc < 0) return 1;
    double x = vec3_dot(direction, bow->right), y = vec3_dot(direction, bow->up), turn = fabs(atan2(x, y)) / VTS_RADIANS;
    if (turn > bow->arc) return 0;
    if (turn <= bow->falloff) return 1;
    double f = (bow->arc - turn) / (bow->arc - bow->falloff);
    return f * f * (3 - 2 * f);
}

/* False where the bow is not. */
static bool see_bow(const Rainbow *bow, const Ray *ray, double t, Air *out) {
    double angle = degrees_between(ray->direction, bow->direction);
    if (bow->jitter != 0) angle += bow->jitter * scattered(ray->direction);
    double across = (angle - bow->angle) / bow->width + 0.5, strength = bow_strength(bow, ray->direction);
    if (!(across >= 0 && across <= 1) || !(strength > 0)) return false;
    Color c = pigment_color(bow->colors, vec3(fmin(across, 1 - 1e-12), 0, 0), vec3(0, 0, 0), 0);
    float keep = (float)fmax(exp(-t / bow->distance), c.transmit), part = (float)strength;
    Vec3f own = rgb_of(c), tint = tint_of(own, (float)c.filter * (1 - keep));
    out->keep = vec3f_madd(vec3f(1 - part, 1 - part, 1 - part), tint, part * keep);
    out->add = vec3f_scale(own, part * (1 - keep));
    return true;
}

/* Where bows cross it is their mean that is seen. */
static void lay_bows(Air *air, const Scene *scene, const Ray *ray, double t) {
    Air sum = {{0, 0, 0}, {0, 0, 0}, 0}, one;
    int count = 0;
    for (size_t i = 0; i < scene->rainbow_count; i++) {
        if (!see_bow(&scene->rainbows[i], ray, t, &one)) continue;
        sum = (Air){vec3f_add(sum.keep, one.keep), vec3f_add(sum.add, one.add), 0};
        count++;
    }
    if (count) *air = (Air){vec3f_scale(sum.keep, 1 / (float)count), vec3f_scale(sum.add, 1 / (float)count), 0};
}

/* Fogs lie before rainbows, and among each other each as if it were alone. */
Air air_between(const Scene *scene, const Ray *ray, double t) {
    Air air = air_clear();
    lay_bows(&air, scene, ray, t);
    Air fog = air_clear();
    for (size_t i = 0; i < scene->fog_count; i++) lay_fog(&fog, &scene->fogs[i], ray, t);
    return (Air){vec3f_mul(air.keep, fog.keep), vec3f_add(fog.add, vec3f_mul(air.add, fog.keep)), 0};
}

Vec3f air_fog_passing(const Scene *scene, const Ray *ray, double t) {
    Air fog = air_clear();
    for (size_t i = 0; i < scene->fog_count; i++) lay_fog(&fog, &scene->fogs[i], ray, t);
    return fog.keep;
}
