#include "render/lighting.h"

#include "pattern/pattern.h"

static double spot_factor(const Light *light, Vec3 to_light) {
    Vec3 axis = vec3_normalize(vec3_sub(light->point_at, light->location));
    double cosine = -vec3_dot(axis, to_light);
    double inner = cos(light->radius * VTS_RADIANS), outer = cos(light->falloff * VTS_RADIANS);
    if (cosine <= outer) return 0;
    double edge = 1;
    if (cosine < inner) { /* POV-Ray's cubic between falloff and radius */
        double x = (cosine - outer) / (inner - outer);
        edge = x * x * (3 - 2 * x);
    }
    return edge * (light->tightness > 0 ? pow(cosine, light->tightness) : 1);
}

LightRay light_ray(const Light *light, Vec3 point) {
    LightRay ray = {.color = vec3f_from_color(light->color)};
    if (light->kind == LIGHT_PARALLEL) {
        ray.direction = light->to_light;
        ray.distance = VTS_INFINITY;
        return ray;
    }
    Vec3 to = vec3_sub(light->location, point);
    ray.distance = vec3_length(to);
    ray.direction = ray.distance > 0 ? vec3_scale(to, 1 / ray.distance) : vec3(0, 1, 0);
    double factor = 1;
    if (light->fade_power > 0 && light->fade_distance > 0)
        factor = 2 / (1 + pow(ray.distance / light->fade_distance, light->fade_power));
    if (light->kind == LIGHT_SPOT) factor *= spot_factor(light, ray.direction);
    ray.color = vec3f_scale(ray.color, (float)factor);
    return ray;
}

Vec3f shade_tone(const NdfShade *shade, const Look *look, Vec3f color) {
    Vec3f metal = vec3f_add(vec3f_scale(color, look->metallic), vec3f_scale(vec3f(1, 1, 1), 1 - look->metallic));
    return vec3f_madd(vec3f_scale(color, shade->diffuse), metal, shade->highlight);
}

Vec3f sky_radiance(const Scene *scene, Vec3 direction, double spread) {
    if (!scene->sky_layer_count) return vec3f_from_color(scene->background);
    Color sky = sky_color(scene->sky_layers, scene->sky_layer_count, direction, spread);
    return vec3f_from_color(color_over(sky, scene->background));
}

Vec3f fog_over(const Scene *scene, Vec3f color, float alpha, double t) {
    if (!scene->has_fog || scene->fog.distance <= 0) return color;
    float keep = isfinite(t) ? (float)exp(-t / scene->fog.distance) : 0;
    float filter = (float)scene->fog.color.transmit;
    keep = keep + (1 - keep) * filter;
    return vec3f_madd(vec3f_scale(color, keep), vec3f_from_color(scene->fog.color), (1 - keep) * alpha);
}
