#include "render/surface.h"

#include "base/random.h"
#include "pattern/pattern.h"
#include "render/footprint.h"
#include "render/radiosity.h"
#include "render/surface_parts.h"
#include "render/volume_set.h"

#include <string.h>

enum { MOST_LAYERS = 12, DEEPEST_LEGS = 256, MOST_STRAIGHT = 4096 };
/* Rays begin so far from their surface: some steps of the hierarchy's floats, and of doubles. */
static double clearance(const SurfaceTracer *tracer, Vec3 point, double t) {
    return hierarchy_coarseness(tracer->compiled->hierarchy, point) + 1e-12 * vec3_length(point) + 1e-9 * t;
}
/* Indices of refraction that differ by less leave a ray straight. */
static const double SAME_INDEX = 1e-6;
/* Light that would make less than this in the eye is taken as unshadowed. */
static const float SHADOW_WORTH = 1.0f / 2048;

static Vec3f follow(SurfaceTracer *tracer, Leg *leg, const SurfaceHit *first, bool lit_already);

/* Lights and what filters let through may be negative, and count no less. */
static float most_of(Vec3f c) { return float_max(fabsf(c.x), float_max(fabsf(c.y), fabsf(c.z))); }
static float grey_of(Vec3f c) { return 0.297f * c.x + 0.589f * c.y + 0.114f * c.z; }

/* Of the enclosures, which are many bytes, only those that count are ever set or copied. */
static void leg_copy(Leg *to, const Leg *from) {
    memcpy(to, from, offsetof(Leg, enclosures) + (size_t)from->enclosure_count * sizeof *from->enclosures);
}

void surface_leg(const Cone *cone, Leg *leg) {
    leg->cone = *cone;
    leg->clear = 1e-9;
    leg->purpose = RAY_SEES;
    leg->level = 0;
    leg->weight = 1;
    leg->wave = -1;
    leg->gathers = 0;
    leg->enclosure_count = 0;
}

/* A place where a leg has met a surface. */
typedef struct Meeting {
    const Leg *leg;
    const SurfaceHit *hit;
    Vec3 point;
    double clear;            /* how near to it nothing is met */
    uint64_t seed;
    const TexturePart *part; /* of its texture, that is being looked at */
    bool lit_already;        /* its own light and that of lights is taken care of elsewhere */
    SurfaceLayer layers[MOST_LAYERS];
    int layer_count;
    Vec3f faded;             /* what is left of light that came to the leg through the interior that it ends in */
    Vec3f through;           /* what all layers let through, faded */
    double curvature;        /* of the surface; NAN: not asked yet */
    SurfaceTint *tint;       /* gets what is found for each unit of colour; or NULL */
} Meeting;

/* What a surface makes of a leg: light, and the share with which the leg goes on straight (0: it ends). */
typedef struct Outcome {
    Vec3f light, straight;
} Outcome;

static Vec3f rgb_of(Color c) { return vec3f((float)c.red, (float)c.green, (float)c.blue); }

/* ---- the indices of refraction on both sides ---- */

static double index_of(const Leg *leg, const Interior *interior) {
    if (leg->wave < 0 || interior->dispersion == 1) return interior->ior;
    int samples = interior->dispersion_samples;
    return interior->ior * pow(interior->dispersion, (leg->wave + 0.5) / samples - 0.5);
}

static double outermost_but(const Leg *leg, int but) {
    for (int i = leg->enclosure_count - 1; i >= 0; i--)
        if (i != but && leg->enclosures[i].interior) return index_of(leg, leg->enclosures[i].interior);
    return 1;
}

/* Behind the surface over before it. */
static double index_ratio(const Leg *leg, const SurfaceHit *hit) {
    if (!hit->interior) return 1;
    int at = surface_enclosure(leg->enclosures, leg->enclosure_count, hit);
    double own = index_of(leg, hit->interior);
    return at < 0 ? own / outermost_but(leg, -1) : outermost_but(leg, at) / own;
}

