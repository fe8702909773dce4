#include "shape/body_parts.h"

/* Nodes that one question may touch: sets of sets of copies have no end. */
static const uint64_t MOST_VISITS = 20000000;

/* ---- inside ---- */

static bool holds(const Body *body, Vec3 p, uint64_t *budget);

static bool place_holds(const BodyPlace *placed, Vec3 p, uint64_t *budget) {
    if (placed->singular || *budget == 0) return false;
    (*budget)--;
    return holds(placed->body, placed->identity ? p : transform_point_back(&placed->transform, p), budget);
}

static const size_t NO_CHILD = SIZE_MAX;

typedef struct PointSearch {
    const Body *body;
    Vec3 point;
    size_t but;
    uint64_t *budget;
} PointSearch;

static bool try_child(void *context, uint32_t item) {
    const PointSearch *search = context;
    size_t child = item + search->body->tree_first;
    return child != search->but && place_holds(&search->body->children.items[child], search->point, search->budget);
}

/* Whether one of the children from `first` on, but not `but`, holds the point. */
static bool any_holds(const Body *body, size_t first, Vec3 p, size_t but, uint64_t *budget) {
    if (body->tree && body->tree_holds && first == body->tree_first)
        return box_tree_point(body->tree, p, try_child, &(PointSearch){body, p, but, budget});
    for (size_t i = first; i < body->children.count; i++)
        if (i != but && place_holds(&body->children.items[i], p, budget)) return true;
    return false;
}

/* Whether all children of an intersection but one hold the point; of a difference the first holds it and no other does. */
static bool all_hold(const Body *body, Vec3 p, size_t but, uint64_t *budget) {
    const BodyPlaceList *list = &body->children;
    if (body->object->kind == OBJECT_DIFFERENCE) {
        if (but != 0 && !place_holds(&list->items[0], p, budget)) return false;
        return !any_holds(body, 1, p, but, budget);
    }
    for (size_t i = 0; i < list->count; i++)
        if (i != but && !place_holds(&list->items[i], p, budget)) return false;
    return true;
}

static bool is_common(const Body *body) {
    return body->object->kind == OBJECT_INTERSECTION || body->object->kind == OBJECT_DIFFERENCE;
}

static bool set_holds(const Body *body, Vec3 p, uint64_t *budget) {
    if (is_common(body)) return body->children.count > 0 && all_hold(body, p, NO_CHILD, budget);
    return any_holds(body, 0, p, NO_CHILD, budget);
}

static bool clips_hold(const Body *body, Vec3 p, uint64_t *budget) {
    for (size_t i = 0; i < body->clips.count; i++)
        if (!place_holds(&body->clips.items[i], p, budget)) return false;
    return true;
}

static bool box_holds(const Box3 *b, Vec3 p) {
    return p.x >= b->min.x && p.x <= b->max.x && p.y >= b->min.y && p.y <= b->max.y && p.z >= b->min.z && p.z <= b->max.z;
}

static bool holds(const Body *body, Vec3 p, uint64_t *budget) {
    bool inside = false;
    if (!clips_hold(body, p, budget)) return false;
    if (object_has_group(body->object))
        inside = (body->object->inverse || box_holds(&body->reach, p)) && set_holds(body, p, budget);
    else if (body->data && body->ops->inside)
        inside = body->ops->inside(body->data, p);
    return inside != body->object->inverse;
}

bool body_inside(const Body *body, Vec3 point) {
    uint64_t budget = MOST_VISITS;
    return vec3_is_finite(point) && holds(body, point, &budget);
}

/* ---- textures of what holds a point ---- */

typedef struct TextureSearch {
    BodyTexture *out;
    size_t count, most;
    uint64_t budget;
} TextureSearch;

static bool has_texture(const Object *object) {
    return object->texture || (object->kind == OBJECT_TRIANGLES && object->as.mesh->triangle_textures);
}

