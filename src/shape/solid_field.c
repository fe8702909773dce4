/* Surfaces of functions of the place: isosurface. */
#include "shape/body.h"
#include "shape/intersect.h"
#include "shape/line_roots.h"
#include "shape/roots.h"
#include "shape/solid.h"
#include "shape/solid_field.h"
#include "tape/node_cache.h"
#include "tape/tape_affine.h"
#include "tape/tape_detail.h"
#include "tape/tape_interval.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { PART_SURFACE, PART_CONTAINER, MOST_STEPS = 200000, LEAST_STEPS = 32, MOST_ENDS = 64, MOST_CHANGES = 100000, FEW_SLOTS = 256, CACHES = 8 };

/* Of all threads; added to once a ray. */
typedef struct FieldWork {
    atomic_uint_fast64_t lines, evaluations, unsettled;
    _Atomic(NodeCache *) caches[CACHES]; /* that nobody uses; NULL: none here */
} FieldWork;

typedef struct Field {
    const Solid *solid;
    Line line; /* but for the ray */
    bool bounded, detailed; /* detailed: the line's sum has terms that are left out where they are fine */
    const Body *container; /* NULL: it is a sphere or box */
    const ShapeTracer *shapes; /* that has prepared it */
    FieldWork *work;
    Transform place;       /* of the container */
    Box3 bounds;
} Field;

static const LineMethod methods[] = {
    [ISOSURFACE_AUTO] = LINE_AFFINE_OPTIMISED, [ISOSURFACE_INTERVAL] = LINE_INTERVAL,         [ISOSURFACE_AFFINE] = LINE_STANDARD,
    [ISOSURFACE_REDUCED] = LINE_AFFINE,        [ISOSURFACE_OPTIMISED] = LINE_AFFINE_OPTIMISED,
};

static void prepare_sum(Field *f, Arena *arena) {
    TapeSum *sum = arena_new(arena, TapeSum);
    Vec3 margin = vec3_scale(vec3_sub(f->bounds.max, f->bounds.min), 0x1p-20);
    Vec3 low = vec3_sub(f->bounds.min, margin), high = vec3_add(f->bounds.max, margin);
    const Interval box[3] = {interval(low.x, high.x), interval(low.y, high.y), interval(low.z, high.z)};
    *sum = tape_sum_of(f->line.tape, box, arena);
    f->line.sum = sum;
    f->detailed = !f->solid->as.isosurface.full_detail && tape_sum_measure(sum, box, arena);
    for (int k = 0; k < CACHES && tape_has_forms(f->line.tape); k++) {
        NodeCache *cache = arena_new(arena, NodeCache);
        node_cache_begin(cache);
        atomic_store(&f->work->caches[k], cache);
    }
}

/* Whoever finds none does without. */
static NodeCache *take_cache(FieldWork *work) {
    NodeCache *cache = NULL;
    for (int k = 0; k < CACHES && !cache; k++) cache = atomic_exchange(&work->caches[k], NULL);
    return cache;
}

static void put_back(FieldWork *work, NodeCache *cache) {
    for (int k = 0; k < CACHES && cache; k++) {
        NodeCache *none = NULL;
        if (atomic_compare_exchange_strong(&work->caches[k], &none, cache)) cache = NULL;
    }
}

static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    const Object *container = s->as.isosurface.container;
    Field *f = arena_new(arena, Field);
    const Tape *tape = s->as.isosurface.function;
    *f = (Field){.solid = s, .place = object_transform(container), .work = arena_new(arena, FieldWork)};
    for (int k = 0; k < CACHES; k++) atomic_init(&f->work->caches[k], NULL);
    atomic_init(&f->work->lines, 0), atomic_init(&f->work->evaluations, 0), atomic_init(&f->work->unsettled, 0);
    f->line = (Line){.tape = tape, .level = s->as.isosurface.threshold, .method = methods[s->as.isosurface.method]};
    Box3 bounds = shape_bounds(container);
    if (container->kind != OBJECT_SPHERE && container->kind != OBJECT_BOX) {
        ShapeTracer *shapes = shape_tracer_create(arena);
        f->shapes = shapes;
        f->container = body_of(shapes, container);
        if (!f->container) return NULL;
        bounds = body_bounds(f->container);
    }
    if (box3_is_empty(bounds) || !vec3_is_finite(bounds.min) || !vec3_is_finite(bounds.max)) return NULL;
    f->bounds = box3_transform(&f->place, bounds);
    f->bounded = tape_input_count(tape) == 3 && tape_output_count(tape) == 1 && tape_is_bounded(tape);
    if (f->bounded && f->line.method == LINE_AFFINE_OPTIMISED) prepare_sum(f, arena);
    if (s->as.isosurface.method == ISOSURFACE_OPTIMISED && !f->detailed) f->line.sum = NULL; /* one piece at a time, as the paper has it */
    return f;
}

