/* Diffuse light, highlights and thin layers by POV-Ray 3.7's formulas (its documentation, "Finish"; measured where that is silent). */
#include "base/random.h"
#include "pattern/pattern.h"
#include "render/surface.h"

/* White highlights of plastic, coloured ones of metal: which whiten where the light grazes. */
static Vec3f highlight_color(const Finish *finish, Vec3f pigment, double cosine) {
    if (finish->metallic == 0) return vec3f(1, 1, 1);
    double x = acos(double_clamp(cosine, -1, 1)) / (VTS_PI / 2), d = x - 1.12;
    double white = double_clamp(0.014567225 / (d * d) - 0.011612903, 0, 1);
    float metal = (float)(finish->metallic * (1 - white));
    return vec3f(1 + metal * (pigment.x - 1), 1 + metal * (pigment.y - 1), 1 + metal * (pigment.z - 1));
}

static double highlight(const SurfaceLayer *layer, Vec3 view, Vec3 to_light) {
    const Finish *f = layer->finish;
    double sum = 0;
    if (f->phong > 0) {
        Vec3 mirrored = vec3_madd(view, layer->normal, -2 * vec3_dot(view, layer->normal));
        double cosine = vec3_dot(mirrored, to_light), amount = f->phong;
        if (f->phong_albedo) amount *= (f->phong_size + 1) / 2;
        if (cosine > 0) sum += amount * pow(cosine, f->phong_size);
    }
    if (f->specular > 0) {
        double cosine = vec3_dot(vec3_normalize(vec3_sub(to_light, view)), layer->normal), amount = f->specular, size = 1 / f->roughness;
        if (f->specular_albedo) amount *= (size + 2) / (4 * (2 - exp2(-size / 2)));
        if (cosine > 0) sum += amount * pow(cosine, size);
    }
    return sum;
}

static float in_step(double amount, double way, double wavelength) {
    return wavelength > 0 ? (float)(1 + amount * cos(2 * VTS_PI * way / wavelength)) : 1;
}

/* Where it is uneven, by the turbulence of five octaves: measured. */
double surface_film(const Finish *finish, Vec3 point) {
    if (!(finish->irid > 0) || finish->irid_turbulence == 0) return finish->irid_thickness;
    Pigment uneven = pigment_default();
    uneven.octaves = 5;
    return finish->irid_thickness * (1 + finish->irid_turbulence * (2 * pigment_turbulence(&uneven, point) - 1));
}

/* Waves that a thin layer gives back from its top and from its bottom meet in step or against it: a factor of the light. */
Vec3f surface_thin_layer(const SurfaceLayer *layer, Vec3 view, double cosine, Vec3 wavelengths) {
    const Finish *f = layer->finish;
    if (!(f->irid > 0)) return vec3f(1, 1, 1);
    double way = layer->film * (cosine - vec3_dot(view, layer->normal));
    return vec3f(in_step(f->irid, way, wavelengths.x), in_step(f->irid, way, wavelengths.y), in_step(f->irid, way, wavelengths.z));
}

Vec3f surface_layer_light(const SurfaceLayer *layer, Vec3 view, const LightRay *way, bool both_sides, Vec3 wavelengths, uint64_t seed, float *diffuse_out) {
    const Finish *f = layer->finish;
    const Vec3 to_light = way->direction;
    double cosine = vec3_dot(layer->normal, to_light);
    bool back = cosine <= 0 && !both_sides;
    double amount = back ? f->transmission : f->diffuse;
    *diffuse_out = 0;
    if (back && amount == 0) return vec3f(0, 0, 0);
    double lambert = f->brilliance == 1 ? fabs(cosine) : pow(fabs(cosine), f->brilliance);
    if (f->diffuse_albedo) amount *= (f->brilliance + 1) / 2;
    double diffuse = amount * lambert * (double)layer->opaque;
    if (f->crand > 0) diffuse -= f->crand * random_unit(seed);
    *diffuse_out = (float)diffuse;
    Vec3f sum = vec3f_scale(layer->color, *diffuse_out);
    if (!back && way->highlights && (f->phong > 0 || f->specular > 0)) {
        double bright = highlight(layer, view, to_light);
        if (bright > 0) sum = vec3f_madd(sum, highlight_color(f, layer->color, cosine), (float)bright);
    }
    if (!back) sum = vec3f_mul(sum, surface_thin_layer(layer, view, cosine, wavelengths));
    return vec3f_mul(sum, layer->above);
}