/* ---- layers ---- */

static void read_layers(Meeting *m, double bumps, float bailout) {
    Vec3f above = {1, 1, 1};
    const SurfaceHit *hit = m->hit;
    m->layer_count = 0;
    for (const Texture *layer = m->part->texture; layer && m->layer_count < MOST_LAYERS; layer = layer->under) {
        SurfaceLayer *seen = &m->layers[m->layer_count++];
        Vec3 normal = texture_layer_normal(m->part, layer, hit->normal, bumps > 0 ? bumps : 1);
        Color c = texture_layer_color(m->part, layer, normal);
        *seen = (SurfaceLayer){layer->finish, normal, rgb_of(c), above, (float)(1 - c.filter - c.transmit), surface_film(layer->finish, m->point)};
        float filter = (float)c.filter, transmit = (float)c.transmit;
        above = vec3f_mul(above, vec3f(filter * seen->color.x + transmit, filter * seen->color.y + transmit, filter * seen->color.z + transmit));
        if (layer->finish->conserve_energy) {
            double cosine = fabs(vec3_dot(normal, m->leg->cone.direction));
            Vec3f mirrored = surface_reflectivity(layer->finish, seen->color, cosine, index_ratio(m->leg, hit));
            above = vec3f_mul(above, vec3f_sub(vec3f(1, 1, 1), mirrored));
        }
        if (fabsf(grey_of(above)) <= bailout) break;
    }
    m->through = fabsf(grey_of(above)) > bailout ? above : vec3f(0, 0, 0);
    bool inside = hit->interior && surface_enclosure(m->leg->enclosures, m->leg->enclosure_count, hit) >= 0;
    m->faded = inside ? surface_faded(hit->interior, hit->t) : vec3f(1, 1, 1);
    m->through = vec3f_mul(m->through, m->faded);
}

/* ---- light of its own and from lights ---- */

/* The share of ambient light that comes to the place; `worth`: the most that all of it makes. */
static Vec3f sky_seen(SurfaceTracer *tracer, const Meeting *m, float worth) {
    const SurfaceHit *hit = m->hit;
    double side = vec3_dot(hit->flat, m->leg->cone.direction) > 0 ? -1 : 1;
    Vec3 flat = vec3_scale(hit->flat, side), normal = vec3_dot(hit->normal, flat) < 0 ? vec3_negate(hit->normal) : hit->normal;
    const SkyPlace place = {vec3_madd(m->point, flat, m->clear), flat, normal, m->clear, m->leg, false};
    return surface_sky(tracer, &place, m->leg->weight * worth, m->seed ^ 0x736B79);
}

/* Of what comes from all directions over one side of the surface, what is sent to the eye: `share` for each unit of it. */
static Vec3f light_of_side(SurfaceTracer *tracer, const Meeting *m, bool behind, Vec3f share) {
    const Radiosity *radiosity = &tracer->compiled->scene->settings.radiosity;
    const SurfaceHit *hit = m->hit;
    float worth = m->leg->weight * (float)m->part->weight * most_of(share);
    if (!(worth > 0)) return vec3f(0, 0, 0);
    double side = (vec3_dot(hit->flat, m->leg->cone.direction) > 0) == behind ? 1 : -1;
    Vec3 flat = vec3_scale(hit->flat, side), normal = radiosity->bumps ? m->layers[0].normal : hit->normal;
    if (vec3_dot(normal, flat) < 0) normal = vec3_negate(normal);
    const RadiosityPlace place = {vec3_madd(m->point, flat, m->clear), flat, normal, m->clear, cone_diameter(&m->leg->cone, hit->t), hit->t, m->leg->gathers, worth};
    return vec3f_mul(share, radiosity_light(tracer, &place, m->seed));
}

