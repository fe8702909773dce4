/* Paths of light through volumes from the eye on: free paths by the exact integral of density, light asked at each place of scattering. */
#include "base/random.h"
#include "render/volume_set.h"

/* Paths end by lot where little is left of them, and for good after so many turns. */
enum { MOST_TURNS = 200000 };
static const double ROULETTE_BELOW = 0.1;

static double most_of(const double w[3]) { return double_max(w[0], double_max(w[1], w[2])); }

static int choose_channel(RandomStream *random, const double weight[3], double share[3]) {
    double sum = weight[0] + weight[1] + weight[2], u = random_next_unit(random);
    for (int c = 0; c < 3; c++) share[c] = weight[c] / sum;
    return u < share[0] ? 0 : u < share[0] + share[1] ? 1 : 2;
}

static bool is_grey(const CompiledVolume *v) { return v->extinction[0] == v->extinction[1] && v->extinction[1] == v->extinction[2]; }

/* Free paths of one colour through each volume by itself: the shortest is that through all. The weights are those of drawing the colour by lot. */
bool volume_collide(const VolumeSet *set, RandomStream *random, double weight[3], const Ray *ray, double t_max, RayPurpose purpose, Collision *out) {
    double share[3], depth[3] = {0, 0, 0}, chance = 0, t;
    int channel = choose_channel(random, weight, share);
    *out = (Collision){NULL, t_max};
    for (size_t i = 0; i < set->count; i++) {
        const CompiledVolume *v = &set->items[i];
        double target = -log1p(-random_next_unit(random)) / v->extinction[channel];
        if (volume_counts(v, purpose) && isfinite(target) && volume_reach(v, ray, 0, out->t, target, &t)) *out = (Collision){v, t};
    }
    for (size_t i = 0; i < set->count; i++) {
        const CompiledVolume *v = &set->items[i];
        if (!volume_counts(v, purpose) || is_grey(v)) continue; /* would cancel */
        double length = volume_length(v, ray, 0, out->t);
        for (int c = 0; c < 3; c++) depth[c] += v->extinction[c] * length;
    }
    double least = double_min(depth[0], double_min(depth[1], depth[2]));
    const double one[3] = {1, 1, 1}, *hit = out->volume ? out->volume->extinction : one, *kept = out->volume ? out->volume->scattering : one;
    for (int c = 0; c < 3; c++) chance += share[c] * hit[c] * exp(least - depth[c]);
    for (int c = 0; c < 3; c++) weight[c] *= kept[c] * exp(least - depth[c]) / chance;
    return out->volume != NULL;
}

bool volume_survives(RandomStream *random, double weight[3], double whole) {
    double most = most_of(weight);
    if (!(most > 0)) return false;
    if (most >= ROULETTE_BELOW * whole) return true;
    double chance = most / (ROULETTE_BELOW * whole);
    if (random_next_unit(random) >= chance) return false;
    for (int c = 0; c < 3; c++) weight[c] /= chance;
    return true;
}

double volume_clear_way(const CompiledScene *compiled, const Ray *ray, bool *met) {
    SurfaceHit hit;
    const Hierarchy *hierarchy = compiled->hierarchy;
    *met = hierarchy_object_count(hierarchy) && hierarchy_glimpse(hierarchy, RAY_SHADOWS, ray, 0, VTS_INFINITY, &hit);
    return *met ? hit.t : VTS_INFINITY;
}

Vec3f volume_lit(SurfaceTracer *tracer, const Light *light, const LightRay *way, Vec3 point) {
    const Ray ray = {point, way->direction};
    Leg leg;
    surface_leg(&(Cone){point, way->direction, 0, 0}, &leg);
    SurfaceTracer past = *tracer;
    past.no_volumes = true;
    Vec3f share = surface_shadow_way(&past, light, way, &leg, point, 0);
    if (light->shadowless || (share.x <= 0 && share.y <= 0 && share.z <= 0)) return share;
    return vec3f_mul(share, volumes_passing(tracer->compiled->volumes, &ray, 0, way->distance, RAY_MIRRORS));
}

typedef struct Path {
    SurfaceTracer *tracer;
    RandomStream random;
    double weight[3];
    Vec3f sum;
} Path;

static void add(Path *p, Vec3f light) {
    p->sum = vec3f_add(p->sum, vec3f_mul(light, vec3f((float)p->weight[0], (float)p->weight[1], (float)p->weight[2])));
}

static void add_light(Path *p, const Collision *at, Vec3 point, Vec3 direction) {
    const Scene *scene = p->tracer->compiled->scene;
    for (size_t l = 0; l < scene->light_count; l++) {
        const Light *light = &scene->lights[l];
        if (!light_shines_on(light, NULL)) continue;
        LightRay way = light_ray(light, point);
        if (light_is_area(light)) {
            double u = random_next_unit(&p->random), v = random_next_unit(&p->random);
            way = light_ray_from(light, point, light_place(light, point, u, v));
        }
        double shine = VOLUME_IRRADIANCE * phase_value(&at->volume->phase, vec3_dot(way.direction, direction));
        Vec3f color = vec3f_scale(way.color, (float)shine);
        if (color.x != 0 || color.y != 0 || color.z != 0) add(p, vec3f_mul(color, volume_lit(p->tracer, light, &way, point)));
    }
}

Vec3f volumes_path(SurfaceTracer *tracer, const Ray *first, double t_max, uint64_t seed) {
    const CompiledScene *compiled = tracer->compiled;
    const VolumeSet *set = compiled->volumes;
    Path p = {.tracer = tracer, .random = {seed}, .weight = {1, 1, 1}};
    Ray ray = *first;
    bool met = true;
    int most = set->orders ? int_min(set->orders, MOST_TURNS) : MOST_TURNS;
    for (int order = 0;; order++) {
        Collision at;
        if (!volume_collide(set, &p.random, p.weight, &ray, t_max, order == 0 ? RAY_SEES : RAY_MIRRORS, &at)) {
            if (order > 0 && !met && set->sky) add(&p, sky_radiance(compiled->scene, ray.direction, 0));
            return p.sum;
        }
        if (order == most || !volume_survives(&p.random, p.weight, 1)) return p.sum;
        Vec3 point = vec3_madd(ray.origin, ray.direction, at.t);
        add_light(&p, &at, point, ray.direction);
        double mu = phase_draw(&at.volume->phase, random_next_unit(&p.random), random_next_unit(&p.random));
        ray = (Ray){point, phase_turn(ray.direction, mu, random_next_unit(&p.random))};
        t_max = volume_clear_way(compiled, &ray, &met);
    }
}
