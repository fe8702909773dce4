/* What the language asks of objects: min_extent(), max_extent(), trace(), inside(). */
#include "eval/eval_state.h"

static Box3 box_of(Vec3 a, Vec3 b) { return box3_add_point(box3_add_point(box3_empty(), a), b); }

/* Half the extent of a circle of radius 1 across the unit vector `axis`. */
static Vec3 circle_extent(Vec3 axis) {
    return vec3(sqrt(double_max(1 - axis.x * axis.x, 0)), sqrt(double_max(1 - axis.y * axis.y, 0)),
                sqrt(double_max(1 - axis.z * axis.z, 0)));
}

static Box3 cone_box(Vec3 base, double r0, Vec3 cap, double r1) {
    Vec3 spread = circle_extent(vec3_normalize(vec3_sub(cap, base)));
    Box3 a = box_of(vec3_madd(base, spread, -r0), vec3_madd(base, spread, r0));
    return box3_union(a, box_of(vec3_madd(cap, spread, -r1), vec3_madd(cap, spread, r1)));
}

static bool object_box(const Object *o, const Transform *place, Box3 *out);

static bool children_box(const Object *o, const Transform *place, Box3 *out) {
    bool common = o->kind == OBJECT_INTERSECTION;
    size_t count = o->kind == OBJECT_DIFFERENCE ? size_min(o->as.children.count, 1) : o->as.children.count;
    *out = box3_empty();
    for (size_t i = 0; i < count; i++) {
        Box3 b;
        if (!object_box(o->as.children.items[i], place, &b)) {
            if (common) continue;
            return false;
        }
        *out = common && !box3_is_empty(*out) ? (Box3){vec3_max(out->min, b.min), vec3_min(out->max, b.max)}
                                              : box3_union(*out, b);
    }
    return !box3_is_empty(*out);
}

static bool own_box(const Object *o, Box3 *out) {
    Vec3 r;
    switch (o->kind) {
    case OBJECT_SPHERE:
        r = vec3_splat(o->as.sphere.radius);
        *out = box_of(vec3_sub(o->as.sphere.center, r), vec3_add(o->as.sphere.center, r));
        return true;
    case OBJECT_BOX: *out = box_of(o->as.box.corner1, o->as.box.corner2); return true;
    case OBJECT_CYLINDER:
    case OBJECT_CONE:
        *out = cone_box(o->as.cone.base, o->as.cone.base_radius, o->as.cone.cap, o->as.cone.cap_radius);
        return true;
    case OBJECT_TORUS:
        r = vec3(o->as.torus.major_radius + o->as.torus.minor_radius, o->as.torus.minor_radius,
                 o->as.torus.major_radius + o->as.torus.minor_radius);
        *out = box_of(vec3_negate(r), r);
        return true;
    case OBJECT_DISC:
        /* POV-Ray gives it this thickness. */
        r = vec3_add(vec3_scale(circle_extent(o->as.disc.normal), o->as.disc.radius),
                     vec3_scale(o->as.disc.normal, 0.001));
        *out = box_of(vec3_sub(o->as.disc.center, r), vec3_add(o->as.disc.center, r));
        return true;
    case OBJECT_TRIANGLES:
        *out = box3_empty();
        for (size_t i = 0; i < o->as.mesh->vertex_count; i++)
            *out = box3_add_point(*out, o->as.mesh->vertices[i]);
        return true;
    case OBJECT_TEXEL: *out = o->as.texel->bounds; return true;
    default: return false;
    }
}

/* A sphere that is still one after `t`: its own box, not the box of its box. */
static bool placed_sphere(const Object *o, const Transform *t, Box3 *out) {
    if (o->kind != OBJECT_SPHERE) return false;
    double x = vec3_length(t->linear.c[0]), y = vec3_length(t->linear.c[1]), z = vec3_length(t->linear.c[2]);
    bool right_angles = fabs(vec3_dot(t->linear.c[0], t->linear.c[1])) +
                            fabs(vec3_dot(t->linear.c[0], t->linear.c[2])) +
                            fabs(vec3_dot(t->linear.c[1], t->linear.c[2])) <
                        1e-9 * x * x;
    if (fabs(x - y) + fabs(x - z) > 1e-9 * x || !right_angles) return false;
    Vec3 c = transform_point(t, o->as.sphere.center), r = vec3_splat(x * o->as.sphere.radius);
    *out = box_of(vec3_sub(c, r), vec3_add(c, r));
    return true;
}