/* Diffuse light of what comes from all sides; through leaves, of what comes from behind. */
static Vec3f light_sent(SurfaceTracer *tracer, const Meeting *m) {
    Vec3f before = {0, 0, 0}, behind = {0, 0, 0};
    if (m->tint) {
        const SurfaceLayer *layer = &m->layers[0];
        float front = (float)layer->finish->diffuse * layer->opaque, back = (float)layer->finish->transmission * layer->opaque;
        Vec3f lit = vec3f_add(light_of_side(tracer, m, false, vec3f(front, front, front)), light_of_side(tracer, m, true, vec3f(back, back, back)));
        m->tint->lit = vec3f_add(m->tint->lit, lit);
        return vec3f_mul(lit, layer->color);
    }
    for (int i = 0; i < m->layer_count; i++) {
        const SurfaceLayer *layer = &m->layers[i];
        Vec3f color = vec3f_scale(vec3f_mul(layer->color, layer->above), layer->opaque);
        before = vec3f_madd(before, color, (float)layer->finish->diffuse);
        behind = vec3f_madd(behind, color, (float)layer->finish->transmission);
    }
    return vec3f_add(light_of_side(tracer, m, false, before), light_of_side(tracer, m, true, behind));
}

static Vec3f own_light(SurfaceTracer *tracer, const Meeting *m) {
    const GlobalSettings *settings = &tracer->compiled->scene->settings;
    Vec3f ambient = {0, 0, 0}, glow = {0, 0, 0}, everywhere = rgb_of(settings->ambient_light);
    for (int i = 0; i < m->layer_count; i++) {
        const SurfaceLayer *layer = &m->layers[i];
        Vec3f back = vec3f_scale(vec3f_mul(layer->color, layer->above), layer->opaque);
        ambient = vec3f_add(ambient, vec3f_mul(vec3f_mul(rgb_of(layer->finish->ambient), everywhere), back));
        glow = vec3f_add(glow, vec3f_mul(rgb_of(layer->finish->emission), back));
    }
    if (radiosity_is_on(tracer)) {
        glow = vec3f_add(glow, light_sent(tracer, m));
        if (!settings->radiosity.with_ambient) ambient = everywhere = vec3f(0, 0, 0);
    }
    Vec3f share = {1, 1, 1};
    if (settings->sky_light) share = sky_seen(tracer, m, (float)m->part->weight * most_of(m->tint ? everywhere : ambient));
    if (m->tint) {
        const Finish *f = m->layers[0].finish;
        Vec3f lit = vec3f_add(vec3f_mul(vec3f_mul(rgb_of(f->ambient), everywhere), share), rgb_of(f->emission));
        m->tint->lit = vec3f_madd(m->tint->lit, lit, m->layers[0].opaque);
    }
    return vec3f_add(vec3f_mul(ambient, share), glow);
}

/* What all layers make of light that comes this way, unshadowed; `lit`: of each unit of the colour of the one layer that there is, where
 * that is wanted. */
static Vec3f lit_along(const SurfaceTracer *tracer, const Meeting *m, const LightRay *way, size_t number, Vec3f *lit) {
    Vec3f sum = {0, 0, 0};
    float diffuse = 0;
    *lit = sum;
    if (!(most_of(way->color) > 0)) return sum;
    for (int i = 0; i < m->layer_count; i++) {
        Vec3f one = surface_layer_light(&m->layers[i], m->leg->cone.direction, way, m->hit->both_sides,
                                        tracer->compiled->scene->settings.irid_wavelength, random_mix(m->seed + number), &diffuse);
        sum = vec3f_add(sum, one);
    }
    if (m->tint) *lit = vec3f_scale(way->color, diffuse);
    return vec3f_mul(sum, way->color);
}

static Vec3 off_surface(const Meeting *m, Vec3 direction) {
    double side = vec3_dot(direction, m->hit->flat) > 0 ? m->clear : -m->clear;
    return vec3_madd(m->point, m->hit->flat, side);
}

