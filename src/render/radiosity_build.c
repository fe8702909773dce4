/* Which places light is gathered at: what a net of lines of sight meets, a finer one where those before it have left gaps. */
#include "base/random.h"
#include "render/radiosity.h"

#include <string.h>

enum {
    COARSEST = 16,
    FINEST = 2,   /* pixels between lines of sight */
    ASKED = 4,    /* places of one line of sight, in mirrors and glass */
    CHUNK = 4096, /* lines of sight at a time */
    MOST_SEEN = 200000,
    MOST_OTHERS = 4000,
    ROUNDS = 4 /* of bounces among others; later ones add little */
};
/* Directions for what the eye sees, for what that sees, and those in which the latter are looked for. */
static const RadiosityNet SEEN = {9, 28}, OTHERS = {5, 14}, SEARCH = {3, 10};
/* Light is taken as known within this part of the mean distance of what it comes from, for max_error of 1/128; */
static const double REACH = 0.28;
/* and of what sees others within this part of the way from there. */
static const double OTHERS_REACH = 0.35;
/* Balls have at least so many pixels of radius, and at most. */
static const double LEAST_PIXELS = 2, MOST_PIXELS = 20;
/* A finer net is laid while so much of the last one fell into gaps. */
static const double GAPS = 0.01;

typedef struct Builder {
    CompiledScene *compiled;
    RadiosityKept *kept;
    TraceCounters *counters; /* of the workers */
    /* lines of sight */
    int step, columns, first, count;
    RadiosityPlace (*asked)[ASKED];
    int *asked_count;
    /* places that light is to be gathered at */
    RadiosityPlace *places;
    size_t place_count, place_room;
    /* what was gathered there */
    RadiosityEntry *entries;
    size_t begin;
    RadiosityNet net;
    double reach;
    /* while entries limit each other */
    const BoxTree *tree;
    double *limits;
} Builder;

static SurfaceTracer tracer_of(Builder *b, int worker, uint64_t seed) {
    return (SurfaceTracer){.compiled = b->compiled, .counters = &b->counters[worker], .seed = seed};
}

static void add_place(Builder *b, const RadiosityPlace *place) {
    if (b->place_count == b->place_room) {
        RadiosityPlace *more = arena_new_array(b->compiled->arena, RadiosityPlace, 2 * b->place_room + 256);
        if (b->place_count) memcpy(more, b->places, b->place_count * sizeof *more);
        b->places = more, b->place_room = 2 * b->place_room + 256;
    }
    b->places[b->place_count++] = *place;
}

/* ---- what lines of sight meet ---- */

static bool is_stopped(const Builder *b) {
    const atomic_bool *interrupted = b->compiled->options->interrupted;
    return interrupted && *interrupted;
}

static void ask_sight(void *context, size_t index, int worker) {
    Builder *b = context;
    const CompiledScene *compiled = b->compiled;
    size_t pixel = (size_t)b->first + index;
    double x = ((double)(pixel % (size_t)b->columns) + 0.5) * b->step,
           y = ((double)(pixel / (size_t)b->columns) + 0.5) * b->step;
    Cone cone = view_cone(&compiled->view, x, y, 1);
    RadiosityAsk ask = {b->asked[index], 0, ASKED};
    SurfaceHit hit;
    b->asked_count[index] = 0;
    if (is_stopped(b)) return;
    if (vec3_length_squared(cone.direction) == 0) return;
    const Ray ray = {cone.origin, cone.direction};
    if (!hierarchy_meet_wide(compiled->hierarchy, RAY_SEES, &ray, cone_width(&cone), 1e-9, VTS_INFINITY,
                             false, &hit))
        return;
    SurfaceTracer tracer = tracer_of(b, worker, random_hash(pixel, (uint64_t)b->step, 1, 2));
    tracer.asks = &ask;
    Leg leg;
    surface_eye_leg(compiled, &cone, &leg);
    surface_radiance(&tracer, &leg, &hit);
    int kept = 0;
    for (int i = 0; i < ask.count; i++) {
        Vec3f light;
        if (ask.places[i].worth < 1.0f / 256 ||
            radiosity_blend(&b->kept->seen, ask.places[i].point, ask.places[i].normal, 0.8 / RADIOSITY_REACH,
                            &light) > 0)
            continue;
        ask.places[kept++] = ask.places[i];
    }
    b->asked_count[index] = kept;
}