static double counted(const Solid *s, double value) {
    value -= s->as.isosurface.threshold;
    return isnan(value) ? VTS_INFINITY : value;
}

double solid_isosurface_value(const Solid *s, Vec3 p) {
    double out[TAPE_CALL_MAX] = {0};
    tape_eval_once(s->as.isosurface.function, (double[]){p.x, p.y, p.z}, out);
    return counted(s, out[0]);
}

void solid_isosurface_row(const Solid *s, Vec3 point, Vec3 step, size_t count, double *in, double *out) {
    const Tape *tape = s->as.isosurface.function;
    const double *inputs[TAPE_CALL_MAX] = {in, in + count, in + 2 * count};
    double *outputs[1] = {out};
    if (tape_input_count(tape) != 3 || tape_output_count(tape) != 1) {
        for (size_t i = 0; i < count; i++) out[i] = solid_isosurface_value(s, vec3_madd(point, step, (double)i));
        return;
    }
    for (size_t i = 0; i < count; i++) {
        Vec3 p = vec3_madd(point, step, (double)i);
        in[i] = p.x, in[count + i] = p.y, in[2 * count + i] = p.z;
    }
    tape_eval_batch(tape, count, inputs, outputs);
    for (size_t i = 0; i < count; i++) out[i] = counted(s, out[i]);
}

static double value_on(const Solid *s, const Ray *ray, double t) {
    return solid_isosurface_value(s, vec3_madd(ray->origin, ray->direction, t));
}

typedef struct FieldLine {
    const Solid *solid;
    const Ray *ray;
    LineWork *work;
} FieldLine;

static double value_along(const void *context, double t) {
    const FieldLine *line = context;
    line->work->values++;
    return value_on(line->solid, line->ray, t);
}

/* Steps that a function of at most this gradient cannot pass a zero in; no shorter ones than the accuracy. */
static void march(const Solid *s, const Ray *ray, double from, double to, SolidSink *sink, LineWork *work) {
    const FieldLine line = {s, ray, work};
    double length = vec3_length(ray->direction), span = to - from;
    double gradient = double_max(s->as.isosurface.max_gradient, 1e-9) * length;
    double shortest = double_max(s->as.isosurface.accuracy / length / 2, span / MOST_STEPS),
           longest = span / LEAST_STEPS;
    double t = from, value = value_along(&line, t);
    while (t < to && t < sink->t_max) {
        double next = t + double_clamp(fabs(value) / gradient, shortest, double_max(longest, shortest));
        if (!(next < to)) next = to;
        double there = value_along(&line, next);
        if ((value <= 0) != (there <= 0))
            solid_offer(sink, roots_between(value_along, &line, t, value, next, there, 1e-15 * (fabs(t) + fabs(next))),
                        (SolidTag){PART_SURFACE, 0, 0});
        t = next;
        value = there;
    }
}

static const RayWidth LINE_ALONE = {0, 0};

/* In the lengths of the function's space. */
static RayWidth width_of(const Field *f, const Ray *ray, RayWidth width) {
    double length = vec3_length(ray->direction);
    return f->detailed ? (RayWidth){width.start * length, width.spread * length} : LINE_ALONE;
}

/* The function as it is seen with a width: less its threshold, infinite for what is no number. */
static double seen_value(const Field *f, Vec3 p, double width) {
    double few[FEW_SLOTS];
    if (!(width > 0) || f->line.sum->scratch_size > FEW_SLOTS) return solid_isosurface_value(f->solid, p);
    return counted(f->solid, tape_sum_value(f->line.sum, p, width, few));
}