/* Of lights whose area counts in shading: as many places along each side as there are lights, and not more than so many. */
enum { MOST_SHADING_PLACES = 9 };

static Vec3f light_from_area(SurfaceTracer *tracer, const Meeting *m, const Light *light, size_t number) {
    Vec3f sum = {0, 0, 0};
    const int counts[2] = {int_min(light->size_u, MOST_SHADING_PLACES), int_min(light->size_v, MOST_SHADING_PLACES)};
    int count = counts[0] * counts[1];
    for (int k = 0; k < count; k++) {
        const int at[2] = {k % counts[0], k / counts[0]};
        LightRay way = light_ray_from(light, m->point, light_member(light, m->point, at, counts));
        Vec3f lit, passed = {1, 1, 1}, one = lit_along(tracer, m, &way, number, &lit);
        if (m->leg->weight * float_max(most_of(one), most_of(lit)) >= SHADOW_WORTH)
            passed = surface_shadow_way(tracer, light, &way, m->leg, off_surface(m, way.direction), m->clear);
        sum = vec3f_add(sum, vec3f_mul(one, passed));
        if (m->tint) m->tint->lit = vec3f_madd(m->tint->lit, vec3f_mul(lit, passed), 1 / (float)count);
    }
    return vec3f_scale(sum, 1 / (float)count);
}

static Vec3f light_from(SurfaceTracer *tracer, const Meeting *m, size_t number) {
    const Light *light = &tracer->compiled->scene->lights[number];
    if (!light_shines_on(light, m->hit->look->texture->group)) return vec3f(0, 0, 0);
    if (light->area_illumination && light_is_area(light)) return light_from_area(tracer, m, light, number);
    LightRay way = light_ray(light, m->point);
    Vec3f lit, passed = {1, 1, 1}, sum = lit_along(tracer, m, &way, number, &lit);
    if (m->leg->weight * float_max(most_of(sum), most_of(lit)) >= SHADOW_WORTH)
        passed = surface_shadow(tracer, light, &way, m->leg, off_surface(m, way.direction), m->clear, random_mix(m->seed ^ (number << 8)));
    if (m->tint) m->tint->lit = vec3f_add(m->tint->lit, vec3f_mul(lit, passed));
    return vec3f_mul(sum, passed);
}

/* ---- further legs ---- */

/* Bundles that were bent twice have lost their order: their width is as good as any. */
enum { CURVED_LEGS = 2 };

static double curvature_of(const SurfaceTracer *tracer, Meeting *m) {
    if (m->leg->level > CURVED_LEGS) return 0;
    if (isnan(m->curvature)) m->curvature = footprint_curvature(tracer->compiled->hierarchy, m->leg->purpose, &m->leg->cone, m->hit);
    return m->curvature;
}

static void leg_from(const SurfaceTracer *tracer, Meeting *m, Vec3 direction, double bend, float share, Leg *leg) {
    leg_copy(leg, m->leg);
    double side = vec3_dot(direction, m->hit->flat) > 0 ? m->clear : -m->clear;
    Vec3 from = vec3_madd(m->point, m->hit->flat, side);
    leg->cone = footprint_leave(&m->leg->cone, m->hit->t, from, direction, curvature_of(tracer, m), bend);
    leg->clear = m->clear;
    leg->weight *= share;
}

static Vec3f mirrored_light(SurfaceTracer *tracer, Meeting *m, Vec3 normal, float share) {
    Leg leg;
    leg_from(tracer, m, surface_mirrored(m->leg->cone.direction, normal, m->hit->flat), 2, share, &leg);
    leg.purpose = RAY_MIRRORS;
    return follow(tracer, &leg, NULL, false);
}

/* A thin layer colours what is mirrored as it does light: measured, POV-Ray's documentation tells of light alone. */
static Vec3f thin_mirror(const SurfaceTracer *tracer, const Meeting *m, const SurfaceLayer *layer) {
    Vec3 view = m->leg->cone.direction;
    return surface_thin_layer(layer, view, fabs(vec3_dot(layer->normal, view)), tracer->compiled->scene->settings.irid_wavelength);
}