/* The places of a net that nothing is known of; returns how many lines of sight the net has. */
static size_t ask_net(Builder *b) {
    const View *view = &b->compiled->view;
    b->columns = (view->width + b->step - 1) / b->step;
    size_t all = (size_t)b->columns * (size_t)((view->height + b->step - 1) / b->step);
    b->place_count = 0;
    for (size_t first = 0; first < all; first += CHUNK) {
        size_t count = all - first < CHUNK ? all - first : CHUNK;
        b->first = (int)first;
        pool_run(b->compiled->options->pool, count, ask_sight, b);
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < b->asked_count[i]; k++) add_place(b, &b->asked[i][k]);
    }
    return all;
}

/* ---- gathering at places ---- */

static void gather_at(void *context, size_t index, int worker) {
    Builder *b = context;
    if (is_stopped(b)) return;
    const RadiosityPlace *place = &b->places[index];
    SurfaceTracer tracer = tracer_of(b, worker, random_hash(index, b->begin, 3, (uint64_t)place->gathers));
    RadiosityEntry *entry = &b->entries[b->begin + index];
    radiosity_gather(&tracer, place, b->net, random_hash(b->begin + index, 5, 7, (uint64_t)place->gathers),
                     entry);
    double width = fmax(place->width, 1e-12);
    for (int c = 0; c < 3; c++) {
        double steepest = vec3_length(entry->moving[c]);
        if (steepest * entry->radius > (double)entry->light[c])
            entry->radius = (double)entry->light[c] / steepest;
    }
    entry->radius = place->gathers
                        ? OTHERS_REACH * place->distance
                        : double_clamp(b->reach * entry->radius, LEAST_PIXELS * width, MOST_PIXELS * width);
}

static const BoxTree *tree_over(const RadiosityEntry *entries, size_t count, double reach, Arena *arena) {
    Box3 *boxes = arena_new_array(arena, Box3, count + 1);
    for (size_t i = 0; i < count; i++) {
        Vec3 radius = vec3_splat(reach * entries[i].radius);
        boxes[i] = (Box3){vec3_sub(entries[i].point, radius), vec3_add(entries[i].point, radius)};
    }
    return count ? box_tree_build(boxes, count, arena) : NULL;
}

/* What limits one entry limits its neighbours: r <= r' + reach d (Krivanek, Bouatouch, Pattanaik & Zara 2006). */
typedef struct Limit {
    const Builder *builder;
    const RadiosityEntry *entry;
    double radius;
} Limit;

static bool limit_by(void *context, uint32_t item) {
    Limit *l = context;
    const RadiosityEntry *other = &l->builder->entries[item];
    if (vec3_dot(other->normal, l->entry->normal) < 0.5) return false;
    l->radius = fmin(l->radius, other->radius + l->builder->reach * vec3_length(vec3_sub(other->point, l->entry->point)));
    return false;
}

static void limit_entry(void *context, size_t index, int worker) {
    Builder *b = context;
    if (is_stopped(b)) return;
    const RadiosityEntry *entry = &b->entries[index];
    Limit l = {b, entry, entry->radius};
    Vec3 far = vec3_splat(entry->radius / b->reach);
    const Box3 box = {vec3_sub(entry->point, far), vec3_add(entry->point, far)};
    (void)worker;
    box_tree_touch(b->tree, &box, limit_by, &l);
    b->limits[index] = l.radius;
}

static void limit_all(Builder *b, size_t count) {
    b->limits = arena_new_array(b->compiled->arena, double, count + 1);
    b->tree = tree_over(b->entries, count, 0, b->compiled->arena);
    if (!b->tree) return;
    pool_run(b->compiled->options->pool, count, limit_entry, b);
    for (size_t i = 0; i < count; i++) b->entries[i].radius = b->limits[i];
}

/* Adds what is gathered at the places to `entries`, whose room is `most`. */
static void gather_all(Builder *b, RadiosityEntries *to, size_t most) {
    if (b->place_count > most - to->count) b->place_count = most - to->count;
    RadiosityEntry *entries =
        arena_new_array(b->compiled->arena, RadiosityEntry, to->count + b->place_count + 1);
    if (to->count) memcpy(entries, to->items, to->count * sizeof *entries);
    b->entries = entries, b->begin = to->count;
    pool_run(b->compiled->options->pool, b->place_count, gather_at, b);
    if (to == &b->kept->seen) limit_all(b, to->count + b->place_count);
    *to = (RadiosityEntries){entries, to->count + b->place_count, to->reach, NULL};
    to->tree = tree_over(entries, to->count, to->reach, b->compiled->arena);
}

