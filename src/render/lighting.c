#include "render/lighting.h"

#include "pattern/pattern.h"
#include "tape/tape.h"

/* Smooth from 0 at `low` to 1 at `high`, and a step there if `low` is not below it: POV-Ray's cubic at the rims of lights. */
static double rim(double low, double high, double x) {
    if (x >= high) return 1;
    if (x <= low) return 0;
    double f = (x - low) / (high - low);
    return f * f * (3 - 2 * f);
}

/* By the cosine to the axis, raised to `tightness`; between falloff and radius the light ends. */
static double spot_factor(const Light *light, Vec3 to_light) {
    double cosine = vec3_dot(light->to_light, to_light);
    if (!(cosine > 0)) return 0;
    double factor = light->tightness != 0 ? pow(cosine, light->tightness) : 1;
    factor *= rim(cos(light->falloff * VTS_RADIANS), cos(light->radius * VTS_RADIANS), cosine);
    return factor;
}

/* By the distance from the axis. */
static double cylinder_factor(const Light *light, Vec3 to) {
    double along = vec3_dot(light->to_light, to);
    if (!(along > 0)) return 0;
    double away = vec3_length(vec3_madd(to, light->to_light, -along)), rest = 1 - away / light->falloff;
    if (!(rest > 0)) return 0;
    double factor = light->tightness != 0 ? pow(rest, light->tightness) : 1;
    if (light->radius > 0 && away > light->radius) factor *= rim(0, 1 - light->radius / light->falloff, rest);
    return factor;
}

/* By the angle to the axis. Lamps do not swallow light: what is below 0, or no number, is 0. */
static double goniometric_factor(const Light *light, Vec3 to_light) {
    double angle = atan2(vec3_length(vec3_cross(light->to_light, to_light)), vec3_dot(light->to_light, to_light)), out[LIGHT_GONIOMETRIC_OUTPUTS];
    tape_eval_once(light->goniometric, &angle, out);
    return out[0] > 0 && isfinite(out[0]) ? out[0] : 0;
}

/* What leaves it along -to_light. */
static double lamp_factor(const Light *light, Vec3 to_light) {
    double down = vec3_dot(light->to_light, to_light), across = -vec3_dot(light->lamp_turns[0], to_light), aside = -vec3_dot(light->lamp_turns[1], to_light);
    return lamp_light(light->lamp, atan2(hypot(across, aside), down) / VTS_RADIANS, atan2(aside, across) / VTS_RADIANS);
}

static double fading(const Light *light, double distance) {
    if (!(light->fade_power > 0) || !(light->fade_distance > 0)) return 1;
    return 2 / (1 + pow(distance / light->fade_distance, light->fade_power));
}

/* Of a light's colour, and again of what its place makes of it: floats hold the product, and sums of many. */
static const float BRIGHTEST = 1e15f;

static Vec3f limited(Vec3f c) {
    return vec3f(float_clamp(c.x, -BRIGHTEST, BRIGHTEST), float_clamp(c.y, -BRIGHTEST, BRIGHTEST), float_clamp(c.z, -BRIGHTEST, BRIGHTEST));
}

LightRay light_ray(const Light *light, Vec3 point) { return light_ray_from(light, point, light->location); }

LightRay light_ray_from(const Light *light, Vec3 point, Vec3 place) {
    Vec3 to = vec3_sub(place, point);
    double length = vec3_length(to), factor = 1;
    LightRay ray = {.direction = length > 0 ? vec3_scale(to, 1 / length) : vec3(0, 1, 0), .distance = length};
    if (light_is_parallel(light)) ray = (LightRay){.direction = light->to_light, .distance = VTS_INFINITY};
    factor = fading(light, light_is_parallel(light) ? fmax(0, vec3_dot(to, light->to_light)) : length);
    if (light->kind == LIGHT_SPOT) factor *= spot_factor(light, ray.direction);
    if (light->kind == LIGHT_CYLINDER) factor *= cylinder_factor(light, to);
    if (light->goniometric && !light_is_parallel(light)) factor *= goniometric_factor(light, ray.direction);
    if (light->lamp && !light_is_parallel(light)) factor *= lamp_factor(light, ray.direction);
    ray.highlights = !light->shadowless;
    ray.color = vec3f_scale(limited(vec3f_from_color(light->color)), (float)fmin(factor, (double)BRIGHTEST));
    return ray;
}

