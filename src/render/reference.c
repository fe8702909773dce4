#include "render/reference.h"

#include "base/random.h"
#include "render/exact_skin.h"
#include "render/surface.h"
#include "render/volume_set.h"

typedef struct Reference {
    const CompiledScene *compiled;
    const RenderOptions *options;
    TraceCounters *counters; /* one for each worker */
} Reference;

/* One ray at work. */
typedef struct Sample {
    const CompiledScene *compiled;
    Ray ray;
    double width, spread; /* of the pixel's cone: what is too small to matter */
    uint64_t random; /* of the directions that it asks */
    double part;     /* of all rays of the pixel */
    TraceCounters *counters;
    AovSum *aovs;    /* or NULL */
} Sample;

/* What a ray has met. */
typedef struct Facet {
    double t;
    Vec3 normal, flat; /* unit; `flat` that of the surface itself, for telling on which side of it a place lies */
    double bias;       /* shadows start so far beside it */
    Vec3 up;           /* its ambient light comes from the hemisphere about it; zero: from everywhere */
    const Look *look;
    Vec3f color;
    uint32_t object;   /* from 1; 0: matter of a skin */
    TexCoord uv;
} Facet;

/* So much of its pixel a ray stands for where patterns are averaged: nothing that anyone could see. */
static const double RAY_WIDTH = 1.0 / 128;
static Cone ray_cone(const Sample *s) { return (Cone){s->ray.origin, s->ray.direction, RAY_WIDTH * s->width, RAY_WIDTH * s->spread}; }

static Vec3 facet_point(const Sample *s, double t) { return vec3_madd(s->ray.origin, s->ray.direction, t); }

/* ---- what is met ---- */

static Facet surface_facet(const Sample *s, const SurfaceHit *hit) {
    const Cone cone = ray_cone(s);
    Facet facet = {.t = hit->t, .normal = hit->normal, .flat = hit->flat, .look = hit->look, .object = hit->number, .uv = hit->uv};
    surface_glance(&cone, hit, &facet.color, &facet.normal);
    return facet;
}

static Facet skin_facet(const Sample *s, const SkinHit *hit) {
    Vec3f color = vec3f_mul(look_color(hit->look, hit->place, hit->place_normal, 0), hit->tint);
    /* Where the mapping is singular nothing tells how matter is turned. */
    Vec3 flat = vec3_length_squared(hit->flat) > 0 ? hit->flat : vec3_negate(s->ray.direction);
    Vec3 normal = vec3_from_f(sheet_normal(vec3f_from(hit->normal), vec3f_from(flat), vec3f_from(vec3_negate(s->ray.direction))));
    return (Facet){.t = hit->t, .normal = normal, .flat = flat, .bias = hit->clearance, .up = hit->up, .look = hit->look, .color = color};
}

/* `surface` gets the explicit one, if facet->object says that it is one. */
static bool nearest_facet(const Sample *s, Facet *facet, SurfaceHit *surface) {
    SkinHit matter;
    bool found = hierarchy_intersect(s->compiled->hierarchy, &s->ray, 1e-9, VTS_INFINITY, surface);
    if (exact_skins_intersect(s->compiled->exact, &s->ray, 0, found ? surface->t : VTS_INFINITY, s->counters, &matter)) {
        *facet = skin_facet(s, &matter);
        return true;
    }
    if (found) *facet = surface_facet(s, surface);
    return found;
}

/* ---- light ---- */

/* From just beside the facet, on the side of the direction. */
static Ray leaving(const Sample *s, const Facet *facet, Vec3 direction) {
    double side = vec3_dot(direction, facet->flat) > 0 ? facet->bias : -facet->bias;
    return (Ray){vec3_madd(facet_point(s, facet->t), facet->flat, side), direction};
}

/* Whether the sky is seen in one direction of the hemisphere over the layer, each alike. */
static bool sky_lit(const Sample *s, const Facet *facet) {
    if (!s->compiled->scene->settings.sky_light || vec3_length_squared(facet->up) == 0) return true;
    Vec3 a, b;
    vec3_frame(facet->up, &a, &b);
    double height = random_unit(random_mix(s->random)), turn = 2 * VTS_PI * random_unit(random_mix(s->random + 1)), r = sqrt(1 - height * height);
    Vec3 d = vec3_madd(vec3_madd(vec3_scale(a, r * cos(turn)), b, r * sin(turn)), facet->up, height);
    Ray ray = leaving(s, facet, d);
    if (hierarchy_occluded(s->compiled->hierarchy, &ray, facet->bias, VTS_INFINITY)) return false;
    return !exact_skins_occluded(s->compiled->exact, &ray, 0, VTS_INFINITY, s->counters);
}

