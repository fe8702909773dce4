#include "scene/scene_bounds.h"

#include "scene/volumes.h"

static Box3 everything(void) {
    return (Box3){{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
}

static bool is_bounded(Box3 b) { return vec3_is_finite(b.min) && vec3_is_finite(b.max); }

/* The rows of a linear map: what an axis of the parent's space sees of the object's space. */
static Vec3 row(const Transform *t, int axis) {
    return vec3(vec3_get(t->linear.c[0], axis), vec3_get(t->linear.c[1], axis),
                vec3_get(t->linear.c[2], axis));
}

/* The box of `center ± extent(axis)` in the parent's space. */
static Box3 around(Vec3 center, const double extent[3]) {
    Vec3 e = vec3(extent[0], extent[1], extent[2]);
    return (Box3){vec3_sub(center, e), vec3_add(center, e)};
}

static Box3 sphere_bounds(const Object *o, const Transform *t) {
    double extent[3];
    for (int i = 0; i < 3; i++) extent[i] = fabs(o->as.sphere.radius) * vec3_length(row(t, i));
    return around(transform_point(t, o->as.sphere.center), extent);
}

/* A disc with unit normal n reaches r·|d − (d·n)n| in direction d. */
static Box3 disc_bounds(Vec3 center, Vec3 normal, double radius, const Transform *t) {
    double extent[3];
    for (int i = 0; i < 3; i++) {
        Vec3 d = row(t, i);
        extent[i] = fabs(radius) * vec3_length(vec3_madd(d, normal, -vec3_dot(d, normal)));
    }
    return around(transform_point(t, center), extent);
}

static Box3 cone_bounds(const Object *o, const Transform *t) {
    Vec3 axis = vec3_normalize(vec3_sub(o->as.cone.cap, o->as.cone.base));
    return box3_union(disc_bounds(o->as.cone.base, axis, o->as.cone.base_radius, t),
                      disc_bounds(o->as.cone.cap, axis, o->as.cone.cap_radius, t));
}

/* The Minkowski sum of a circle about y and a sphere. */
static Box3 torus_bounds(const Object *o, const Transform *t) {
    double extent[3];
    for (int i = 0; i < 3; i++) {
        Vec3 d = row(t, i);
        extent[i] = fabs(o->as.torus.major_radius) * hypot(d.x, d.z) +
                    fabs(o->as.torus.minor_radius) * vec3_length(d);
    }
    return around(t->offset, extent);
}

static Box3 mesh_bounds(const MeshData *m, const Transform *t) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            box = box3_add_point(box, transform_point(t, m->vertices[m->triangles[i][k]]));
    return box;
}

static Vec3 particle_point(const Particle *p, double t) {
    return vec3_madd(vec3_madd(p->position, p->velocity, t), p->acceleration, t * t / 2);
}

/* The parabola turns at most once along each axis. */
static Box3 particle_bounds(const Particle *p, const Transform *t) {
    Box3 box = box3_add_point(box3_empty(), transform_point(t, p->position));
    box = box3_add_point(box, transform_point(t, particle_point(p, p->life)));
    double extent[3], radius = double_max(p->width_foot, p->width_tip) / 2;
    for (int i = 0; i < 3; i++) {
        double turn = -vec3_dot(row(t, i), p->velocity) / vec3_dot(row(t, i), p->acceleration);
        if (turn > 0 && turn < p->life)
            box = box3_add_point(box, transform_point(t, particle_point(p, turn)));
        extent[i] = radius * vec3_length(row(t, i));
    }
    Vec3 e = vec3(extent[0], extent[1], extent[2]);
    return (Box3){vec3_sub(box.min, e), vec3_add(box.max, e)};
}

static Box3 bounds_under(const Object *object, const Transform *outer);

static Box3 union_bounds(const Object *o, const Transform *t) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < o->as.group->count; i++)
        box = box3_union(box, bounds_under(o->as.group->items[i], t));
    return box;
}

static Box3 intersection_bounds(const Object *o, const Transform *t) {
    Box3 box = everything();
    for (size_t i = 0; i < o->as.group->count; i++) {
        if (o->as.group->items[i]->inverse) continue;
        Box3 child = bounds_under(o->as.group->items[i], t);
        box = (Box3){vec3_max(box.min, child.min), vec3_min(box.max, child.max)};
    }
    return box3_is_empty(box) ? box3_empty() : box;
}

static Box3 surface_bounds(const Surface *s, const Transform *t) {
    Transform all = transform_then(&s->transform, t);
    if (s->kind == SURFACE_OBJECT) return bounds_under(s->object, &all);
    if (s->kind == SURFACE_TERRAIN) return box3_transform(&all, s->terrain->bounds);
    Box3 box = box3_empty();
    size_t count = ((size_t)s->nu + 1) * ((size_t)s->nv + 1);
    for (size_t i = 0; i < count; i++) box = box3_add_point(box, transform_point(&all, s->points[i]));
    return box;
}

static Box3 particles_bounds(const Object *o, const Transform *t) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < o->as.particles.count; i++)
        box = box3_union(box, particle_bounds(&o->as.particles.items[i], t));
    return box;
}

static Box3 branches_bounds(const Object *o, const Transform *t) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < o->as.branches.count; i++) {
        const BranchNode *node = &o->as.branches.items[i];
        Vec3 r = vec3_splat(fabs(node->radius));
        box = box3_union(box, box3_transform(t, (Box3){vec3_sub(node->position, r), vec3_add(node->position, r)}));
    }
    return box;
}

static Box3 bounds_under(const Object *o, const Transform *outer) {
    Transform own = object_transform(o), t = transform_then(&own, outer);
    switch (o->kind) {
    case OBJECT_SPHERE: return sphere_bounds(o, &t);
    case OBJECT_BOX:
        return box3_transform(&t, (Box3){vec3_min(o->as.box.corner1, o->as.box.corner2),
                                         vec3_max(o->as.box.corner1, o->as.box.corner2)});
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return cone_bounds(o, &t);
    case OBJECT_PLANE: return everything();
    case OBJECT_DISC: return disc_bounds(o->as.disc.center, o->as.disc.normal, o->as.disc.radius, &t);
    case OBJECT_TORUS: return torus_bounds(o, &t);
    case OBJECT_TRIANGLES: return mesh_bounds(o->as.mesh, &t);
    case OBJECT_UNION:
    case OBJECT_MERGE: return union_bounds(o, &t);
    case OBJECT_INTERSECTION: return intersection_bounds(o, &t);
    case OBJECT_DIFFERENCE:
        return o->as.group->count ? bounds_under(o->as.group->items[0], &t) : box3_empty();
    case OBJECT_PARTICLES: return particles_bounds(o, &t);
    case OBJECT_BRANCHES: return branches_bounds(o, &t);
    case OBJECT_SURFACE: return surface_bounds(o->as.surface, &t);
    case OBJECT_TEXEL:
        return is_bounded(o->as.texel->bounds) ? box3_transform(&t, o->as.texel->bounds) : everything();
    case OBJECT_VOLUME: return bounds_under(o->as.volume->container, &t);
    case OBJECT_SOLID:
    case OBJECT_UNMODELLED: return box3_empty();
    }
    return box3_empty();
}

Box3 object_bounds(const Object *object) {
    Transform identity = transform_identity();
    return bounds_under(object, &identity);
}
