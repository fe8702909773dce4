/* Rays, points and boxes against any object of the language, sets and copies included: what trace(), inside(), min_extent()
 * and max_extent() ask. */
#ifndef VTS_SHAPE_TRACE_H
#define VTS_SHAPE_TRACE_H

#include "base/arena.h"
#include "scene/scene.h"

/* Keeps what was prepared for an object (trees over triangles and copies, outlines of text …), by content hash, so that the
 * second question costs little. For one thread. */
typedef struct ShapeTracer ShapeTracer;

typedef struct TraceHit {
    double t; /* in lengths of the ray's direction */
    Vec3 point;
    Vec3 normal; /* unit, as POV-Ray directs it; zero where the surface has none */
} TraceHit;

/* The tracer and all that it keeps live in `arena`, and so must the objects it is asked about, as long. */
ShapeTracer *shape_tracer_create(Arena *arena);

/* The first crossing with t > t_min, with the object's own transform applied: of unions all surfaces count, of merges,
 * intersections and differences those that are not hidden in them; `clipped_by` and `bounded_by` hold. False for a miss. */
bool shape_trace(ShapeTracer *tracer, const Object *object, const Ray *ray, double t_min, TraceHit *hit);
/* Whether the point is inside; sheets have no inside, meshes one if they have an inside_vector. */
bool shape_trace_inside(ShapeTracer *tracer, const Object *object, Vec3 point);
struct SolidWork;
/* Adds what the functions of all shapes that were prepared have cost. */
void shape_tracer_work(const ShapeTracer *tracer, struct SolidWork *sum);
/* What its kind prepared for the object, and its bounds, both without the object's transform; NULL and empty for nothing. */
const void *shape_trace_data(ShapeTracer *tracer, const Object *object);
Box3 shape_trace_bounds(ShapeTracer *tracer, const Object *object);

#endif
