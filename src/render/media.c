/* What media add to a line of sight and take from it: its integral by pieces, halved until halves and whole agree. */
#include "render/media.h"

#include "render/blockers.h"
#include "scene/medium.h"
#include "volume/phase.h"

/* Light comes from so many lamps whose share is carried from place to place; that of others is asked for everywhere. */
enum { KEPT_LAMPS = 8, MOST_HALVINGS = 18, MOST_PLACES = 1500, MOST_SHADOW_PLACES = 300 };
/* Of the error that a picture may have, what one piece may add; and of a reference. */
static const double SHARE = 0.4, EXACT_SHARE = 0.02;
/* What is behind so much is not seen. */
static const double OPAQUE_BELOW = 1e-4;
/* Without an end there is nothing beyond. */
static const double FAR = 2e10;

static Vec3 rgb(Color c) { return vec3(c.red, c.green, c.blue); }
static double most_of(Vec3 v) { return double_max(fabs(v.x), double_max(fabs(v.y), fabs(v.z))); }

/* ---- the rule ---- */

/* Integrals of 1, x, x² times exp(-d x) over [0, 1]. */
static void moments(double d, double m[3]) {
    if (fabs(d) < 0.3) {
        double term = 1;
        m[0] = m[1] = m[2] = 0;
        for (int j = 0; j < 12; j++) {
            for (int k = 0; k < 3; k++) m[k] += term / (j + k + 1);
            term *= -d / (j + 1);
        }
        return;
    }
    double e = exp(-d);
    m[0] = (1 - e) / d;
    m[1] = (m[0] - e) / d;
    m[2] = (2 * m[1] - e) / d;
}

/* The source at three places, dimmed by extinction: exact where extinction is even and the source a parabola. */
static double piece_of(double length, const double extinction[3], const double source[3], double *depth) {
    double m[3], whole = length * (extinction[0] + 4 * extinction[1] + extinction[2]) / 6;
    double half = length * (5 * extinction[0] + 8 * extinction[1] - extinction[2]) / 24;
    *depth = whole;
    if (source[0] == 0 && source[1] == 0 && source[2] == 0) return 0;
    if (extinction[0] == 0 && extinction[1] == 0 && extinction[2] == 0) return length * (source[0] + 4 * source[1] + source[2]) / 6;
    if (whole < -60) whole = -60; /* what amplifies light has limits */
    if (whole >= 0) half = double_clamp(half, 0, whole);
    double middle = source[1] * exp(double_clamp(whole / 2 - half, -60, 60));
    moments(whole, m);
    return length * (source[0] * (m[0] - 3 * m[1] + 2 * m[2]) + middle * 4 * (m[1] - m[2]) + source[2] * (2 * m[2] - m[1]));
}

/* ---- places ---- */

typedef struct Place {
    double t;
    Vec3 extinction, source;
    double amount;          /* of a lamp's light, what is turned into the ray for each unit of length */
    bool known;             /* light was asked for */
    Vec3 lamps[KEPT_LAMPS]; /* that arrives */
} Place;

/* Going along a line of sight. */
typedef struct Way {
    SurfaceTracer *tracer;
    const Leg *leg;
    const MediaMatter *matter;
    Ray ray;
    bool scatters, lit;  /* lit: some lamp may shine on it */
    double tolerance;
    int places_left;
    Vec3 through, sum;
} Way;

/* Light of the lamp that is turned into the ray's direction at t, for each unit that arrives. */
static Vec3 turned(const Way *way, const Vec3 *densities, Vec3 to_light) {
    Vec3 sum = {0, 0, 0};
    double mu = vec3_dot(to_light, way->ray.direction);
    for (int i = 0; i < way->matter->count; i++) {
        const Medium *m = way->matter->sites[i].medium;
        if (m->gain == 0 || (densities[i].x == 0 && densities[i].y == 0 && densities[i].z == 0)) continue;
        double amount = m->gain * 4 * VTS_PI * phase_value(&m->phase, mu);
        sum = vec3_madd(sum, vec3_mul(rgb(m->scattering), densities[i]), amount);
    }
    return sum;
}

static bool shines_on_media(const Light *light) { return !light->shadowless && !light->unscattered && light_shines_on(light, NULL); }

/* What a line of sight gets is the sum of many places, that of a surface one of them. */
static const double SLACK = 8;

