/* Surfaces of functions of the place: isosurface. */
#include "shape/intersect.h"
#include "shape/roots.h"
#include "shape/solid.h"
#include "shape/solid_field.h"

enum { PART_SURFACE, PART_CONTAINER_IN, PART_CONTAINER_OUT, MOST_STEPS = 200000, LEAST_STEPS = 32 };

static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    ObjectKind kind = s->as.isosurface.container->kind;
    (void)arena;
    return kind == OBJECT_SPHERE || kind == OBJECT_BOX ? s : NULL;
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

static Ray container_ray(const Solid *s, const Ray *ray) {
    Transform t = object_transform(s->as.isosurface.container);
    return (Ray){transform_point_back(&t, ray->origin), transform_vector_back(&t, ray->direction)};
}

static double value_on(const Solid *s, const Ray *ray, double t) {
    return solid_isosurface_value(s, vec3_madd(ray->origin, ray->direction, t));
}

typedef struct FieldLine {
    const Solid *solid;
    const Ray *ray;
} FieldLine;

static double value_along(const void *context, double t) {
    const FieldLine *line = context;
    return value_on(line->solid, line->ray, t);
}

/* Steps that a function of at most this gradient cannot pass a zero in; no shorter ones than the accuracy. */
static void march(const Solid *s, const Ray *ray, double from, double to, SolidSink *sink) {
    double length = vec3_length(ray->direction), span = to - from;
    double gradient = double_max(s->as.isosurface.max_gradient, 1e-9) * length;
    double shortest = double_max(s->as.isosurface.accuracy / length / 2, span / MOST_STEPS),
           longest = span / LEAST_STEPS;
    double t = from, value = value_on(s, ray, t);
    while (t < to && t < sink->t_max) {
        double next = t + double_clamp(fabs(value) / gradient, shortest, double_max(longest, shortest));
        if (!(next < to)) next = to;
        double there = value_on(s, ray, next);
        if ((value <= 0) != (there <= 0))
            solid_offer(sink, roots_between(value_along, &(FieldLine){s, ray}, t, value, next, there, 1e-15 * (fabs(t) + fabs(next))),
                        (SolidTag){PART_SURFACE, 0, 0});
        t = next;
        value = there;
    }
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Solid *s = data;
    ShapeCrossing ends[SHAPE_MOST_CROSSINGS];
    Ray local = container_ray(s, ray);
    if (shape_crossings(s->as.isosurface.container, &local, ends) != 2) return;
    if (!s->as.isosurface.open)
        for (uint32_t i = 0; i < 2; i++)
            if (ends[i].t > sink->t_min && ends[i].t < sink->t_max && value_on(s, ray, ends[i].t) < 0)
                solid_offer(sink, ends[i].t, (SolidTag){PART_CONTAINER_IN + i, ends[i].part, 0});
    double from = double_max(ends[0].t, sink->t_min), to = double_min(ends[1].t, sink->t_max);
    if (from < to) march(s, ray, from, to, sink);
}

static double difference(const Solid *s, Vec3 p, Vec3 step, double h) {
    return (solid_isosurface_value(s, vec3_madd(p, step, h)) - solid_isosurface_value(s, vec3_madd(p, step, -h))) / (2 * h);
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Solid *s = data;
    const Object *container = s->as.isosurface.container;
    if (tag->part != PART_SURFACE) {
        Transform place = object_transform(container);
        const Ray here = {transform_point_back(&place, p), vec3_splat(0)};
        const ShapeCrossing crossing = {0, (uint8_t)tag->u, false};
        return vec3_normalize(
            transform_normal(&place, shape_hit_at(container, &here, &crossing).normal));
    }
    double h = 1e-6 * double_max(1, double_max(fabs(p.x), double_max(fabs(p.y), fabs(p.z))));
    Vec3 g = {difference(s, p, vec3(1, 0, 0), h), difference(s, p, vec3(0, 1, 0), h),
              difference(s, p, vec3(0, 0, 1), h)};
    return vec3_is_finite(g) && vec3_length_squared(g) > 0 ? vec3_normalize(g) : vec3(0, 1, 0);
}

static bool inside(const void *data, Vec3 p) {
    const Solid *s = data;
    const Object *container = s->as.isosurface.container;
    Transform place = object_transform(container);
    return shape_inside(container, transform_point_back(&place, p)) != container->inverse && solid_isosurface_value(s, p) < 0;
}

static Box3 bounds(const void *data) {
    const Object *container = ((const Solid *)data)->as.isosurface.container;
    Transform place = object_transform(container);
    return box3_transform(&place, shape_bounds(container));
}

const SolidOps solid_isosurface_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
