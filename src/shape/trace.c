#include "shape/body.h"

bool shape_trace(ShapeTracer *tracer, const Object *object, const Ray *ray, double t_min, TraceHit *hit) {
    const Body *body = body_of(tracer, object);
    double length = vec3_length(ray->direction);
    const Transform place = object_transform(object);
    if (!body || transform_is_singular(&place)) return false;
    if (!vec3_is_finite(ray->origin) || !isfinite(length) || !(length > 0)) return false;
    const Ray local = {transform_point_back(&place, ray->origin), transform_vector_back(&place, ray->direction)};
    BodyHit met;
    if (!body_meet(body, object, &local, t_min, VTS_INFINITY, &met)) return false;
    Vec3 normal = vec3_normalize(transform_normal(&place, met.normal));
    *hit = (TraceHit){met.t, vec3_madd(ray->origin, ray->direction, met.t), normal};
    return true;
}

bool shape_trace_inside(ShapeTracer *tracer, const Object *object, Vec3 point) {
    const Body *body = body_of(tracer, object);
    const Transform place = object_transform(object);
    return body && !transform_is_singular(&place) && vec3_is_finite(point) && body_inside(body, transform_point_back(&place, point));
}