static Vec3 lamp_at(const Way *way, const Light *light, const LightRay *ray, Vec3 point) {
    SurfaceTracer tracer = *way->tracer;
    if (!tracer.compiled->exact_paths) tracer.media_slack = SLACK;
    Vec3f share = surface_shadow(&tracer, light, ray, way->leg, point, 0, way->tracer->seed);
    return vec3_from_f(vec3f_mul(share, ray->color));
}

/* Adds what lamps make there. `between`: light of kept lamps is interpolated there already. */
static void shine_on(Way *way, const Vec3 *densities, bool between, Place *place) {
    const Scene *scene = way->tracer->compiled->scene;
    Vec3 point = vec3_madd(way->ray.origin, way->ray.direction, place->t);
    for (size_t i = 0, kept = 0; i < scene->light_count; i++) {
        const Light *light = &scene->lights[i];
        if (!shines_on_media(light)) continue;
        size_t k = kept++;
        LightRay ray = light_ray(light, point);
        Vec3 arrives = {0, 0, 0};
        if (between && k < KEPT_LAMPS) arrives = place->lamps[k];
        else if (ray.color.x != 0 || ray.color.y != 0 || ray.color.z != 0) arrives = lamp_at(way, light, &ray, point);
        if (k < KEPT_LAMPS) place->lamps[k] = arrives;
        Vec3 part = turned(way, densities, ray.direction);
        place->amount = double_max(place->amount, most_of(part));
        place->source = vec3_add(place->source, vec3_mul(part, arrives));
    }
}

static void see_place(Way *way, double t, bool between, Place *place) {
    Vec3 densities[MEDIA_MOST_SITES];
    bool any = false;
    place->t = t;
    place->amount = 0;
    place->extinction = place->source = vec3(0, 0, 0);
    for (int k = 0; k < KEPT_LAMPS && !between; k++) place->lamps[k] = vec3(0, 0, 0);
    way->places_left--;
    for (int i = 0; i < way->matter->count; i++) {
        const Medium *m = way->matter->sites[i].medium;
        Vec3 density = densities[i] = medium_density(&way->matter->sites[i], t);
        any |= density.x != 0 || density.y != 0 || density.z != 0;
        place->extinction = vec3_add(place->extinction, vec3_mul(vec3_madd(rgb(m->absorption), rgb(m->scattering), m->loss), density));
        place->source = vec3_add(place->source, vec3_mul(rgb(m->emission), density));
    }
    place->known = way->lit && any;
    if (place->known) shine_on(way, densities, between, place);
}

/* ---- pieces ---- */

static bool is_grey(Vec3 v) { return v.x == v.y && v.x == v.z; }
static bool place_is_grey(const Place *p) { return is_grey(p->extinction) && is_grey(p->source); }

static Vec3 integrate(const Place *a, const Place *m, const Place *b, Vec3 *depth) {
    double out[3], d[3];
    bool grey = place_is_grey(a) && place_is_grey(m) && place_is_grey(b);
    for (int c = 0; c < 3; c++) {
        if (c && grey) {
            out[c] = out[0], d[c] = d[0];
            continue;
        }
        const double extinction[3] = {vec3_get(a->extinction, c), vec3_get(m->extinction, c), vec3_get(b->extinction, c)};
        const double source[3] = {vec3_get(a->source, c), vec3_get(m->source, c), vec3_get(b->source, c)};
        out[c] = piece_of(b->t - a->t, extinction, source, &d[c]);
    }
    *depth = vec3(d[0], d[1], d[2]);
    return vec3(out[0], out[1], out[2]);
}

static Vec3 passing(Vec3 depth) {
    if (depth.x == 0 && depth.y == 0 && depth.z == 0) return vec3(1, 1, 1);
    if (is_grey(depth)) return vec3_splat(exp(-double_max(depth.x, -60)));
    return vec3(exp(-double_max(depth.x, -60)), exp(-double_max(depth.y, -60)), exp(-double_max(depth.z, -60)));
}

/* Values at the quarters, of a parabola through three. */
static void between_lamps(const Place *a, const Place *m, const Place *b, bool first, Place *out) {
    double l = first ? 0.375 : -0.125, r = first ? -0.125 : 0.375;
    for (int k = 0; k < KEPT_LAMPS; k++)
        out->lamps[k] = vec3_max(vec3(0, 0, 0), vec3_add(vec3_add(vec3_scale(a->lamps[k], l), vec3_scale(m->lamps[k], 0.75)), vec3_scale(b->lamps[k], r)));
}

