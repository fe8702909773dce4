/* terrain_height(TERRAIN, POINT): how high the ground is there. */
#include "eval/eval_function.h"

/* A terrain, or a surface made of one, and its place in the scene. NULL: the value is none. */
static const Terrain *terrain_of(const Value *v, Transform *place) {
    const Surface *surface = v->kind == VALUE_SURFACE ? v->as.surface : NULL;
    *place = transform_identity();
    if (v->kind == VALUE_OBJECT && v->as.object->kind == OBJECT_SURFACE) {
        surface = v->as.object->as.surface;
        *place = object_transform(v->as.object);
    }
    if (!surface || surface->kind != SURFACE_TERRAIN) return NULL;
    *place = transform_then(&surface->transform, place);
    return surface->terrain;
}

/* Upright terrains answer for the scene's own verticals; one that was turned is met by a vertical line, from above. */
static bool height_in_scene(const Terrain *terrain, const Transform *place, Vec3 p, double *out) {
    if (transform_is_singular(place)) return false;
    Vec3 up = place->linear.c[1], local = transform_point_back(place, p);
    if (up.x == 0 && up.z == 0) {
        double y;
        if (!terrain->ops->height(terrain->ground, local, &y)) return false;
        *out = transform_point(place, vec3(local.x, y, local.z)).y;
        return true;
    }
    Box3 box = box3_transform(place, terrain->bounds);
    const Ray ray = {transform_point_back(place, vec3(p.x, box.max.y + 1, p.z)), transform_vector_back(place, vec3(0, -1, 0))};
    double t;
    if (!terrain->ops->meet(terrain->ground, &ray, 0, box.max.y - box.min.y + 2, &t)) return false;
    *out = box.max.y + 1 - t;
    return true;
}

Value eval_terrain_height(Eval *ev, const Node *call) {
    const NodeList *list = &call->as.apply.list;
    Value value = eval_node(ev, list->items[0]), point = eval_node(ev, list->items[1]);
    Transform place;
    double p[3], y = 0;
    if (value.kind == VALUE_ERROR || point.kind == VALUE_ERROR) return value_error();
    const Terrain *terrain = terrain_of(&value, &place);
    if (!terrain) {
        diag_error(ev->diags, list->items[0]->span, "expected a terrain, found %s",
                   value.kind == VALUE_OBJECT ? "another object" : value_kind_text(value.kind));
        return value_error();
    }
    if (!value_to_vector(ev, &point, list->items[1]->span, p, 3)) return value_error();
    if (!height_in_scene(terrain, &place, vec3(p[0], p[1], p[2]), &y))
        diag_warning(ev->diags, call->span, "there is no ground at <%g, %g, %g>: 0 is taken for its height", p[0], p[1], p[2]);
    return value_float(y);
}
