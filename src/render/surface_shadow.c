#include "render/surface.h"

#include "base/random.h"
#include "render/media.h"
#include "render/shone_through.h"
#include "render/surface_parts.h"
#include "render/volume_set.h"

#include <string.h>

/* Lights and what filters let through may be negative, and count no less. */
static float most_of(Vec3f c) { return float_max(fabsf(c.x), float_max(fabsf(c.y), fabsf(c.z))); }

int surface_enclosure(const Enclosure *enclosures, int count, const SurfaceHit *hit) {
    for (int i = count - 1; i >= 0; i--)
        if (enclosures[i].interior == hit->interior && enclosures[i].filled == hit->filled) return i;
    return -1;
}

bool surface_in_air(const Enclosure *enclosures, int count) {
    for (int i = 0; i < count; i++)
        if (!enclosures[i].hollow) return false;
    return true;
}

static void enclose(Enclosure *out, const Interior *interior, uint64_t filled, bool hollow, const Affine *to_interior) {
    out->interior = interior;
    out->filled = filled;
    out->hollow = hollow;
    if (interior && interior->media.count) out->to_interior = *to_interior;
}

void surface_eye_leg(const CompiledScene *compiled, const Cone *cone, Leg *leg) {
    Filling here[MOST_ENCLOSURES];
    const Filling *fillings = compiled->eye_fillings;
    size_t count = compiled->eye_filling_count;
    surface_leg(cone, leg);
    Vec3 eye = compiled->scene->camera.location, at = cone->origin;
    if (at.x != eye.x || at.y != eye.y || at.z != eye.z) {
        fillings = here;
        count = hierarchy_inside(compiled->hierarchy, at, here, MOST_ENCLOSURES);
    }
    for (size_t i = 0; i < count; i++)
        enclose(&leg->enclosures[leg->enclosure_count++], fillings[i].interior, fillings[i].filled, fillings[i].hollow, &fillings[i].to_interior);
}

void surface_cross(const SurfaceTracer *tracer, Enclosure *enclosures, int *count, const SurfaceHit *hit) {
    if (!hit->interior && (hit->hollow || !tracer->compiled->solids_matter)) return;
    int at = surface_enclosure(enclosures, *count, hit);
    if (at >= 0) {
        for (int i = at; i + 1 < *count; i++) enclosures[i] = enclosures[i + 1];
        --*count;
    } else if (*count < MOST_ENCLOSURES) {
        enclose(&enclosures[(*count)++], hit->interior, hit->filled, hit->hollow, &hit->to_interior);
    } else {
        tracer->counters->left_out++; /* and so it is where the ray comes out again */
    }
}

/* POV-Ray's bright spot in the shadow of what is clear: cos^(45 caustics), to the normal as the top layer bends it, is added to 1
 * (measured). */
static const double CAUSTICS = 45;

static float focused(const TexturePart *part, const Ray *ray, const SurfaceHit *hit) {
    if (!hit->interior || hit->interior->caustics == 0) return 1;
    Vec3 normal = texture_layer_normal(part, part->texture, hit->normal, 1);
    return (float)(1 + pow(fabs(vec3_dot(normal, ray->direction)), CAUSTICS * hit->interior->caustics));
}

/* What a surface lets through of light: of each layer filter × pigment + transmit. */
static Vec3f filtered(const Ray *ray, const SurfaceHit *hit) {
    SurfaceParts looks;
    if (surface_parts_ask_place(hit))
        looks.places[0] = (SurfacePlace){.point = vec3_madd(ray->origin, ray->direction, hit->t), .normal = hit->normal, .space = &hit->space,
                                         .surface = {.direction = ray->direction, .uv = {hit->uv.u, hit->uv.v}}};
    surface_parts_find(hit, &looks);
    Vec3f sum = {0, 0, 0};
    for (size_t i = 0; i < looks.count; i++) {
        const TexturePart *part = &looks.parts[i];
        Vec3f through = {1, 1, 1};
        for (const Texture *layer = part->texture; layer && most_of(through) > 0; layer = layer->under) {
            Color c = texture_layer_color(part, layer, hit->normal);
            through = vec3f_mul(through, vec3f((float)(c.filter * c.red + c.transmit), (float)(c.filter * c.green + c.transmit),
                                               (float)(c.filter * c.blue + c.transmit)));
        }
        sum = vec3f_madd(sum, through, (float)part->weight * focused(part, ray, hit));
    }
    return sum;
}

/* Light through everything clear on the way, of which there may be much; nothing more than so much is followed. */
enum { MOST_CLEAR = 1000 };