static float power_of(float x, double exponent) { return x > 0 ? (float)pow((double)x, exponent) : 0; }

static Vec3f mirror(SurfaceTracer *tracer, Meeting *m, bool all_of_it) {
    Vec3f sum = {0, 0, 0};
    float bailout = (float)tracer->compiled->scene->settings.adc_bailout;
    for (int i = 0; i < m->layer_count; i++) {
        const SurfaceLayer *layer = &m->layers[i];
        const Finish *f = layer->finish;
        const Color *high = &f->reflection_max, *low = &f->reflection_min;
        if (high->red + high->green + high->blue == 0 && low->red + low->green + low->blue == 0) continue;
        /* Where glass has reflected all, the mirror would be a second one. */
        if (all_of_it && vec3_length_squared(vec3_sub(layer->normal, m->layers[0].normal)) < 1e-12) continue;
        double cosine = fabs(vec3_dot(layer->normal, m->leg->cone.direction));
        Vec3f share = surface_reflectivity(f, layer->color, cosine, index_ratio(m->leg, m->hit));
        share = vec3f_mul(share, layer->above);
        if (!(m->leg->weight * most_of(share) > bailout)) continue;
        Vec3f light = mirrored_light(tracer, m, layer->normal, most_of(share));
        double exponent = f->reflection_exponent > 0 ? 1 / f->reflection_exponent : 1;
        if (exponent != 1) light = vec3f(power_of(light.x, exponent), power_of(light.y, exponent), power_of(light.z, exponent));
        sum = vec3f_add(sum, vec3f_mul(vec3f_mul(light, thin_mirror(tracer, m, layer)), share));
    }
    return sum;
}

/* What comes bent through the surface, or all reflected: which POV-Ray does not filter by the surface's colour. */
static Vec3f bent_light(SurfaceTracer *tracer, Meeting *m, double ratio, bool *all_of_it) {
    Vec3 direction, normal = m->layers[0].normal;
    if (vec3_dot(normal, m->leg->cone.direction) > 0) normal = vec3_negate(normal);
    if (!surface_bent(m->leg->cone.direction, normal, 1 / ratio, &direction)) {
        *all_of_it = true;
        return vec3f_mul(vec3f_mul(m->faded, thin_mirror(tracer, m, &m->layers[0])), mirrored_light(tracer, m, normal, most_of(m->faded)));
    }
    double bend = vec3_dot(direction, normal) - vec3_dot(m->leg->cone.direction, normal) / ratio; /* n cos i - cos t */
    Leg leg;
    leg_from(tracer, m, direction, bend, most_of(m->through), &leg);
    surface_cross(tracer, leg.enclosures, &leg.enclosure_count, m->hit);
    return vec3f_mul(m->through, follow(tracer, &leg, NULL, false));
}

/* Light of one plain layer is a multiple of its colour, and white highlights. */
static bool is_tinted(const Texture *texture) {
    const Finish *f = texture->finish;
    return !texture->map && !texture->under && !texture->normal && f->irid == 0 && f->crand == 0 && f->metallic == 0;
}

static void tint_begin(Meeting *m) {
    if (!m->tint) return;
    *m->tint = (SurfaceTint){.color = m->layers[0].color};
    if (m->through.x == 0 && m->through.y == 0 && m->through.z == 0) m->tint->texture = m->part->texture;
    else m->tint = NULL;
}