/* Every change of sign in turn; `start`: the function's value at `from`, or 0. Behind one the search goes on where doubles can tell its place from it. */
static void search(const Field *f, const Ray *ray, double from, double to, double start, SolidSink *sink, LineWork *work) {
    Line line = f->line;
    line.origin = ray->origin, line.direction = ray->direction, line.width = width_of(f, ray, sink->width);
    double t;
    bool falling;
    line.start = start;
    line.cells = take_cache(f->work);
    for (int k = 0; k < MOST_CHANGES && from < double_min(to, sink->t_max); k++) {
        if (!line_first_root(&line, from, double_min(to, sink->t_max), &t, &falling, work)) break;
        solid_offer(sink, t, (SolidTag){PART_SURFACE, line.width.start + line.width.spread * t, 0});
        from = line_behind(&line, t), line.start = 0;
    }
    put_back(f->work, line.cells);
}

/* ---- containers ---- */

typedef struct Ends {
    double t[MOST_ENDS];
    SolidTag tags[MOST_ENDS]; /* u: the part of a sphere's or box's surface; else nothing */
    int count;
    Ray ray; /* in the container's space */
} Ends;

static void find_ends(const Field *f, const Ray *ray, Ends *ends) {
    const Object *container = f->solid->as.isosurface.container;
    ends->ray = (Ray){transform_point_back(&f->place, ray->origin), transform_vector_back(&f->place, ray->direction)};
    ends->count = 0;
    if (!f->container) {
        ShapeCrossing crossings[SHAPE_MOST_CROSSINGS];
        if (shape_crossings(container, &ends->ray, crossings) != 2) return;
        for (int i = 0; i < 2; i++) ends->t[i] = crossings[i].t, ends->tags[i] = (SolidTag){PART_CONTAINER, crossings[i].part, 0};
        ends->count = 2;
        return;
    }
    BodyHit hit = {.t = 0};
    double from = -VTS_INFINITY;
    while (ends->count < MOST_ENDS && body_meet(f->container, container, &ends->ray, from, VTS_INFINITY, &hit)) {
        ends->t[ends->count] = hit.t;
        ends->tags[ends->count++] = (SolidTag){PART_CONTAINER, 0, hit.t};
        from = hit.t;
    }
}

static bool within(const Field *f, const Ends *ends, int k) {
    double middle = ends->t[k] / 2 + ends->t[k + 1] / 2;
    return !f->container || body_inside(f->container, vec3_madd(ends->ray.origin, ends->ray.direction, middle));
}

static void keep_count(FieldWork *sum, const LineWork *work) {
    atomic_fetch_add_explicit(&sum->lines, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&sum->evaluations, work->bounds + work->values, memory_order_relaxed);
    if (work->unsettled) atomic_fetch_add_explicit(&sum->unsettled, work->unsettled, memory_order_relaxed);
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Field *f = data;
    Ends ends;
    RayWidth width = width_of(f, ray, sink->width);
    LineWork work = {0, 0, 0};
    find_ends(f, ray, &ends);
    bool closed = !f->solid->as.isosurface.open;
    for (int i = 0; i < ends.count; i++) {
        double end = ends.t[i], start = 0;
        if (closed && end > sink->t_min && end < sink->t_max) {
            work.values++;
            start = seen_value(f, vec3_madd(ray->origin, ray->direction, end), width.start + width.spread * end);
            if (start < 0) solid_offer(sink, end, ends.tags[i]);
        }
        if (i + 1 == ends.count) break;
        double from = double_max(end, sink->t_min), to = double_min(ends.t[i + 1], sink->t_max);
        if (!(from < to) || !within(f, &ends, i)) continue;
        if (from > end) start = 0;
        if (f->bounded)
            search(f, ray, from, to, start, sink, &work);
        else
            march(f->solid, ray, from, to, sink, &work);
    }
    if (work.values || work.bounds) keep_count(f->work, &work);
}

static void work_of(const void *data, SolidWork *sum) {
    const Field *f = data;
    const SolidWork own = {.lines = atomic_load_explicit(&f->work->lines, memory_order_relaxed),
                           .evaluations = atomic_load_explicit(&f->work->evaluations, memory_order_relaxed),
                           .unsettled = atomic_load_explicit(&f->work->unsettled, memory_order_relaxed),
                           .sampled = !f->bounded};
    solid_work_add(sum, &own);
    if (f->shapes) shape_tracer_work(f->shapes, sum);
}