/* What casts shadows is as fine as what they fall on: a surface seen without its finest parts must not lie in the shadow of these. */
static RayWidth width_at(const Leg *leg, Vec3 point) {
    return (RayWidth){cone_diameter(&leg->cone, vec3_length(vec3_sub(point, leg->cone.origin))), 0};
}

/* Where a ray goes through clear surfaces: the first of them, for what lies between. */
enum { KEPT_CROSSINGS = 8 };
typedef struct Crossings {
    int count; /* of all; KEPT_CROSSINGS + 1: of more */
    struct {
        double t;
        Enclosure side; /* what the surface bounds */
    } kept[KEPT_CROSSINGS];
} Crossings;

static void keep_crossing(Crossings *crossings, const SurfaceHit *hit) {
    if (crossings->count < KEPT_CROSSINGS) {
        crossings->kept[crossings->count].t = hit->t;
        enclose(&crossings->kept[crossings->count].side, hit->interior, hit->filled, hit->hollow, &hit->to_interior);
    }
    if (crossings->count <= KEPT_CROSSINGS) crossings->count++;
}

/* With `media`, what they take as well; else the crossings. */
static Vec3f clear_surfaces(const SurfaceTracer *tracer, const Ray *ray, double from, double distance, const Leg *leg, bool media, Crossings *crossings) {
    const CompiledScene *compiled = tracer->compiled;
    Vec3f through = {1, 1, 1};
    Enclosure enclosures[MOST_ENCLOSURES];
    int count = leg->enclosure_count;
    double bailout = compiled->scene->settings.adc_bailout, begun = 0;
    if (count) memcpy(enclosures, leg->enclosures, (size_t)count * sizeof *enclosures);
    for (int i = 0; i < MOST_CLEAR; i++) {
        SurfaceHit hit;
        bool met = hierarchy_meet_wide(compiled->hierarchy, RAY_SHADOWS, ray, width_at(leg, ray->origin), from, distance, false, &hit);
        if (met && hit.look->opaque) break;
        if (media) through = vec3f_mul(through, media_passing(compiled, enclosures, count, ray, begun, met ? hit.t : distance, tracer->media_slack));
        if (!met) return through;
        through = vec3f_mul(through, filtered(ray, &hit));
        if (hit.interior && surface_enclosure(enclosures, count, &hit) >= 0)
            through = vec3f_mul(through, surface_faded(hit.interior, hit.t - begun));
        surface_cross(tracer, enclosures, &count, &hit);
        if (most_of(through) < (float)bailout) break;
        if (!media && compiled->scene->has_media) keep_crossing(crossings, &hit);
        begun = hit.t;
        from = hit.t * (1 + 1e-9) + leg->clear;
    }
    return vec3f(0, 0, 0);
}

/* What media take between the crossings. */
static Vec3f clear_media(const SurfaceTracer *tracer, const Ray *ray, double distance, const Leg *leg, const Crossings *crossings) {
    Vec3f through = {1, 1, 1};
    Enclosure enclosures[MOST_ENCLOSURES];
    int count = leg->enclosure_count;
    double begun = 0;
    if (count) memcpy(enclosures, leg->enclosures, (size_t)count * sizeof *enclosures);
    for (int i = 0; i <= crossings->count; i++) {
        const bool last = i == crossings->count;
        const double end = last ? distance : crossings->kept[i].t;
        if (count) through = vec3f_mul(through, media_passing(tracer->compiled, enclosures, count, ray, begun, end, tracer->media_slack));
        if (last) break;
        const Enclosure *side = &crossings->kept[i].side;
        SurfaceHit hit;
        hit.interior = side->interior, hit.filled = side->filled, hit.hollow = side->hollow;
        if (side->interior && side->interior->media.count) hit.to_interior = side->to_interior;
        surface_cross(tracer, enclosures, &count, &hit);
        begun = end;
    }
    return through;
}

/* Media take long: they are asked only where something else lets light through. */
static Vec3f clear_way(const SurfaceTracer *tracer, const Ray *ray, double from, double distance, const Leg *leg) {
    Crossings crossings;
    crossings.count = 0;
    Vec3f through = clear_surfaces(tracer, ray, from, distance, leg, false, &crossings);
    if (!tracer->compiled->scene->has_media || most_of(through) <= 0) return through;
    if (crossings.count > KEPT_CROSSINGS) return clear_surfaces(tracer, ray, from, distance, leg, true, NULL);
    return vec3f_mul(through, clear_media(tracer, ray, distance, leg, &crossings));
}