static Outcome see_part(SurfaceTracer *tracer, Meeting *m) {
    const Scene *scene = tracer->compiled->scene;
    Outcome out = {{0, 0, 0}, {0, 0, 0}};
    bool all_of_it = false;
    read_layers(m, tracer->bumps, (float)scene->settings.adc_bailout);
    tint_begin(m);
    if (!m->lit_already) out.light = own_light(tracer, m);
    for (size_t l = 0; l < scene->light_count && !m->lit_already && !tracer->asks; l++) out.light = vec3f_add(out.light, light_from(tracer, m, l));
    if (m->through.x != 0 || m->through.y != 0 || m->through.z != 0) {
        double ratio = index_ratio(m->leg, m->hit);
        if (fabs(ratio - 1) < SAME_INDEX) out.straight = m->through;
        else out.light = vec3f_add(out.light, bent_light(tracer, m, ratio, &all_of_it));
    }
    out.light = vec3f_add(out.light, mirror(tracer, m, all_of_it));
    return out;
}

static void set_place(const Leg *leg, const SurfaceHit *hit, SurfacePlace *place) {
    double facing = double_max(0.05, fabs(vec3_dot(hit->normal, leg->cone.direction)));
    *place = (SurfacePlace){.point = cone_point(&leg->cone, hit->t), .normal = hit->normal, .space = &hit->space,
                            .footprint = cone_diameter(&leg->cone, hit->t) / facing,
                            .surface = {.direction = leg->cone.direction, .uv = {hit->uv.u, hit->uv.v}}};
    footprint_axes(&leg->cone, hit->t, hit->normal, place->axes);
}

static void looks_of(const Leg *leg, const SurfaceHit *hit, SurfaceParts *looks) {
    if (surface_parts_ask_place(hit)) set_place(leg, hit, &looks->places[0]);
    surface_parts_find(hit, looks);
}

