/* What the language asks of objects: min_extent(), max_extent(), trace(), inside(). */
#include "eval/eval_state.h"

static const Object *object_of(Eval *ev, const Value *v, Span span) {
    if (v->kind == VALUE_OBJECT) return v->as.object;
    if (v->kind != VALUE_ERROR)
        diag_error(ev->diags, span, "expected an object, found %s", value_kind_text(v->kind));
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
    Value v = eval_node(ev, node->as.list.items[0]);
    const Object *object = object_of(ev, &v, node->as.list.items[0]->span);
    if (!object) return value_error();
    if (!g || !(tracing ? g->trace != NULL : g->inside != NULL)) {
        diag_error(ev->diags, node->span, "%s() is not available here", keyword_text((Keyword)node->op));
        return value_error();
    }
    if (tracing) return trace(ev, node, object);
    Vec3 p;
    return point_argument(ev, node, 1, &p) ? value_float(g->inside(g->context, object, p)) : value_error();
}

/* A light is everywhere: POV-Ray's largest box. */
static Value endless(Eval *ev, const Node *node) {
    double far = node->op == KW_min_extent ? -1e10 : 1e10;
    return value_vector(ev, (double[]){far, far, far}, 3);
}

Value eval_extent(Eval *ev, const Node *node) {
    if (!builtin_argument_count(ev, node, 1, 1)) return value_error();
    Value v = eval_node(ev, node->as.list.items[0]);
    if (v.kind == VALUE_LIGHT) return endless(ev, node);
    const Object *object = object_of(ev, &v, node->as.list.items[0]->span);
    const EvalGeometry *g = ev->options->geometry;
    if (!object) return value_error();
    if (!g || !g->extent) {
        diag_error(ev->diags, node->span, "%s() is not available here", keyword_text((Keyword)node->op));
        return value_error();
    }
    Box3 box = g->extent(g->context, object);
    Vec3 p = node->op == KW_min_extent ? box.min : box.max;
    return value_vector(ev, (double[]){p.x, p.y, p.z}, 3);
}
