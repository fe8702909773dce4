#include "shape/intersect.h"

/* ---- inside ---- */

static bool inside_box(const Object *object, Vec3 p) {
    Vec3 lo = vec3_min(object->as.box.corner1, object->as.box.corner2);
    Vec3 hi = vec3_max(object->as.box.corner1, object->as.box.corner2);
    return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z;
}

static bool inside_cone(const Object *object, Vec3 p) {
    Vec3 axis = vec3_sub(object->as.cone.cap, object->as.cone.base), from = vec3_sub(p, object->as.cone.base);
    double r0 = fabs(object->as.cone.base_radius), r1 = fabs(object->as.cone.cap_radius),
           length = vec3_length(axis);
    if (object->as.cone.open || !(length > 0)) return false;
    axis = vec3_scale(axis, 1 / length);
    double z = vec3_dot(from, axis);
    return z >= 0 && z <= length && vec3_length(vec3_madd(from, axis, -z)) <= r0 + (r1 - r0) * (z / length);
}

static bool inside_torus(const Object *object, Vec3 p) {
    double major = fabs(object->as.torus.major_radius), minor = fabs(object->as.torus.minor_radius);
    return hypot(hypot(p.x, p.z) - major, p.y) <= minor;
}

static bool inside_child(const Object *child, Vec3 p) {
    Transform place = object_transform(child);
    return shape_inside(child, transform_point_back(&place, p));
}

static bool inside_children(const Object *object, Vec3 p) {
    size_t count = object->as.group->count, holding = 0;
    const Object *const *items = object->as.group->items;
    for (size_t i = 0; i < count; i++) holding += inside_child(items[i], p);
    switch (object->kind) {
    case OBJECT_INTERSECTION: return count > 0 && holding == count;
    case OBJECT_DIFFERENCE: return holding == 1 && inside_child(items[0], p);
    default: return holding > 0;
    }
}

static bool inside_shape(const Object *object, Vec3 p) {
    switch (object->kind) {
    case OBJECT_SPHERE:
        return vec3_length(vec3_sub(p, object->as.sphere.center)) <= fabs(object->as.sphere.radius);
    case OBJECT_BOX: return inside_box(object, p);
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return inside_cone(object, p);
    case OBJECT_PLANE: return vec3_dot(p, object->as.plane.normal) <= object->as.plane.distance;
    case OBJECT_TORUS: return inside_torus(object, p);
    case OBJECT_UNION:
    case OBJECT_MERGE:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE: return inside_children(object, p);
    case OBJECT_DISC:
    case OBJECT_TRIANGLES:
    case OBJECT_PARTICLES:
    case OBJECT_BRANCHES:
    case OBJECT_SURFACE:
    case OBJECT_TEXEL:
    case OBJECT_VOLUME:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
    return false;
}

bool shape_inside(const Object *object, Vec3 point) { return inside_shape(object, point) != object->inverse; }

/* ---- bounds ---- */

Box3 shape_bounds_infinite(void) {
    return (Box3){{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
}

static bool is_infinite(Box3 box) {
    return !box3_is_empty(box) && !(vec3_is_finite(box.min) && vec3_is_finite(box.max));
}

static Box3 around(Vec3 center, Vec3 reach) {
    return (Box3){vec3_sub(center, reach), vec3_add(center, reach)};
}

/* Of a circle across the unit vector `axis`: it reaches r·sqrt(1 - axis²) along each axis. */
static Box3 circle_bounds(Vec3 center, Vec3 axis, double radius) {
    /* sqrt(y² + z²) and not sqrt(1 - x²), for accuracy near the axes. */
    return around(
        center,
        vec3_scale(vec3(hypot(axis.y, axis.z), hypot(axis.x, axis.z), hypot(axis.x, axis.y)), fabs(radius)));
}

static Box3 cone_bounds(const Object *object) {
    Vec3 base = object->as.cone.base, cap = object->as.cone.cap, axis = vec3_normalize(vec3_sub(cap, base));
    if (vec3_length_squared(axis) == 0) return box3_empty();
    return box3_union(circle_bounds(base, axis, object->as.cone.base_radius),
                      circle_bounds(cap, axis, object->as.cone.cap_radius));
}

static Box3 mesh_bounds(const MeshData *mesh) {
    Box3 box = box3_empty();
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++) box = box3_add_point(box, mesh->vertices[mesh->triangles[t][i]]);
    }
    return box;
}

/* The trajectory's ends and, for each axis, where the velocity along it vanishes; then half the width to all sides. */
static Box3 particle_bounds(const Particle *particle) {
    double times[5] = {0, particle->life, 0, 0, 0};
    double reach = 0.5 * double_max(fabs(particle->width_foot), fabs(particle->width_tip));
    Box3 box = box3_empty();
    for (int axis = 0; axis < 3; axis++) {
        double v = vec3_get(particle->velocity, axis), a = vec3_get(particle->acceleration, axis);
        double t = -v / a;
        if (t > 0 && t < particle->life) times[2 + axis] = t;
    }
    for (int i = 0; i < 5; i++) {
        Vec3 p = vec3_madd(particle->position, particle->velocity, times[i]);
        box = box3_add_point(box, vec3_madd(p, particle->acceleration, 0.5 * times[i] * times[i]));
    }
    return (Box3){vec3_sub(box.min, vec3_splat(reach)), vec3_add(box.max, vec3_splat(reach))};
}

static Box3 moved_bounds(const Transform *transform, Box3 box) {
    return box3_is_empty(box) || is_infinite(box) ? box : box3_transform(transform, box);
}

static Box3 child_bounds(const Object *child) {
    Transform place = object_transform(child);
    return moved_bounds(&place, shape_bounds(child));
}

static Box3 surface_bounds(const Surface *surface) {
    Box3 box = box3_empty();
    if (surface->deform) return shape_bounds_infinite();
    if (surface->kind == SURFACE_OBJECT) {
        box = child_bounds(surface->object);
    } else if (surface->kind == SURFACE_TERRAIN) {
        box = surface->terrain->bounds;
    } else {
        size_t count = (size_t)(surface->nu + 1) * (size_t)(surface->nv + 1);
        for (size_t i = 0; i < count; i++) box = box3_add_point(box, surface->points[i]);
    }
    return moved_bounds(&surface->transform, box);
}

static Box3 union_bounds(const Object *object) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < object->as.group->count; i++) {
        Box3 child = child_bounds(object->as.group->items[i]);
        if (!box3_is_empty(child)) box = box3_union(box, child);
    }
    return box;
}

