#include "hooks.h"

#include "pattern/pattern_function.h"
#include "shape/extent.h"

/* A ray that starts on a surface does not meet it there. */
static const double START = 1e-6;

static bool trace(void *context, const Object *object, Vec3 origin, Vec3 direction, Vec3 *point,
                  Vec3 *normal) {
    TraceHit hit;
    const Ray ray = {origin, vec3_normalize(direction)};
    if (!shape_trace(context, object, &ray, START, &hit)) return false;
    *point = hit.point;
    *normal = hit.normal;
    return true;
}

static bool inside(void *context, const Object *object, Vec3 point) {
    return shape_trace_inside(context, object, point);
}

static bool pigment_function(void *context, Arena *arena, const Pigment *pigment, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pigment_external(pigment);
    return true;
}

static bool pattern_function(void *context, Arena *arena, const Pigment *pattern, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pattern_external(pattern);
    return true;
}

static Box3 extent(void *context, const Object *object) { return shape_extent(context, object); }

EvalGeometry hooks_geometry(Arena *arena) {
    return (EvalGeometry){
        .context = shape_tracer_create(arena),
        .trace = trace,
        .inside = inside,
        .extent = extent,
        .pigment_function = pigment_function,
        .pattern_function = pattern_function,
    };
}