/* ---- lights with an area ---- */

double light_spread(const Light *light, const LightRay *ray) {
    if (!light_is_area(light) || !(ray->distance > 0)) return 0;
    double area = vec3_length(vec3_cross(light->axis_u, light->axis_v)) * (light->circular ? VTS_PI / 4 : 1);
    return sqrt(area) / ray->distance;
}

bool light_is_area(const Light *light) { return light->size_u > 1 || light->size_v > 1; }

/* POV-Ray halves its rows of lights until two are left, which count alike: so do the numbers of [0, 1) here. Jitter makes each light as
 * wide as the way to the next. */
static double row_place(double u, int size, bool jitter) {
    int low = 0, high = size - 1;
    if (high < 1) return 0;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        bool first = u < 0.5;
        u = first ? 2 * u : 2 * u - 1;
        if (first) high = middle;
        else low = middle;
    }
    bool first = u < 0.5;
    u = first ? 2 * u : 2 * u - 1;
    return ((first ? low : high) + (jitter ? u - 0.5 : 0)) / (size - 1) - 0.5;
}

/* Squares about the middle become circles. */
static void round_off(double *a, double *b) {
    double r = hypot(*a, *b), scale = r > 0 ? fmax(fabs(*a), fabs(*b)) / r : 0;
    *a *= scale, *b *= scale;
}

/* In parts of the sides, from the middle. */
static Vec3 place_at(const Light *light, Vec3 point, double a, double b) {
    Vec3 across = light->axis_u, along = light->axis_v;
    if (light->circular) round_off(&a, &b);
    if (light->orient) {
        Vec3 to = vec3_normalize(vec3_sub(point, light->location)), turned = vec3_normalize(vec3_cross(to, across));
        along = vec3_scale(turned, vec3_length(along));
        across = vec3_scale(vec3_cross(turned, to), vec3_length(across));
    }
    return vec3_madd(vec3_madd(light->location, across, a), along, b);
}

Vec3 light_place(const Light *light, Vec3 point, double u, double v) {
    if (!light_is_area(light)) return light->location;
    return place_at(light, point, row_place(u, light->size_u, light->jitter), row_place(v, light->size_v, light->jitter));
}

/* All lights of a row, or the middles of parts of it. */
static double row_member(int i, int count, int size) {
    if (size < 2) return 0;
    return count == size ? (double)i / (size - 1) - 0.5 : (i + 0.5) / count - 0.5;
}

Vec3 light_member(const Light *light, Vec3 point, const int at[2], const int counts[2]) {
    return place_at(light, point, row_member(at[0], counts[0], light->size_u), row_member(at[1], counts[1], light->size_v));
}

bool light_shines_on(const Light *light, const LightGroup *group) {
    if (!light->group) return !group || group->global_lights;
    for (; group; group = group->outer)
        if (group == light->group) return true;
    return false;
}

Vec3f light_tone(const LightRay *ray, const NdfShade *shade, const Look *look, Vec3f color) {
    Vec3f metal = vec3f_add(vec3f_scale(color, look->metallic), vec3f_scale(vec3f(1, 1, 1), 1 - look->metallic));
    Vec3f tone = vec3f_scale(color, shade->diffuse);
    if (ray->highlights) tone = vec3f_madd(tone, metal, shade->highlight);
    return vec3f_mul(tone, ray->color);
}

Vec3f sky_radiance(const Scene *scene, Vec3 direction, double spread) {
    if (!scene->sky_layer_count) return vec3f_from_color(scene->background);
    return vec3f_from_color(sky_color(scene, direction, spread));
}