/* Whether the light of lamps at a place is as the parabola has it: then none of those between is asked for. */
static bool lamps_agree(const Place *guess, const Place *found, double tolerance) {
    for (int k = 0; k < KEPT_LAMPS; k++)
        if (most_of(vec3_sub(guess->lamps[k], found->lamps[k])) > tolerance) return false;
    return true;
}

static void take(Way *way, Vec3 light, Vec3 depth) {
    way->sum = vec3_add(way->sum, vec3_mul(way->through, light));
    way->through = vec3_mul(way->through, passing(depth));
}

/* `smooth`: light of lamps changes as parabolas do. */
static void go(Way *way, const Place *a, const Place *m, const Place *b, bool smooth, int halvings) {
    Place left, right;
    Vec3 whole_depth, depth0, depth1;
    if (most_of(way->through) < OPAQUE_BELOW) return;
    if (smooth) between_lamps(a, m, b, true, &left), between_lamps(a, m, b, false, &right);
    see_place(way, (a->t + m->t) / 2, smooth, &left);
    see_place(way, (m->t + b->t) / 2, smooth, &right);
    Vec3 whole = integrate(a, m, b, &whole_depth);
    Vec3 first = integrate(a, &left, m, &depth0), second = integrate(m, &right, b, &depth1);
    Vec3 both = vec3_add(first, vec3_mul(passing(depth0), second)), depth = vec3_add(depth0, depth1);
    double worth = most_of(way->through);
    double off = most_of(vec3_sub(both, whole)), dimmed = most_of(vec3_sub(passing(depth), passing(whole_depth)));
    bool done = worth * double_max(off, dimmed) <= way->tolerance || halvings >= MOST_HALVINGS || way->places_left <= 0;
    if (done) {
        take(way, first, depth0);
        take(way, second, depth1);
        return;
    }
    if (!smooth && a->known && m->known && b->known && left.known && right.known) {
        Place guess0, guess1;
        between_lamps(a, m, b, true, &guess0), between_lamps(a, m, b, false, &guess1);
        double amount = double_max(m->amount, double_max(left.amount, right.amount));
        double enough = way->tolerance / double_max(worth * amount * (b->t - a->t), 1e-12);
        smooth = lamps_agree(&guess0, &left, enough) && lamps_agree(&guess1, &right, enough);
    }
    go(way, a, &left, m, smooth, halvings + 1);
    go(way, m, &right, b, smooth, halvings + 1);
}

/* ---- stops of lamps ---- */

enum { MOST_EXTRA = 72 };

static void add_extra(double *extra, int *count, double t) {
    if (*count < MOST_EXTRA && isfinite(t)) extra[(*count)++] = t;
}

/* Where the ray meets the cone of a spot's rim: roots of (p·a)² = c² p². */
static void meet_cone(const Light *light, const Ray *ray, double degrees, double *extra, int *count) {
    double cosine = cos(degrees * VTS_RADIANS), square = cosine * cosine;
    Vec3 p = vec3_sub(ray->origin, light->location), d = ray->direction;
    double pa = -vec3_dot(p, light->to_light), da = -vec3_dot(d, light->to_light);
    double a = da * da - square * vec3_dot(d, d), b = pa * da - square * vec3_dot(p, d), c = pa * pa - square * vec3_dot(p, p), root = b * b - a * c;
    if (root < 0 || a == 0) return;
    add_extra(extra, count, (-b - sqrt(root)) / a);
    add_extra(extra, count, (-b + sqrt(root)) / a);
}

static void meet_cylinder(const Light *light, const Ray *ray, double radius, double *extra, int *count) {
    Vec3 p = vec3_sub(ray->origin, light->location), d = ray->direction, axis = light->to_light;
    p = vec3_madd(p, axis, -vec3_dot(p, axis)), d = vec3_madd(d, axis, -vec3_dot(d, axis));
    double a = vec3_dot(d, d), b = vec3_dot(p, d), c = vec3_dot(p, p) - radius * radius, root = b * b - a * c;
    if (root < 0 || a == 0) return;
    add_extra(extra, count, (-b - sqrt(root)) / a);
    add_extra(extra, count, (-b + sqrt(root)) / a);
}