/* `air`: the scene's own media count, in solids as well (measured). */
static Vec3f open_way(SurfaceTracer *tracer, const Ray *ray, double distance, const Leg *leg, double clear, bool air) {
    const CompiledScene *compiled = tracer->compiled;
    tracer->counters->shadow_rays++;
    if (!compiled->clear_shadows) return hierarchy_occluded_wide(compiled->hierarchy, ray, width_at(leg, ray->origin), clear, distance) ? vec3f(0, 0, 0) : vec3f(1, 1, 1);
    Vec3f through = clear_way(tracer, ray, clear, distance, leg);
    if (air && compiled->scene->media.count && most_of(through) > 0) through = vec3f_mul(through, media_air_passing(compiled, ray, distance, tracer->media_slack));
    if (!compiled->volumes || tracer->no_volumes || most_of(through) <= 0) return through;
    return vec3f_mul(through, volumes_passing(compiled->volumes, ray, clear, distance, RAY_SHADOWS));
}

Vec3f surface_open(SurfaceTracer *tracer, const Ray *ray, double distance, const Leg *leg, double clear) {
    return open_way(tracer, ray, distance, leg, clear, false);
}

static Vec3f one_way(SurfaceTracer *tracer, const Light *light, const Ray *ray, double distance, const Leg *leg, double clear, double width) {
    const CompiledScene *compiled = tracer->compiled;
    if (!projections_let(compiled->projections, light, ray, distance, &distance)) return vec3f(0, 0, 0);
    if (light->shadowless) return vec3f(1, 1, 1);
    Vec3f through = open_way(tracer, ray, distance, leg, clear, light->through_air);
    if (light->through_air && compiled->scene->fog_count) through = vec3f_mul(through, air_fog_passing(compiled->scene, ray, distance));
    if (!tracer->passing || most_of(through) <= 0) return through;
    double aperture = compiled->shadow_aperture;
    Cone cone = {ray->origin, ray->direction, width * aperture, leg->cone.spread * aperture};
    return vec3f_scale(through, tracer->passing(tracer->skins, &cone, distance, vec3_negate(leg->cone.direction)));
}

/* Of a light with an area: a few places of it at first, and many where these do not agree. */
enum { FEW_PLACES = 2, MANY_PLACES = 4 };

static Vec3f mean_of_places(SurfaceTracer *tracer, const Light *light, const Leg *leg, Vec3 point, double clear, double width, int n,
                            uint64_t seed, bool *agreed) {
    Vec3f sum = {0, 0, 0}, first = {0, 0, 0};
    *agreed = true;
    double shift_u = random_unit(random_mix(seed)), shift_v = random_unit(random_mix(seed + 1));
    for (int i = 0; i < n * n; i++) {
        double u = (i % n + shift_u) / n, v = (i / n + shift_v) / n;
        LightRay way = light_ray_from(light, point, light_place(light, point, u, v));
        Ray ray = {point, way.direction};
        Vec3f one = one_way(tracer, light, &ray, way.distance, leg, clear, width);
        if (i == 0) first = one;
        else *agreed &= most_of(vec3f_sub(one, first)) < 0.01f && most_of(vec3f_sub(first, one)) < 0.01f;
        sum = vec3f_add(sum, one);
    }
    return vec3f_scale(sum, 1 / (float)(n * n));
}

Vec3f surface_shadow(SurfaceTracer *tracer, const Light *light, const LightRay *way, const Leg *leg, Vec3 point, double clear,
                     uint64_t seed) {
    if (light_comes_everywhere(light)) return vec3f(1, 1, 1);
    double width = cone_diameter(&leg->cone, vec3_length(vec3_sub(point, leg->cone.origin)));
    if (!light_is_area(light)) {
        Ray ray = {point, way->direction};
        return one_way(tracer, light, &ray, way->distance, leg, clear, width);
    }
    bool agreed;
    Vec3f mean = mean_of_places(tracer, light, leg, point, clear, width, FEW_PLACES, seed, &agreed);
    return agreed ? mean : mean_of_places(tracer, light, leg, point, clear, width, MANY_PLACES, seed + 2, &agreed);
}

Vec3f surface_shadow_way(SurfaceTracer *tracer, const Light *light, const LightRay *way, const Leg *leg, Vec3 point, double clear) {
    if (light_comes_everywhere(light)) return vec3f(1, 1, 1);
    Ray ray = {point, way->direction};
    double width = clear > 0 ? cone_diameter(&leg->cone, vec3_length(vec3_sub(point, leg->cone.origin))) : 0;
    return one_way(tracer, light, &ray, way->distance, leg, clear, width);
}
