#include "shape/tessellate.h"

#include "shape/tessellate_branches.h"
#include "shape/tessellate_mesh.h"
#include "shape/tessellate_parts.h"
#include "shape/tessellate_rare.h"
#include "shape/tessellate_solids.h"

double tessellate_stretch(const Mat3 *m) {
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        largest =
            double_max(largest, double_max(fabs(m->c[i].x), double_max(fabs(m->c[i].y), fabs(m->c[i].z))));
    }
    if (largest == 0) return 0;
    Vec3 x = vec3_scale(m->c[0], 1 / largest), y = vec3_scale(m->c[1], 1 / largest),
         z = vec3_scale(m->c[2], 1 / largest);
    Sym3f gram = {(float)vec3_dot(x, x), (float)vec3_dot(y, y), (float)vec3_dot(z, z),
                  (float)vec3_dot(x, y), (float)vec3_dot(x, z), (float)vec3_dot(y, z)};
    float values[3];
    sym3f_eigen(&gram, values, NULL);
    return largest * sqrt((double)values[0]) * (1 + 1e-5);
}

bool tessellate_refuse(const TessellateWalk *walk, const Object *object, const char *reason) {
    *walk->refusal = (ShapeRefusal){object->span, reason};
    return false;
}

bool tessellate_give_up(const TessellateWalk *walk) {
    *walk->refusal = (ShapeRefusal){.reason = "it was interrupted"};
    return false;
}

void tessellate_doubt(const TessellateWalk *walk, const Object *object, const char *reason) {
    ShapeRefusal *doubt = walk->options->doubt;
    if (doubt && !doubt->reason) *doubt = (ShapeRefusal){object->span, reason};
}

ShapeTracer *tessellate_tracer(TessellateWalk *walk) {
    if (!walk->tracer) walk->tracer = shape_tracer_create(walk->arena);
    return walk->tracer;
}

static bool push_mesh(const TessellateWalk *walk, const Object *object) {
    const char *reason;
    return tessellate_mesh(object->as.mesh, walk->options->parts, walk->arena, walk->out, &reason) ||
           tessellate_refuse(walk, object, reason);
}

static bool push_particles(const TessellateWalk *walk, const Object *object, double tolerance) {
    if (!walk->options->particles) return tessellate_refuse(walk, object, "particles do not make a surface");
    walk->options->particles(object->as.particles.items, object->as.particles.count, tolerance, walk->arena,
                             walk->out);
    return true;
}

static bool push_rare(TessellateWalk *walk, const Object *object, double tolerance, const Box3 *region) {
    const ExactSurface surface = {object, solid_ops(object), shape_trace_data(tessellate_tracer(walk), object)};
    const RareShape shape = {walk, surface, double_clamp(tolerance, 1e-12, 1e12), walk->options->parts, region};
    return !surface.data || tessellate_rare(&shape);
}

bool tessellate_shape(TessellateWalk *walk, const Object *object, double tolerance, const Box3 *region) {
    int parts = walk->options->parts;
    switch (object->kind) {
    case OBJECT_SPHERE: tessellate_sphere(object, tolerance, parts, walk->arena, walk->out); return true;
    case OBJECT_BOX: tessellate_box(object, parts, walk->arena, walk->out); return true;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: tessellate_cone(object, tolerance, parts, walk->arena, walk->out); return true;
    case OBJECT_DISC: tessellate_disc(object, tolerance, parts, walk->arena, walk->out); return true;
    case OBJECT_TORUS: tessellate_torus(object, tolerance, parts, walk->arena, walk->out); return true;
    case OBJECT_TRIANGLES: return push_mesh(walk, object);
    case OBJECT_PARTICLES: return push_particles(walk, object, tolerance);
    case OBJECT_BRANCHES: tessellate_branches(object, tolerance, walk->arena, walk->out); return true;
    case OBJECT_SURFACE:
        return tessellate_surface(object->as.surface, tolerance, walk->arena, walk->out, walk->refusal);
    case OBJECT_PLANE:
        if (!region) return tessellate_refuse(walk, object, "a plane has no end");
        tessellate_plane(object, region, walk->arena, walk->out);
        return true;
    case OBJECT_SOLID: return push_rare(walk, object, tolerance, region);
    case OBJECT_TEXEL: return tessellate_refuse(walk, object, "a texel has no surface");
    case OBJECT_VOLUME: return tessellate_refuse(walk, object, "a volume has no surface");
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_UNION:
    case OBJECT_MERGE:
    case OBJECT_UNMODELLED: break;
    }
    return tessellate_refuse(walk, object, "this object is not modelled yet");
}

static bool push_tree(TessellateWalk *walk, const Object *object, const Transform *outer) {
    if (tessellate_interrupted(walk)) return tessellate_give_up(walk);
    if (tessellate_is_set(object)) return tessellate_set(walk, object, outer);
    Transform own = object_transform(object), whole = transform_then(&own, outer);
    if (object->kind == OBJECT_UNION) {
        for (size_t i = 0; i < object->as.group->count; i++) {
            if (!push_tree(walk, object->as.group->items[i], &whole)) return false;
        }
        return true;
    }
    SoupMark since = soup_mark(walk->out);
    double stretch = tessellate_stretch(&whole.linear);
    if (!tessellate_shape(walk, object, stretch > 0 ? walk->options->tolerance / stretch : HUGE_VAL, NULL)) return false;
    soup_transform(walk->arena, walk->out, since, &whole);
    return true;
}

bool tessellate(const Object *object, const Transform *transform, const TessellateOptions *options,
                Arena *arena, TriangleSoup *out, ShapeRefusal *refusal) {
    TessellateWalk walk = {options, NULL, arena, out, refusal};
    Transform identity = transform_identity();
    return push_tree(&walk, object, transform ? transform : &identity);
}