static void gather_textures(TextureSearch *search, const Body *body, const Object *object, Vec3 p, const BodyTexture *outer, const Transform *place) {
    const BodyTexture own = object->texture ? (BodyTexture){object->texture, *place} : *outer;
    if (!object_has_group(object)) {
        if (own.texture && search->count < search->most) search->out[search->count++] = own;
        return;
    }
    size_t count = object->kind == OBJECT_DIFFERENCE && body->children.count ? 1 : body->children.count;
    for (size_t i = 0; i < count && search->count < search->most && search->budget; i++) {
        const BodyPlace *child = &body->children.items[i];
        if (!place_holds(child, p, &search->budget)) continue;
        const Transform inner = transform_then(&child->transform, place);
        gather_textures(search, child->body, object->as.group->items[child->index], transform_point_back(&child->transform, p), &own, &inner);
    }
}

size_t body_textures(const Body *body, const Object *object, Vec3 point, BodyTexture *out, size_t most) {
    TextureSearch search = {out, 0, most, MOST_VISITS};
    const Transform identity = transform_identity();
    gather_textures(&search, body, object, point, &(BodyTexture){NULL, identity}, &identity);
    return search.count;
}

/* ---- rays ---- */

/* What the sets around a surface ask of a point of it, in their own space. */
typedef struct Filter {
    const struct Filter *outer;
    const Body *body;
    size_t child;
    Ray ray;
    enum { WITHIN_SIBLINGS, OUTSIDE_SIBLINGS, WITHIN_CLIPS } test;
} Filter;

/* The objects around a surface, with their places; the innermost first. */
typedef struct Trail {
    const struct Trail *outer;
    const Object *object;
    const Body *body;
    const Transform *place; /* NULL: the same space */
} Trail;

typedef struct Search {
    double t_min;
    BodyHit *hit; /* the nearest so far: its t */
    bool any;     /* whatever is met will do, and nothing is asked about it */
    RayWidth width;
    uint64_t budget;
} Search;

typedef struct Visit {
    Search *search;
    bool flipped;
    const Filter *filters;
    const Trail *trail;
} Visit;

/* Seen from inside a difference that is turned inside out, what is outside the rest of it counts. */
static bool passes(const Filter *filter, double t, uint64_t *budget) {
    const Body *body = filter->body;
    Vec3 p = vec3_madd(filter->ray.origin, filter->ray.direction, t);
    switch (filter->test) {
    case WITHIN_CLIPS: return clips_hold(body, p, budget);
    case WITHIN_SIBLINGS: return all_hold(body, p, filter->child, budget);
    case OUTSIDE_SIBLINGS: break;
    }
    return !any_holds(body, 0, p, filter->child, budget);
}

typedef struct LeafSink {
    SolidSink base;
    const Filter *filters;
    uint64_t *budget;
    bool taken;
    SolidTag tag;
} LeafSink;

static void take_crossing(SolidSink *base, double t, const SolidTag *tag) {
    LeafSink *sink = (LeafSink *)(void *)base;
    for (const Filter *f = sink->filters; f; f = f->outer)
        if (!passes(f, t, sink->budget)) return;
    base->t_max = t;
    sink->taken = true;
    sink->tag = *tag;
}

static Vec3 moved_normal(const Transform *place, Vec3 normal) {
    return place ? vec3_normalize(transform_normal(place, normal)) : normal;
}

static void place_leaf(const Trail *trail, BodyHit *hit) {
    hit->leaf_place = transform_identity();
    for (; trail; trail = trail->outer)
        if (trail->place) hit->leaf_place = transform_then(&hit->leaf_place, trail->place);
}