/* ---- what those places see ---- */

typedef struct Search {
    Builder *builder;
    RadiosityPlace *found; /* SEARCH of them for each place */
    int *count;
} Search;

static void search_from(void *context, size_t index, int worker) {
    Search *s = context;
    s->count[index] = 0;
    if (is_stopped(s->builder)) return;
    int most = SEARCH.rows * SEARCH.columns;
    RadiosityAsk ask = {s->found + index * (size_t)most, 0, most};
    SurfaceTracer tracer = tracer_of(s->builder, worker, random_hash(index, 11, 13, 17));
    RadiosityEntry ignored;
    tracer.asks = &ask;
    radiosity_gather(&tracer, &s->builder->places[index], SEARCH, random_hash(index, 19, 23, 29), &ignored);
    s->count[index] = ask.count;
}

/* Whether another that sees as finely lies at it already. */
static bool has_near(const Builder *b, const RadiosityPlace *place) {
    for (size_t i = 0; i < b->place_count; i++) {
        const RadiosityPlace *other = &b->places[i];
        double reach = OTHERS_REACH * fmin(place->distance, other->distance);
        if (vec3_dot(place->normal, other->normal) > 0.8 &&
            vec3_length_squared(vec3_sub(place->point, other->point)) < reach * reach)
            return true;
    }
    return false;
}

/* Replaces the places by those that they see, as far as these lie apart. */
static void find_others(Builder *b) {
    size_t most = (size_t)(SEARCH.rows * SEARCH.columns), from = b->place_count;
    Search s = {b, arena_new_array(b->compiled->arena, RadiosityPlace, from * most + 1),
                arena_new_array(b->compiled->arena, int, from + 1)};
    pool_run(b->compiled->options->pool, from, search_from, &s);
    b->place_count = b->place_room = 0;
    for (size_t i = 0; i < from; i++)
        for (int k = 0; k < s.count[i] && b->place_count < MOST_OTHERS; k++)
            if (!has_near(b, &s.found[i * most + (size_t)k])) add_place(b, &s.found[i * most + (size_t)k]);
}

/* Of the light of bounces behind the first: each round gathers what the last one has left. */
static void build_others(Builder *b) {
    int rounds = int_min(b->compiled->scene->settings.radiosity.bounces - 1, ROUNDS);
    b->step = COARSEST;
    ask_net(b);
    find_others(b);
    b->net = OTHERS;
    for (int round = 0; round < rounds; round++) {
        RadiosityEntries next = {.reach = RADIOSITY_REACH};
        gather_all(b, &next, MOST_OTHERS);
        b->kept->others = next;
    }
}

static void build_seen(Builder *b) {
    b->net = SEEN;
    for (b->step = COARSEST; b->step >= FINEST; b->step /= 2) {
        size_t all = ask_net(b), gaps = b->place_count;
        gather_all(b, &b->kept->seen, MOST_SEEN);
        if (b->step < COARSEST && (double)gaps < GAPS * (double)all) return;
    }
}

bool radiosity_build(CompiledScene *compiled) {
    Arena *arena = compiled->arena;
    if (!compiled->scene->settings.radiosity.on || compiled->skin_count) return true;
    RadiosityKept *kept = arena_new(arena, RadiosityKept);
    *kept = (RadiosityKept){.seen = {.reach = RADIOSITY_REACH}};
    Builder b = {.compiled = compiled,
                 .kept = kept,
                 .asked = arena_push(arena, sizeof(RadiosityPlace[ASKED]) * CHUNK),
                 .asked_count = arena_new_array(arena, int, CHUNK),
                 .counters =
                     arena_new_array(arena, TraceCounters, (size_t)pool_threads(compiled->options->pool)),
                 .reach = REACH * double_clamp(sqrt(compiled->max_error * 128), 0.5, 1.5)};
    compiled->radiosity = kept;
    if (compiled->scene->settings.radiosity.bounces > 1) build_others(&b);
    kept->others_known = true;
    build_seen(&b);
    return !is_stopped(&b);
}
