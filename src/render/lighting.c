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

bool light_is_area(const Light *light) { return light->size_u * light->size_v > 1; }

Vec3 light_place(const Light *light, Vec3 point, double u, double v) {
    (void)point;
    if (!light_is_area(light)) return light->location;
    return vec3_madd(vec3_madd(light->location, light->axis_u, u - 0.5), light->axis_v, v - 0.5);
}

LightRay light_ray_from(const Light *light, Vec3 point, Vec3 place) {
    Light there = *light;
    Vec3 moved = vec3_sub(place, light->location);
    there.location = place;
    there.point_at = vec3_add(light->point_at, moved);
    return light_ray(&there, point);
}

bool light_shines_on(const Light *light, const LightGroup *group) {
    if (!light->group) return !group || group->global_lights;
    for (; group; group = group->outer)
        if (group == light->group) return true;
    return false;
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

Air air_between(const Scene *scene, const Ray *ray, double t) {
    Air air = {{1, 1, 1}, {0, 0, 0}};
    (void)ray;
    if (!scene->has_fog || scene->fog.distance <= 0) return air;
    float keep = isfinite(t) ? (float)exp(-t / scene->fog.distance) : 0;
    float filter = (float)scene->fog.color.transmit;
    keep = keep + (1 - keep) * filter;
    return (Air){{keep, keep, keep}, vec3f_scale(vec3f_from_color(scene->fog.color), 1 - keep)};
}
