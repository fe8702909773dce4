#include "render/surface.h"

/* A mirrored ray never goes into the surface: where a bump would have it so, it is mirrored at the surface itself as well, as in
 * POV-Ray. */
Vec3 surface_mirrored(Vec3 direction, Vec3 normal, Vec3 flat) {
    Vec3 out = vec3_madd(direction, normal, -2 * vec3_dot(direction, normal));
    double height = vec3_dot(out, flat);
    if (height < 0) {
        if (vec3_dot(out, normal) < 0) out = vec3_madd(direction, flat, -2 * vec3_dot(direction, flat));
        else out = vec3_madd(out, flat, -2 * height);
    }
    return vec3_normalize(out);
}

/* Snell's law. */
bool surface_bent(Vec3 direction, Vec3 normal, double ratio, Vec3 *out) {
    double cosine = -vec3_dot(direction, normal), inside = 1 - ratio * ratio * (1 - cosine * cosine);
    if (!(inside >= 0)) return false;
    *out = vec3_normalize(vec3_madd(vec3_scale(direction, ratio), normal, ratio * cosine - sqrt(inside)));
    return true;
}

double surface_fresnel(double cosine, double ratio) {
    double squared = ratio * ratio + cosine * cosine - 1;
    if (!(squared > 0)) return 1;
    double g = sqrt(squared), a = (g - cosine) / (g + cosine), b = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1);
    return double_clamp(0.5 * a * a * (1 + b * b), 0, 1);
}

/* POV-Ray's approximation of how metals lose their colour at grazing angles; 0 straight on, 1 along the surface. */
static double metal_whiteness(double cosine) {
    double x = acos(double_clamp(fabs(cosine), 0, 1)) / (VTS_PI / 2), d = x - 1.12;
    return double_clamp(0.014567225 / (d * d) - 0.011612903, 0, 1);
}

Vec3f surface_reflectivity(const Finish *finish, Vec3f pigment, double cosine, double ratio) {
    const Color *low = &finish->reflection_min, *high = &finish->reflection_max;
    double share = finish->fresnel                     ? surface_fresnel(cosine, ratio)
                   : finish->reflection_falloff == 1 ? 1 - cosine
                                                       : pow(1 - cosine, finish->reflection_falloff);
    Vec3f out = vec3f((float)(low->red + share * (high->red - low->red)), (float)(low->green + share * (high->green - low->green)),
                      (float)(low->blue + share * (high->blue - low->blue)));
    if (finish->reflection_metallic == 0) return out;
    float metal = (float)(finish->reflection_metallic * (1 - metal_whiteness(cosine)));
    return vec3f_mul(out, vec3f(1 + metal * (pigment.x - 1), 1 + metal * (pigment.y - 1), 1 + metal * (pigment.z - 1)));
}

/* 1 / (1 + (d/D)^p), and for p >= 1000 e^(−d/D): between the fade colour, which is left at last, and white. */
Vec3f surface_faded(const Interior *interior, double distance) {
    if (!(interior->fade_power > 0) || !(interior->fade_distance > 0) || !(distance > 0)) return vec3f(1, 1, 1);
    const Color *c = &interior->fade_color;
    double depth = distance / interior->fade_distance;
    if (interior->fade_power >= 1000)
        return vec3f((float)exp(-depth * (1 - c->red)), (float)exp(-depth * (1 - c->green)), (float)exp(-depth * (1 - c->blue)));
    double left = 1 / (1 + pow(depth, interior->fade_power));
    return vec3f((float)(c->red + (1 - c->red) * left), (float)(c->green + (1 - c->green) * left), (float)(c->blue + (1 - c->blue) * left));
}