static void stop_for_light(const Light *light, const Ray *ray, double *extra, int *count) {
    if (light->kind == LIGHT_SPOT) meet_cone(light, ray, light->falloff, extra, count), meet_cone(light, ray, light->radius, extra, count);
    if (light->kind == LIGHT_CYLINDER) meet_cylinder(light, ray, light->falloff, extra, count);
    if (light_is_parallel(light)) return;
    Vec3 to = vec3_sub(light->location, ray->origin);
    double nearest = vec3_dot(to, ray->direction), away = vec3_length(vec3_madd(to, ray->direction, -nearest));
    add_extra(extra, count, nearest);
    add_extra(extra, count, nearest - away), add_extra(extra, count, nearest + away);
}

/* The hull of light that a lamp sends to the way between t0 and t1; false where its light is no even one. Parallel light comes from so far. */
static bool light_hull(const Way *way, const Light *light, double t0, double t1, double far, LightHull *hull) {
    const Vec3 ends[2] = {vec3_madd(way->ray.origin, way->ray.direction, t0), vec3_madd(way->ray.origin, way->ray.direction, t1)};
    if (light->goniometric || light->lamp || light->projected_through) return false;
    hull->points[0] = ends[0], hull->points[1] = ends[1];
    hull->count = 2;
    if (light_is_parallel(light))
        for (int i = 0; i < 2; i++) hull->points[hull->count++] = vec3_madd(ends[i], light->to_light, far);
    else hull->points[hull->count++] = light->location;
    if (!light_is_area(light)) return true;
    if (light_is_parallel(light)) return false;
    double side = 0.9 * (vec3_length(light->axis_u) + vec3_length(light->axis_v)); /* an octahedron around its area, however that is turned */
    hull->count = 2;
    for (int i = 0; i < 6; i++) {
        double along = i < 3 ? side : -side;
        hull->points[hull->count++] = vec3_add(light->location, vec3(i % 3 == 0 ? along : 0, i % 3 == 1 ? along : 0, i % 3 == 2 ? along : 0));
    }
    return true;
}

/* Whether a beam or a shadow may lie between two places of the way; of those that begin gently, one that is not so wide. */
static bool is_uneven(const Way *way, double t0, double t1, double fine) {
    const CompiledScene *compiled = way->tracer->compiled;
    const Scene *scene = compiled->scene;
    const Blockers *blockers = hierarchy_blockers(compiled->hierarchy);
    const Medium *media[MEDIA_MOST_SITES];
    LightHull hull = {.media = media, .media_count = way->matter->count, .fine = fine};
    if (!blockers || way->tracer->passing || (compiled->volumes && !way->tracer->no_volumes)) return true;
    for (int i = 0; i < way->matter->count; i++) media[i] = way->matter->sites[i].medium;
    for (size_t i = 0; i < scene->light_count; i++) {
        const Light *light = &scene->lights[i];
        if (!shines_on_media(light)) continue;
        if (!light_hull(way, light, t0, t1, FAR, &hull) || blockers_touch(blockers, &hull)) return true;
    }
    return false;
}

/* Cuts the way into so many pieces; beside those where light is even in both, it is not cut, but for a few. */
static void cut_lit_way(const Way *way, double t0, double t1, int pieces, double *extra, int *count) {
    enum { EVEN_PIECES = 2, EVEN_STEPS = 8 };
    const double fine = (t1 - t0) / EVEN_STEPS;
    bool some = is_uneven(way, t0, t1, fine), before = some && is_uneven(way, t0, t0 + (t1 - t0) / pieces, fine);
    for (int i = 1; i < pieces; i++) {
        double at = t0 + (t1 - t0) * i / pieces;
        bool after = some && is_uneven(way, at, t0 + (t1 - t0) * (i + 1) / pieces, fine);
        if (before || after || i % (pieces / EVEN_PIECES) == 0) add_extra(extra, count, at);
        before = after;
    }
}