/* What the objects around the surface add, from the inside out. */
static void walk_trail(const Trail *trail, BodyHit *hit) {
    hit->looked = hit->filled = hit->cut_object = NULL;
    hit->cut = NULL;
    hit->looked_place = transform_identity();
    hit->hollow = false;
    bool placed = false; /* where the interior is matters */
    for (; trail; trail = trail->outer) {
        if (!hit->looked && has_texture(trail->object)) hit->looked = trail->object;
        if (!hit->looked && trail->object->cutaway) {
            hit->cut = trail->body;
            hit->cut_object = trail->object;
            hit->cut_place = transform_identity();
        }
        const ObjectRest *rest = trail->object->rest;
        hit->hollow |= rest && rest->hollow;
        if (!hit->filled && rest && rest->interior) {
            hit->filled = trail->object;
            placed = rest->interior->media.count > 0;
            if (placed) hit->filled_place = transform_identity();
        }
        if (!trail->place) continue;
        hit->normal = moved_normal(trail->place, hit->normal);
        hit->flat = moved_normal(trail->place, hit->flat);
        if (hit->looked) hit->looked_place = transform_then(&hit->looked_place, trail->place);
        if (hit->cut) hit->cut_place = transform_then(&hit->cut_place, trail->place);
        if (placed) hit->filled_place = transform_then(&hit->filled_place, trail->place);
    }
}

static bool visit_leaf(const Visit *visit, const Body *body, const Ray *ray) {
    BodyHit *hit = visit->search->hit;
    if (!body->data) return false;
    LeafSink sink = {.base = {visit->search->t_min, hit->t, visit->search->width, take_crossing}, .filters = visit->filters, .budget = &visit->search->budget};
    body->ops->cross(body->data, ray, &sink.base);
    if (!sink.taken || visit->search->any) return sink.taken;
    hit->t = sink.base.t_max;
    hit->leaf = visit->trail->object;
    hit->data = body->data;
    hit->tag = sink.tag;
    hit->place = vec3_madd(ray->origin, ray->direction, hit->t);
    hit->normal = body->ops->normal(body->data, hit->place, &sink.tag);
    hit->flat = body->ops->flat ? body->ops->flat(body->data, hit->place, &sink.tag) : hit->normal;
    if (visit->flipped && !body->ops->keeps_normal) {
        hit->normal = vec3_negate(hit->normal);
        hit->flat = vec3_negate(hit->flat);
    }
    walk_trail(visit->trail, hit);
    size_t count;
    if (object_textured_parts(hit->leaf, &count)) place_leaf(visit->trail, hit);
    return true;
}

static bool visit_place(const Visit *visit, const BodyPlace *placed, const Object *object, const Ray *ray);

typedef struct SetVisit {
    Visit visit;
    const Body *body;
    const Object *const *objects;
    const Ray *ray;
    bool filtered, found;
    Filter filter;
} SetVisit;

static void visit_child(SetVisit *set, uint32_t child) {
    bool turned = set->body->object->kind == OBJECT_DIFFERENCE && child > 0;
    Visit visit = set->visit;
    const BodyPlace *placed = &set->body->children.items[child];
    set->filter.child = child;
    visit.flipped = visit.flipped != turned;
    if (set->filtered) visit.filters = &set->filter;
    if (visit_place(&visit, placed, set->objects[placed->index], set->ray)) set->found = true;
}

static void visit_item(void *context, uint32_t item) {
    SetVisit *set = context;
    if (set->found && set->visit.search->any) return;
    visit_child(set, item + set->body->tree_first);
}

/* Inside out, a union is an intersection of its children inside out: of its surfaces those in no other child remain. */
static bool visit_set(const Visit *visit, const Body *body, const Ray *ray) {
    bool common = is_common(body);
    SetVisit set = {.visit = *visit,
                    .body = body,
                    .objects = visit->trail->object->as.group->items,
                    .ray = ray,
                    .filtered = common || visit->flipped || body->object->kind == OBJECT_MERGE,
                    .filter = {visit->filters, body, 0, *ray, common ? WITHIN_SIBLINGS : OUTSIDE_SIBLINGS}};
    size_t plain = body->tree ? body->tree_first : body->children.count;
    for (uint32_t i = 0; i < plain && !(set.found && visit->search->any); i++) visit_child(&set, i);
    if (body->tree && !(set.found && visit->search->any)) box_tree_ray(body->tree, ray, visit->search->t_min, &visit->search->hit->t, visit_item, &set);
    return set.found;
}