static bool is_set(const Object *o) {
    return o->kind == OBJECT_UNION || o->kind == OBJECT_MERGE || o->kind == OBJECT_INTERSECTION ||
           o->kind == OBJECT_DIFFERENCE;
}

/* The box of the object placed by `place`: of sets, the boxes of their parts where they really are. False for what has no end. */
static bool object_box(const Object *o, const Transform *place, Box3 *out) {
    Transform t = transform_then(&o->transform, place);
    if (is_set(o)) return children_box(o, &t, out);
    if (placed_sphere(o, &t, out)) return true;
    if (!own_box(o, out)) return false;
    *out = box3_transform(&t, *out);
    return true;
}

static const Object *object_argument(Eval *ev, const Node *node) {
    Value v = eval_node(ev, node->as.list.items[0]);
    if (v.kind == VALUE_OBJECT) return v.as.object;
    if (v.kind != VALUE_ERROR)
        diag_error(ev->diags, node->as.list.items[0]->span, "expected an object, found %s",
                   value_kind_text(v.kind));
    return NULL;
}

static bool point_argument(Eval *ev, const Node *node, size_t i, Vec3 *out) {
    double c[3];
    Value v = eval_node(ev, node->as.list.items[i]);
    bool ok = value_to_vector(ev, &v, node->as.list.items[i]->span, c, 3);
    *out = vec3(c[0], c[1], c[2]);
    return ok;
}

static Value point_value(Eval *ev, Vec3 p) { return value_vector(ev, (double[]){p.x, p.y, p.z}, 3); }

/* trace(object, origin, direction [, normal]): the normal goes to a variable, <0,0,0> for a miss. */
static Value trace(Eval *ev, const Node *node, const Object *object) {
    Vec3 origin, direction, hit = {0}, normal = {0};
    if (!point_argument(ev, node, 1, &origin) || !point_argument(ev, node, 2, &direction))
        return value_error();
    const EvalGeometry *g = ev->options->geometry;
    if (!g->trace(g->context, object, origin, direction, &hit, &normal)) hit = normal = vec3_splat(0);
    if (node->as.list.count == 4) {
        bool failed = false;
        Slot *slot = eval_target(ev, node->as.list.items[3], &failed);
        Value v = point_value(ev, normal);
        if (slot)
            slot_set(ev, slot, &v);
        else if (!failed)
            eval_undeclared(ev, node->as.list.items[3]->as.name, node->as.list.items[3]->span);
    }
    return point_value(ev, hit);
}

Value eval_geometry(Eval *ev, const Node *node) {
    bool tracing = node->op == KW_trace;
    const EvalGeometry *g = ev->options->geometry;
    if (!builtin_argument_count(ev, node, tracing ? 3 : 2, tracing ? 4 : 2)) return value_error();
    const Object *object = object_argument(ev, node);
    if (!object) return value_error();
    if (!g || !(tracing ? g->trace != NULL : g->inside != NULL)) {
        diag_error(ev->diags, node->span, "%s() is not available here", keyword_text((Keyword)node->op));
        return value_error();
    }
    if (tracing) return trace(ev, node, object);
    Vec3 p;
    return point_argument(ev, node, 1, &p) ? value_float(g->inside(g->context, object, p)) : value_error();
}

Value eval_extent(Eval *ev, const Node *node) {
    if (!builtin_argument_count(ev, node, 1, 1)) return value_error();
    const Object *object = object_argument(ev, node);
    Box3 box;
    if (!object) return value_error();
    Transform place = transform_identity();
    if (!object_box(object, &place, &box)) box = (Box3){vec3_splat(-1e10), vec3_splat(1e10)};
    Vec3 p = node->op == KW_min_extent ? box.min : box.max;
    return value_vector(ev, (double[]){p.x, p.y, p.z}, 3);
}