/* Where the function has no gradient at the very place, neighbouring places may tell one. */
static double difference(const Solid *s, Vec3 p, Vec3 step, double h) {
    return (solid_isosurface_value(s, vec3_madd(p, step, h)) - solid_isosurface_value(s, vec3_madd(p, step, -h))) / (2 * h);
}

static Vec3 container_normal(const Field *f, Vec3 p, const SolidTag *tag) {
    const Object *container = f->solid->as.isosurface.container;
    Vec3 local = transform_point_back(&f->place, p), out = vec3(0, 1, 0);
    if (!f->container) {
        out = shape_normal_at(container, local, (uint8_t)tag->u);
    } else {
        /* Met again, from a little way off along each axis: the nearest place has the normal. */
        double nearest = VTS_INFINITY, reach = 1e-4 * vec3_length(vec3_sub(f->bounds.max, f->bounds.min));
        for (int k = 0; k < 6; k++) {
            Vec3 d = {0, 0, 0};
            (k % 3 == 0 ? &d.x : k % 3 == 1 ? &d.y : &d.z)[0] = k < 3 ? reach : -reach;
            const Ray ray = {vec3_sub(local, d), d};
            BodyHit hit = {.t = 2};
            if (!body_meet(f->container, container, &ray, 0, 2, &hit) || !(fabs(hit.t - 1) < nearest)) continue;
            nearest = fabs(hit.t - 1), out = hit.normal;
        }
    }
    return vec3_normalize(transform_normal(&f->place, out));
}

/* The value and how it rises. */
static Dual gradient(const Field *f, Vec3 p, double width) {
    const Tape *tape = f->solid->as.isosurface.function;
    Dual few[FEW_SLOTS], out = {(double)NAN, {0, 0, 0}};
    size_t slots = size_max(tape_scratch_size(tape), f->line.sum ? f->line.sum->scratch_size : 0);
    if (tape_input_count(tape) != 3 || tape_output_count(tape) != 1) return out;
    Dual *scratch = slots > FEW_SLOTS ? malloc(slots * sizeof *scratch) : few;
    if (scratch) out = width > 0 ? tape_sum_gradient(f->line.sum, p, width, scratch) : tape_eval_gradient(tape, p, scratch);
    if (scratch != few) free(scratch);
    return out;
}

/* Where the function jumps over its level its slope on one side tells nothing of the surface: there it is not near the level, as it is
 * at zeros, which are places to 2⁻⁴⁰. */
static bool is_zero(const Dual *at, double level, double step) {
    return fabs(at->value - level) <= step * (fabs(at->by[0]) + fabs(at->by[1]) + fabs(at->by[2]));
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Field *f = data;
    if (tag->part != PART_SURFACE) return container_normal(f, p, tag);
    Dual at = gradient(f, p, tag->u);
    Vec3 exact = {at.by[0], at.by[1], at.by[2]};
    double size = vec3_length(vec3_sub(f->bounds.max, f->bounds.min)), h = 1e-6 * double_max(size, double_max(fabs(p.x), double_max(fabs(p.y), fabs(p.z))));
    bool known = vec3_is_finite(exact) && vec3_length_squared(exact) > 0;
    if (known && is_zero(&at, f->solid->as.isosurface.threshold, h)) return vec3_normalize(exact);
    Vec3 g = {difference(f->solid, p, vec3(1, 0, 0), h), difference(f->solid, p, vec3(0, 1, 0), h),
              difference(f->solid, p, vec3(0, 0, 1), h)};
    if (vec3_is_finite(g) && vec3_length_squared(g) > 0) return vec3_normalize(g);
    return known ? vec3_normalize(exact) : vec3(0, 1, 0);
}

static bool inside(const void *data, Vec3 p) {
    const Field *f = data;
    const Object *container = f->solid->as.isosurface.container;
    Vec3 local = transform_point_back(&f->place, p);
    bool held = f->container ? body_inside(f->container, local) : shape_inside(container, local) != container->inverse;
    return held && solid_isosurface_value(f->solid, p) < 0;
}

static Box3 bounds(const void *data) { return ((const Field *)data)->bounds; }

const SolidOps solid_isosurface_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds, .work = work_of};