/* Whether the ray meets everything that bounds the object, however far, or starts in it. */
static bool meets_guards(Search *search, const Body *body, const Object *object, const Ray *ray) {
    ObjectList guards = object_bounded_by(object);
    for (size_t i = 0; i < body->guards.count; i++) {
        const BodyPlace *placed = &body->guards.items[i];
        BodyHit nearest = {.t = VTS_INFINITY};
        Search guard = {.t_min = 0, .hit = &nearest, .budget = search->budget};
        const Visit visit = {.search = &guard};
        if (!place_holds(placed, ray->origin, &guard.budget) && !visit_place(&visit, placed, guards.items[placed->index], ray))
            return false;
        search->budget = guard.budget;
    }
    return true;
}

/* Meeting it costs no more than meeting its box. */
static bool is_simple(const Object *object) {
    return object->kind == OBJECT_BOX || object->kind == OBJECT_SPHERE || object->kind == OBJECT_PLANE || object->kind == OBJECT_DISC;
}

static bool visit_body(const Visit *outer, const Body *body, const Object *object, const Transform *place, const Ray *ray) {
    Search *search = outer->search;
    if (search->budget == 0) return false;
    search->budget--;
    double near = search->t_min, far = search->hit->t;
    if ((!is_simple(object) && !box_tree_clip(&body->bounds, ray, &near, &far)) || !meets_guards(search, body, object, ray)) return false;
    const Filter clip = {outer->filters, body, 0, *ray, WITHIN_CLIPS};
    const Trail trail = {outer->trail, object, body, place};
    const Visit visit = {.search = search,
                         .flipped = outer->flipped != object->inverse,
                         .filters = body->clips.count ? &clip : outer->filters,
                         .trail = &trail};
    return (object_has_group(object) ? visit_set : visit_leaf)(&visit, body, ray);
}

static bool visit_place(const Visit *visit, const BodyPlace *placed, const Object *object, const Ray *ray) {
    if (placed->singular) return false;
    if (placed->identity) return visit_body(visit, placed->body, object, NULL, ray);
    const Ray local = {transform_point_back(&placed->transform, ray->origin), transform_vector_back(&placed->transform, ray->direction)};
    return visit_body(visit, placed->body, object, &placed->transform, &local);
}

bool body_meet_wide(const Body *body, const Object *object, const Ray *ray, RayWidth width, double t_min, double t_max, BodyHit *hit) {
    hit->t = t_max;
    Search search = {.t_min = t_min, .hit = hit, .width = width, .budget = MOST_VISITS};
    const Visit visit = {.search = &search};
    return visit_body(&visit, body, object, NULL, ray);
}

bool body_crosses_wide(const Body *body, const Object *object, const Ray *ray, RayWidth width, double t_min, double t_max) {
    BodyHit nearest;
    nearest.t = t_max;
    Search search = {.t_min = t_min, .hit = &nearest, .any = true, .width = width, .budget = MOST_VISITS};
    const Visit visit = {.search = &search};
    return visit_body(&visit, body, object, NULL, ray);
}

bool body_meet(const Body *body, const Object *object, const Ray *ray, double t_min, double t_max, BodyHit *hit) {
    return body_meet_wide(body, object, ray, (RayWidth){0, 0}, t_min, t_max, hit);
}

bool body_crosses(const Body *body, const Object *object, const Ray *ray, double t_min, double t_max) {
    return body_crosses_wide(body, object, ray, (RayWidth){0, 0}, t_min, t_max);
}