static Vec3f exact_matter(void *sample, const Cone *cone, double t_max, float *transmittance);

static float exact_passing(void *sample, const Cone *cone, double t_max, Vec3 to_eye) {
    (void)to_eye;
    const Sample *s = sample;
    const Ray ray = {cone->origin, cone->direction};
    return exact_skins_occluded(s->compiled->exact, &ray, 0, t_max, s->counters) ? 0 : 1;
}

static SurfaceTracer tracer_of(Sample *s) {
    SurfaceTracer tracer = {.compiled = s->compiled, .counters = s->counters, .seed = random_mix(s->random + 7), .part = s->part, .skins = s};
    if (s->compiled->skin_count) tracer.matter = exact_matter, tracer.passing = exact_passing, tracer.exact = true;
    return tracer;
}

/* The share of its light that comes to a facet. */
static Vec3f lit(const Sample *s, const Light *light, const LightRay *to_light, const Facet *facet) {
    Sample own = *s;
    SurfaceTracer tracer = tracer_of(&own);
    const Cone cone = ray_cone(s);
    Leg leg;
    surface_eye_leg(s->compiled, &cone, &leg);
    const Ray from = leaving(s, facet, to_light->direction);
    return surface_shadow(&tracer, light, to_light, &leg, from.origin, facet->bias, random_mix(s->random + 3));
}

static Vec3f shade(const Sample *s, const Facet *facet) {
    const Scene *scene = s->compiled->scene;
    Vec3 point = facet_point(s, facet->t);
    Vec3f view = vec3f_from(vec3_negate(s->ray.direction));
    Vec3f sum = vec3f_mul(facet->look->emission, facet->color);
    if (sky_lit(s, facet)) sum = vec3f_add(sum, vec3f_mul(facet->look->ambient, facet->color));
    for (size_t l = 0; l < scene->light_count; l++) {
        if (!light_shines_on(&scene->lights[l], facet->look->texture->group)) continue;
        LightRay ray = light_ray(&scene->lights[l], point);
        NdfShade amount = sheet_shade(vec3f_from(facet->normal), view, vec3f_from(ray.direction), &facet->look->sheet);
        if (amount.diffuse <= 0 && amount.highlight <= 0) continue;
        Vec3f tone = light_tone(&ray, &amount, facet->look, facet->color);
        sum = vec3f_add(sum, vec3f_mul(tone, lit(s, &scene->lights[l], &ray, facet)));
    }
    return sum;
}

static void tell(const Sample *s, const Facet *facet) {
    AovSample seen = {.share = 1, .depth = facet->t, .position = facet_point(s, facet->t), .normal = vec3f_from(facet->normal), .albedo = facet->color,
                      .u = (float)facet->uv.u, .v = (float)facet->uv.v, .object = facet->object, .level = -1};
    aov_add(s->aovs, &seen, 1);
}

/* Matter of skins alone, as mirrors and glass show it. */
static Vec3f exact_matter(void *sample, const Cone *cone, double t_max, float *transmittance) {
    Sample s = *(const Sample *)sample;
    SkinHit matter;
    s.ray = (Ray){cone->origin, cone->direction};
    s.width = cone->width, s.spread = cone->spread;
    s.random = random_mix(s.random + 11);
    *transmittance = 1;
    if (!exact_skins_intersect(s.compiled->exact, &s.ray, 0, t_max, s.counters, &matter)) return vec3f(0, 0, 0);
    *transmittance = 0;
    const Facet facet = skin_facet(&s, &matter);
    SurfaceTracer tracer = tracer_of(&s);
    Air air = air_from_eye(&tracer, cone, facet.t);
    return air_over(&air, shade(&s, &facet), 1);
}