static Outcome see_surface(SurfaceTracer *tracer, const Leg *leg, const SurfaceHit *hit, bool lit_already) {
    SurfaceParts looks;
    looks_of(leg, hit, &looks);
    Meeting m; /* its layers are many bytes, and are set where they are read */
    m.leg = leg;
    m.hit = hit;
    m.point = cone_point(&leg->cone, hit->t);
    m.clear = clearance(tracer, m.point, hit->t);
    m.seed = random_mix(tracer->seed + (uint64_t)leg->level);
    m.lit_already = lit_already;
    m.curvature = (double)NAN;
    m.tint = NULL;
    if (tracer->tint && looks.count == 1 && hit->look->plain && is_tinted(looks.parts[0].texture)) m.tint = tracer->tint;
    tracer->tint = NULL;
    Outcome out = {{0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < looks.count; i++) {
        m.part = &looks.parts[i];
        Outcome one = see_part(tracer, &m);
        out.light = vec3f_madd(out.light, one.light, (float)m.part->weight);
        out.straight = vec3f_madd(out.straight, one.straight, (float)m.part->weight);
    }
    return out;
}

void surface_glance(const Cone *cone, const SurfaceHit *hit, Vec3f *color, Vec3 *normal) {
    Leg leg;
    SurfaceParts looks;
    Meeting m;
    surface_leg(cone, &leg);
    looks_of(&leg, hit, &looks);
    m.leg = &leg;
    m.hit = hit;
    m.point = cone_point(cone, hit->t);
    m.tint = NULL;
    double heaviest = 0;
    *color = vec3f(0, 0, 0);
    for (size_t i = 0; i < looks.count; i++) {
        m.part = &looks.parts[i];
        read_layers(&m, 1, 0);
        for (int k = 0; k < m.layer_count; k++)
            *color = vec3f_madd(*color, vec3f_mul(m.layers[k].color, m.layers[k].above), m.layers[k].opaque * (float)m.part->weight);
        if (!(m.part->weight > heaviest)) continue;
        heaviest = m.part->weight;
        *normal = m.layers[0].normal;
    }
}

void surface_tint(const Cone *cone, const SurfaceHit *hit, SurfaceTint *out) {
    Leg leg;
    SurfaceParts looks;
    *out = (SurfaceTint){.texture = NULL};
    if (!hit->look->plain) return;
    leg.cone = *cone;
    looks_of(&leg, hit, &looks);
    const TexturePart *part = &looks.parts[0];
    if (looks.count != 1 || !is_tinted(part->texture)) return;
    Color c = texture_layer_color(part, part->texture, hit->normal);
    *out = (SurfaceTint){.texture = part->texture, .color = rgb_of(c)};
}

/* ---- legs ---- */

/* What is seen along the leg up to t, before `behind` shows: adds it and dims that. False when nothing more is seen. */
static bool gather_before(SurfaceTracer *tracer, const Leg *leg, double t, Vec3f *sum, Vec3f *through) {
    if (leg->gathers && !tracer->compiled->scene->settings.radiosity.media) return true;
    if (tracer->matter) {
        float transmittance = 1;
        Vec3f matter = tracer->matter(tracer->skins, &leg->cone, t, &transmittance);
        *sum = vec3f_add(*sum, vec3f_mul(matter, *through));
        *through = vec3f_scale(*through, transmittance);
        if (transmittance <= 0) return false;
    }
    Air air = air_along(tracer, leg, t);
    *sum = vec3f_add(*sum, vec3f_mul(*through, air.add));
    *through = vec3f_mul(*through, air.keep);
    return true;
}

/* Light along the leg and on straight through what is clear. `first` was met already, and what is before it taken care of; and its light,
 * with lit_already. */
static Vec3f follow(SurfaceTracer *tracer, Leg *leg, const SurfaceHit *first, bool lit_already) {
    const CompiledScene *compiled = tracer->compiled;
    const GlobalSettings *settings = &compiled->scene->settings;
    Vec3f sum = {0, 0, 0}, through = {1, 1, 1};
    int deepest = int_min(settings->max_trace_level, DEEPEST_LEGS);
    SurfaceHit met;
    for (int i = 0; i < MOST_STRAIGHT; i++) {
        const SurfaceHit *hit = first;
        if (!first) {
            hit = &met;
            if (leg->level >= deepest || leg->weight < (float)settings->adc_bailout) return sum;
            const Ray ray = {leg->cone.origin, leg->cone.direction};
            bool found = hierarchy_meet_wide(compiled->hierarchy, leg->purpose, &ray, cone_width(&leg->cone), leg->clear, VTS_INFINITY, false, &met);
            tracer->counters->camera_rays++;
            if (i == 0) leg->level++; /* but where it goes on straight */
            if (!gather_before(tracer, leg, found ? met.t : VTS_INFINITY, &sum, &through)) return sum;
            if (!found) return vec3f_add(sum, vec3f_mul(through, sky_radiance(compiled->scene, ray.direction, leg->cone.spread)));
        }
        Outcome seen = see_surface(tracer, leg, hit, first && lit_already);
        first = NULL;
        sum = vec3f_add(sum, vec3f_mul(through, seen.light));
        if (seen.straight.x == 0 && seen.straight.y == 0 && seen.straight.z == 0) return sum;
        through = vec3f_mul(through, seen.straight);
        Vec3 point = cone_point(&leg->cone, hit->t);
        leg->clear = clearance(tracer, point, hit->t);
        leg->cone = (Cone){point, leg->cone.direction, cone_diameter(&leg->cone, hit->t), leg->cone.spread};
        leg->weight *= most_of(seen.straight);
        surface_cross(tracer, leg->enclosures, &leg->enclosure_count, hit);
    }
    return sum;
}

Vec3f surface_radiance(SurfaceTracer *tracer, const Leg *first, const SurfaceHit *hit) {
    Leg leg;
    leg_copy(&leg, first);
    leg.level = 1;
    return follow(tracer, &leg, hit, false);
}

Vec3f surface_beyond(SurfaceTracer *tracer, const Leg *first, const SurfaceHit *hit) {
    Leg leg;
    leg_copy(&leg, first);
    leg.level = 1;
    return follow(tracer, &leg, hit, true);
}
