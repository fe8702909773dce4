#include "shape/tessellate.h"

#include "shape/tessellate_mesh.h"
#include "shape/tessellate_solids.h"

typedef struct Walk {
    const TessellateOptions *options;
    Arena *arena;
    TriangleSoup *out;
    ShapeRefusal *refusal;
} Walk;

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

static bool refuse(const Walk *walk, const Object *object, const char *reason) {
    *walk->refusal = (ShapeRefusal){object->span, reason};
    return false;
}

static bool push_mesh(const Walk *walk, const Object *object) {
    const char *reason;
    return tessellate_mesh(object->as.mesh, walk->options->parts, walk->arena, walk->out, &reason) ||
           refuse(walk, object, reason);
}

static bool push_particles(const Walk *walk, const Object *object, double tolerance) {
    if (!walk->options->particles) return refuse(walk, object, "particles do not make a surface");
    walk->options->particles(object->as.particles.items, object->as.particles.count, tolerance, walk->arena,
                             walk->out);
    return true;
}

/* In object space. */
static bool push_shape(const Walk *walk, const Object *object, double tolerance) {
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
    case OBJECT_SURFACE:
        return tessellate_surface(object->as.surface, tolerance, walk->arena, walk->out, walk->refusal);
    case OBJECT_PLANE: return refuse(walk, object, "a plane has no end");
    case OBJECT_TEXEL: return refuse(walk, object, "a texel has no surface");
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
        return refuse(walk, object, "intersections and differences have no triangles yet");
    case OBJECT_UNION:
    case OBJECT_MERGE:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
    return refuse(walk, object, "this object is not modelled yet");
}

static bool push_tree(const Walk *walk, const Object *object, const Transform *outer) {
    Transform own = object_transform(object), whole = transform_then(&own, outer);
    if (object->kind == OBJECT_UNION || object->kind == OBJECT_MERGE) {
        for (size_t i = 0; i < object->as.group->count; i++) {
            if (!push_tree(walk, object->as.group->items[i], &whole)) return false;
        }
        return true;
    }
    SoupMark since = soup_mark(walk->out);
    double stretch = tessellate_stretch(&whole.linear);
    if (!push_shape(walk, object, stretch > 0 ? walk->options->tolerance / stretch : HUGE_VAL)) return false;
    soup_transform(walk->arena, walk->out, since, &whole);
    return true;
}

bool tessellate(const Object *object, const Transform *transform, const TessellateOptions *options,
                Arena *arena, TriangleSoup *out, ShapeRefusal *refusal) {
    const Walk walk = {options, arena, out, refusal};
    Transform identity = transform_identity();
    return push_tree(&walk, object, transform ? transform : &identity);
}