static Radiance trace_sample(Sample *s) {
    const Scene *scene = s->compiled->scene;
    Facet facet = {.t = 0};
    SurfaceHit surface;
    Vec3f light;
    s->counters->camera_rays++;
    bool met = nearest_facet(s, &facet, &surface);
    if (s->aovs) s->aovs->samples++;
    if (s->aovs && met) tell(s, &facet);
    if (met && facet.object) {
        SurfaceTracer tracer = tracer_of(s);
        const Cone cone = ray_cone(s);
        Leg leg;
        surface_eye_leg(s->compiled, &cone, &leg);
        light = surface_radiance(&tracer, &leg, &surface);
    } else {
        light = met ? shade(s, &facet) : sky_radiance(scene, s->ray.direction, 0);
    }
    SurfaceTracer tracer = tracer_of(s);
    const Cone cone = ray_cone(s);
    Air air = air_from_eye(&tracer, &cone, met ? facet.t : VTS_INFINITY);
    return (Radiance){air_over(&air, light, 1), met ? 1 : air.cover};
}

/* ---- samples ---- */

/* Rows of equal height over the pixel's square, each cut into cells of equal width: `samples` cells in all, as square as
 * they come. */
typedef struct Strata {
    int rows, samples;
} Strata;

static Strata strata_of(int samples) { return (Strata){int_max(1, (int)floor(sqrt(samples))), samples}; }
static int strata_columns(const Strata *strata, int row) {
    return strata->samples / strata->rows + (row < strata->samples % strata->rows);
}

static Radiance see_pixel(const Reference *reference, int worker, int px, int py, AovSum *aovs) {
    const RenderOptions *options = reference->options;
    Strata strata = strata_of(int_max(1, options->samples));
    Radiance sum = {{0, 0, 0}, 0};
    uint64_t number = 0;
    for (int row = 0; row < strata.rows && !(options->interrupted && *options->interrupted); row++) {
        int columns = strata_columns(&strata, row);
        float share = 1 / ((float)strata.rows * (float)columns);
        for (int column = 0; column < columns; column++) {
            uint64_t bits = random_hash((uint64_t)px, (uint64_t)py, number++, options->seed);
            double x = (column + random_unit(bits)) / columns, y = (row + random_unit(random_mix(bits))) / strata.rows;
            double u = random_unit(random_mix(bits + 3)), v = random_unit(random_mix(bits + 4));
            Cone cone;
            if (!view_ray(&reference->compiled->view, px + x, py + y, u, v, 1, &cone)) continue;
            Sample sample = {reference->compiled, {cone.origin, cone.direction}, cone.width, cone.spread, random_mix(bits + 2), 1.0 / strata.samples,
                             &reference->counters[worker], aovs};
            Radiance seen = trace_sample(&sample);
            sum.color = vec3f_madd(sum.color, seen.color, share);
            sum.alpha += seen.alpha * share;
        }
    }
    return sum;
}

static void see_tile(void *context, int worker, int x0, int y0, int x1, int y1, Radiance *out, AovSum *aovs) {
    const Reference *reference = context;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) *out++ = see_pixel(reference, worker, x, y, aovs ? aovs++ : NULL);
}

Radiance reference_pixel(const CompiledScene *compiled, const RenderOptions *options, int x, int y, TraceCounters *counters) {
    return see_pixel(&(Reference){compiled, options, counters}, 0, x, y, NULL);
}

bool reference_picture(const CompiledScene *compiled, const RenderOptions *options, MemoryBudget *memory, Image *out,
                       RenderStats *stats, StrBuf *error) {
    ArenaMark mark = arena_mark(compiled->arena);
    int workers = pool_threads(options->pool);
    Reference reference = {compiled, options, arena_new_array(compiled->arena, TraceCounters, (size_t)workers)};
    SolidWork before = {0};
    hierarchy_work(compiled->hierarchy, &before);
    bool done = film_expose(options, compiled->scene->settings.assumed_gamma, "reference", see_tile, &reference, memory, out, error);
    *stats = (RenderStats){.error_estimate = -1};
    for (int i = 0; i < workers; i++) trace_counters_add(&stats->counters, &reference.counters[i]);
    stats->counters.functions = render_functions_since(compiled, &before);
    arena_reset_to(compiled->arena, mark);
    return done;
}