static int find_extra(const Way *way, double t0, double t1, double *extra) {
    enum { LEAST_PIECES = 12, MOST_PIECES = 48, PLACES = 5, POWERS = 18 };
    const Scene *scene = way->tracer->compiled->scene;
    int count = 0;
    for (size_t i = 0; i < scene->light_count && way->scatters; i++)
        if (shines_on_media(&scene->lights[i])) stop_for_light(&scene->lights[i], &way->ray, extra, &count);
    double samples = 0;
    for (int i = 0; i < way->matter->count; i++) samples = double_max(samples, way->matter->sites[i].medium->samples);
    const bool exact = way->tracer->compiled->exact_paths;
    const int asked = (int)double_clamp(samples / PLACES, 1, MOST_PIECES), pieces = exact ? MOST_PIECES : int_max(asked, LEAST_PIECES);
    if (t1 < FAR && way->lit && !exact) cut_lit_way(way, t0, t1, pieces, extra, &count);
    else if (t1 < FAR)
        for (int i = 1; i < (way->lit ? pieces : asked); i++) add_extra(extra, &count, t0 + (t1 - t0) * i / (way->lit ? pieces : asked));
    double power = 1e-3;
    for (int i = 0; i < POWERS && t1 >= FAR; i++, power *= 6) add_extra(extra, &count, power);
    return count;
}

/* ---- a line of sight ---- */

static bool scatters(const MediaMatter *matter) {
    for (int i = 0; i < matter->count; i++) {
        const Medium *m = matter->sites[i].medium;
        if (m->gain != 0 && most_of(rgb(m->scattering)) > 0) return true;
    }
    return false;
}

static bool any_lamp(const Scene *scene) {
    for (size_t i = 0; i < scene->light_count; i++)
        if (shines_on_media(&scene->lights[i])) return true;
    return false;
}

static Vec3f to_floats(Vec3 v) {
    return vec3f((float)double_clamp(v.x, -1e30, 1e30), (float)double_clamp(v.y, -1e30, 1e30), (float)double_clamp(v.z, -1e30, 1e30));
}

/* Sums of floats are not known better. */
static const double LEAST_ERROR = 1e-6;

static double tolerance_of(const CompiledScene *compiled) {
    return double_max(compiled->max_error, LEAST_ERROR) * (compiled->exact_paths ? EXACT_SHARE : SHARE * compiled->budget.slack[BUDGET_MEDIA]);
}

static Air gather(SurfaceTracer *tracer, const Leg *leg, const MediaMatter *matter) {
    const CompiledScene *compiled = tracer->compiled;
    Air air = air_clear();
    if (!matter->count) return air;
    Way way = {.tracer = tracer, .leg = leg, .matter = matter, .ray = {leg->cone.origin, leg->cone.direction}, .places_left = MOST_PLACES,
               .through = {1, 1, 1}};
    way.tolerance = tolerance_of(compiled) / double_max(1e-3, (double)leg->weight);
    way.scatters = scatters(matter);
    way.lit = way.scatters && any_lamp(compiled->scene);
    double extra[MOST_EXTRA], stops[MEDIA_MOST_STOPS];
    int count = media_stops(matter, extra, find_extra(&way, matter->t0, matter->t1, extra), stops);
    if (count < 2) return air;
    Place a, m, b;
    see_place(&way, stops[0], false, &a);
    for (int i = 0; i + 1 < count && most_of(way.through) >= OPAQUE_BELOW; i++) {
        see_place(&way, (stops[i] + stops[i + 1]) / 2, false, &m);
        see_place(&way, stops[i + 1], false, &b);
        go(&way, &a, &m, &b, false, 0);
        a = b;
    }
    tracer->counters->places += (uint64_t)(MOST_PLACES - way.places_left);
    air = (Air){to_floats(way.through), to_floats(way.sum), 0};
    air.cover = float_clamp(1 - (air.keep.x + air.keep.y + air.keep.z) / 3, 0, 1);
    return air;
}

static double end_of(double t) { return t < FAR ? t : FAR; }

Air media_air(SurfaceTracer *tracer, const Leg *leg, double t_max) {
    const Scene *scene = tracer->compiled->scene;
    const Ray ray = {leg->cone.origin, leg->cone.direction};
    MediaMatter matter;
    if (!surface_in_air(leg->enclosures, leg->enclosure_count)) return air_clear();
    media_matter_begin(&matter, 0, end_of(t_max));
    for (int i = 0; i < leg->enclosure_count; i++) {
        const Enclosure *e = &leg->enclosures[i];
        if (e->interior && e->interior->media.count) media_matter_add(&matter, &e->interior->media, &e->to_interior, &ray);
    }
    Air air = gather(tracer, leg, &matter);
    if (!scene->media.count) return air;
    media_matter_begin(&matter, 0, end_of(t_max));
    media_matter_add(&matter, &scene->media, NULL, &ray);
    const Air over = gather(tracer, leg, &matter);
    return (Air){vec3f_mul(over.keep, air.keep), vec3f_add(over.add, vec3f_mul(over.keep, air.add)), 1 - (1 - over.cover) * (1 - air.cover)};
}