static Box3 intersection_bounds(const Object *object) {
    Box3 box = shape_bounds_infinite();
    if (object->as.group->count == 0) return box3_empty();
    for (size_t i = 0; i < object->as.group->count; i++) {
        const Object *item = object->as.group->items[i];
        Box3 child = item->inverse ? shape_bounds_infinite() : child_bounds(item);
        box = (Box3){vec3_max(box.min, child.min), vec3_min(box.max, child.max)};
    }
    return box;
}

static Box3 difference_bounds(const Object *object) {
    if (object->as.group->count == 0) return box3_empty();
    const Object *first = object->as.group->items[0];
    return first->inverse ? shape_bounds_infinite() : child_bounds(first);
}

Box3 shape_bounds(const Object *object) {
    Box3 box = box3_empty();
    switch (object->kind) {
    case OBJECT_SPHERE: return around(object->as.sphere.center, vec3_splat(fabs(object->as.sphere.radius)));
    case OBJECT_BOX:
        return (Box3){vec3_min(object->as.box.corner1, object->as.box.corner2),
                      vec3_max(object->as.box.corner1, object->as.box.corner2)};
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return cone_bounds(object);
    case OBJECT_PLANE: return shape_bounds_infinite();
    case OBJECT_DISC:
        return circle_bounds(object->as.disc.center, vec3_normalize(object->as.disc.normal),
                             object->as.disc.radius);
    case OBJECT_TORUS: {
        double minor = fabs(object->as.torus.minor_radius),
               reach = fabs(object->as.torus.major_radius) + minor;
        return around(vec3_splat(0), vec3(reach, minor, reach));
    }
    case OBJECT_TRIANGLES: return mesh_bounds(object->as.mesh);
    case OBJECT_UNION:
    case OBJECT_MERGE: return union_bounds(object);
    case OBJECT_INTERSECTION: return intersection_bounds(object);
    case OBJECT_DIFFERENCE: return difference_bounds(object);
    case OBJECT_BRANCHES:
        for (size_t i = 0; i < object->as.branches.count; i++) {
            const BranchNode *node = &object->as.branches.items[i];
            box = box3_union(box, around(node->position, vec3_splat(fabs(node->radius))));
        }
        return box;
    case OBJECT_PARTICLES:
        for (size_t i = 0; i < object->as.particles.count; i++) {
            box = box3_union(box, particle_bounds(&object->as.particles.items[i]));
        }
        return box;
    case OBJECT_SURFACE: return surface_bounds(object->as.surface);
    case OBJECT_TEXEL: return object->as.texel->bounds;
    case OBJECT_VOLUME:
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: break;
    }
    return box;
}