/* ---- light that passes ---- */

typedef struct Passing {
    const MediaMatter *matter;
    double tolerance;
    int places_left;
    Vec3 depth;
} Passing;

static void pass(Passing *p, double t0, double t2, Vec3 e0, Vec3 e1, Vec3 e2, int halvings) {
    double t1 = (t0 + t2) / 2, h = (t2 - t0) / 12;
    Vec3 left = media_extinction(p->matter, (t0 + t1) / 2), right = media_extinction(p->matter, (t1 + t2) / 2);
    Vec3 whole = vec3_scale(vec3_add(vec3_add(e0, vec3_scale(e1, 4)), e2), 2 * h);
    Vec3 depth0 = vec3_scale(vec3_add(vec3_add(e0, vec3_scale(left, 4)), e1), h), depth1 = vec3_scale(vec3_add(vec3_add(e1, vec3_scale(right, 4)), e2), h);
    Vec3 both = vec3_add(depth0, depth1);
    p->places_left -= 2;
    double off = most_of(vec3_sub(both, whole)) * most_of(passing(p->depth));
    if (off <= p->tolerance || halvings >= MOST_HALVINGS || p->places_left <= 0) {
        p->depth = vec3_add(p->depth, both);
        return;
    }
    pass(p, t0, t1, e0, left, e1, halvings + 1);
    pass(p, t1, t2, e1, right, e2, halvings + 1);
}

static bool is_even(const MediaMatter *matter) {
    for (int i = 0; i < matter->count; i++)
        if (matter->sites[i].stride < VTS_INFINITY || matter->sites[i].t0 != matter->t0 || matter->sites[i].t1 != matter->t1) return false;
    return true;
}

static Vec3f what_passes(const CompiledScene *compiled, MediaMatter *matter, double slack) {
    Passing p = {.matter = matter, .tolerance = tolerance_of(compiled), .places_left = MOST_SHADOW_PLACES};
    if (slack > 1) p.tolerance *= slack;
    for (int i = 0; i < matter->count && slack > 1; i++) matter->sites[i].stride *= sqrt(slack);
    double stops[MEDIA_MOST_STOPS];
    if (!matter->count) return vec3f(1, 1, 1);
    if (is_even(matter)) return to_floats(passing(vec3_scale(media_extinction(matter, matter->t0), matter->t1 - matter->t0)));
    int count = media_stops(matter, NULL, 0, stops);
    if (count < 2) return vec3f(1, 1, 1);
    Vec3 e0 = media_extinction(matter, stops[0]);
    for (int i = 0; i + 1 < count && most_of(passing(p.depth)) >= OPAQUE_BELOW; i++) {
        Vec3 e1 = media_extinction(matter, (stops[i] + stops[i + 1]) / 2), e2 = media_extinction(matter, stops[i + 1]);
        pass(&p, stops[i], stops[i + 1], e0, e1, e2, 0);
        e0 = e2;
    }
    return to_floats(passing(p.depth));
}

Vec3f media_passing(const CompiledScene *compiled, const Enclosure *enclosures, int count, const Ray *ray, double t0, double t1, double slack) {
    MediaMatter matter;
    if (!count || !surface_in_air(enclosures, count)) return vec3f(1, 1, 1);
    media_matter_begin(&matter, t0, end_of(t1));
    for (int i = 0; i < count; i++) {
        const Enclosure *e = &enclosures[i];
        if (e->interior && e->interior->media.count) media_matter_add(&matter, &e->interior->media, &e->to_interior, ray);
    }
    return what_passes(compiled, &matter, slack);
}

Vec3f media_air_passing(const CompiledScene *compiled, const Ray *ray, double distance, double slack) {
    MediaMatter matter;
    media_matter_begin(&matter, 0, end_of(distance));
    media_matter_add(&matter, &compiled->scene->media, NULL, ray);
    return what_passes(compiled, &matter, slack);
}
