#include "shape/trace.h"

#include "scene/scene_hash.h"
#include "shape/box_tree.h"
#include "shape/solid.h"

enum {
    DEEPEST = 1000, /* sets within sets */
    TREE_FROM = 8,  /* children of a union that pay for a tree */
    FIRST_SLOTS = 64,
};
static const uint64_t MOST_VISITS =
    20000000; /* nodes that one question may touch: sets of sets of copies have no end */

typedef struct Core Core;

/* A place of a core: a child, or what was asked about. */
typedef struct Placed {
    Transform transform;
    bool singular;
    const Core *core;
} Placed;

typedef struct PlacedList {
    const Placed *items;
    size_t count;
} PlacedList;

/* What is prepared for a shape, in its own space. */
struct Core {
    Hash128 hash; /* object_shape_hash() */
    const Object *object;
    const SolidOps *ops;
    const void *data;
    Box3 bounds;                        /* own space, clips not regarded */
    PlacedList children, clips, guards; /* of a set; clipped_by; bounded_by */
    const BoxTree *tree;                /* over the children of large unions; or NULL */
    int depth;
};

struct ShapeTracer {
    Arena *arena;
    Core **slots;
    size_t slot_count, core_count;
};

/* ---- preparation ---- */

ShapeTracer *shape_tracer_create(Arena *arena) {
    ShapeTracer *tracer = arena_new(arena, ShapeTracer);
    tracer->arena = arena;
    tracer->slot_count = FIRST_SLOTS;
    tracer->slots = arena_new_array(arena, Core *, FIRST_SLOTS);
    return tracer;
}

static Core **find_slot(const ShapeTracer *tracer, Hash128 hash) {
    size_t i = hash.lo & (tracer->slot_count - 1);
    while (tracer->slots[i] && !hash_equal(tracer->slots[i]->hash, hash))
        i = (i + 1) & (tracer->slot_count - 1);
    return &tracer->slots[i];
}

static void remember(ShapeTracer *tracer, Core *core) {
    if (2 * tracer->core_count >= tracer->slot_count) {
        Core **old = tracer->slots;
        size_t old_count = tracer->slot_count;
        tracer->slot_count *= 2;
        tracer->slots = arena_new_array(tracer->arena, Core *, tracer->slot_count);
        for (size_t i = 0; i < old_count; i++)
            if (old[i]) *find_slot(tracer, old[i]->hash) = old[i];
    }
    *find_slot(tracer, core->hash) = core;
    tracer->core_count++;
}

static const Core *core_of(ShapeTracer *tracer, const Object *object, int depth);

static Placed placed_as(const Object *object, const Core *core) {
    Transform place = object_transform(object);
    return (Placed){place, transform_is_singular(&place), core};
}

static PlacedList place_all(ShapeTracer *tracer, const Object *const *items, size_t count, int depth) {
    Placed *placed = arena_new_array(tracer->arena, Placed, count);
    PlacedList list = {placed, 0};
    for (size_t i = 0; i < count; i++) {
        const Core *core = core_of(tracer, items[i], depth + 1);
        if (core) placed[list.count++] = placed_as(items[i], core);
    }
    return list;
}

static bool is_finite_box(Box3 box) { return vec3_is_finite(box.min) && vec3_is_finite(box.max); }

static Box3 infinite_box(void) { return (Box3){vec3_splat(-VTS_INFINITY), vec3_splat(VTS_INFINITY)}; }

/* An inverse solid reaches everywhere, but its surface does not. */
static Box3 placed_bounds(const Placed *placed) {
    Box3 box = placed->core->bounds;
    if (box3_is_empty(box)) return box;
    return is_finite_box(box) ? box3_transform(&placed->transform, box) : infinite_box();
}

static void gather_children(ShapeTracer *tracer, Core *core) {
    Box3 *boxes = arena_new_array(tracer->arena, Box3, core->children.count);
    core->bounds = box3_empty();
    core->depth = 0;
    for (size_t i = 0; i < core->children.count; i++) {
        boxes[i] = placed_bounds(&core->children.items[i]);
        core->bounds = box3_union(core->bounds, boxes[i]);
    }
    if (core->object->kind == OBJECT_UNION && core->children.count >= TREE_FROM)
        core->tree = box_tree_build(boxes, core->children.count, tracer->arena);
}

/* NULL for sets within sets without end. */
static const Core *core_of(ShapeTracer *tracer, const Object *object, int depth) {
    Hash128 hash = object_shape_hash(object);
    Core **slot = find_slot(tracer, hash);
    if (*slot) return depth + (*slot)->depth > DEEPEST ? NULL : *slot;
    if (depth > DEEPEST) return NULL;
    Core *core = arena_new(tracer->arena, Core);
    *core = (Core){.hash = hash,
                   .object = object,
                   .ops = solid_ops(object),
                   .data = object,
                   .bounds = box3_empty()};
    ObjectList clips = object_clipped_by(object), guards = object_bounded_by(object);
    core->clips = place_all(tracer, clips.items, clips.count, depth);
    core->guards = place_all(tracer, guards.items, guards.count, depth);
    if (object_has_group(object)) {
        core->children = place_all(tracer, object->as.group->items, object->as.group->count, depth);
        gather_children(tracer, core);
    } else if (core->ops->cross) {
        if (core->ops->prepare) core->data = core->ops->prepare(object, tracer->arena);
        if (core->data) core->bounds = core->ops->bounds(core->data);
    }
    const PlacedList lists[] = {core->children, core->clips, core->guards};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(lists); k++)
        for (size_t i = 0; i < lists[k].count; i++)
            core->depth = int_max(core->depth, 1 + lists[k].items[i].core->depth);
    remember(tracer, core);
    return core;
}

/* ---- inside ---- */

static bool core_inside(const Core *core, Vec3 p, uint64_t *budget);

static bool placed_inside(const Placed *placed, Vec3 p, uint64_t *budget) {
    if (placed->singular || *budget == 0) return false;
    (*budget)--;
    return core_inside(placed->core, transform_point_back(&placed->transform, p), budget);
}

/* How many children hold the point; stops when `enough` do. Of a difference the first counts as it is, the others count
 * where they do not hold it. */
static size_t children_holding(const Core *core, Vec3 p, size_t enough, uint64_t *budget) {
    size_t count = 0;
    bool difference = core->object->kind == OBJECT_DIFFERENCE;
    for (size_t i = 0; i < core->children.count && count < enough; i++)
        count += placed_inside(&core->children.items[i], p, budget) != (difference && i > 0);
    return count;
}

typedef struct PointSearch {
    const Core *core;
    Vec3 point;
    uint64_t *budget;
} PointSearch;

static bool try_child_inside(void *context, uint32_t item) {
    const PointSearch *search = context;
    return placed_inside(&search->core->children.items[item], search->point, search->budget);
}

/* The tree knows surfaces: what is inside out reaches further, and nothing of it is in the tree's reach. */
static bool has_inverse_child(const Core *core) {
    for (size_t i = 0; i < core->children.count; i++)
        if (core->children.items[i].core->object->inverse ||
            !is_finite_box(core->children.items[i].core->bounds))
            return true;
    return false;
}

static bool set_inside(const Core *core, Vec3 p, uint64_t *budget) {
    size_t count = core->children.count;
    if (core->object->kind == OBJECT_INTERSECTION || core->object->kind == OBJECT_DIFFERENCE)
        return count > 0 && children_holding(core, p, count, budget) == count;
    if (core->tree && !has_inverse_child(core))
        return box_tree_point(core->tree, p, try_child_inside, &(PointSearch){core, p, budget});
    return children_holding(core, p, 1, budget) > 0;
}

static bool core_inside(const Core *core, Vec3 p, uint64_t *budget) {
    bool inside = false;
    for (size_t i = 0; i < core->clips.count; i++)
        if (!placed_inside(&core->clips.items[i], p, budget)) return false;
    if (object_has_group(core->object))
        inside = set_inside(core, p, budget);
    else if (core->data && core->ops->inside)
        inside = core->ops->inside(core->data, p);
    return inside != core->object->inverse;
}

/* ---- rays ---- */

/* What the sets around a surface ask of a point of it, in their own space. */
typedef struct Filter {
    const struct Filter *outer;
    const Core *core;
    size_t child;
    Ray ray;
    enum { WITHIN_SIBLINGS, OUTSIDE_SIBLINGS, WITHIN_CLIPS } test;
} Filter;

typedef struct Search {
    double t_min;
    bool found;
    double t; /* of the nearest so far, or infinity */
    Vec3 normal;
    uint64_t budget;
} Search;

static bool passes(const Filter *filter, double t, uint64_t *budget) {
    const Core *core = filter->core;
    const PlacedList *list = filter->test == WITHIN_CLIPS ? &core->clips : &core->children;
    Vec3 p = vec3_madd(filter->ray.origin, filter->ray.direction, t);
    for (size_t i = 0; i < list->count; i++) {
        if (filter->test != WITHIN_CLIPS && i == filter->child) continue;
        bool wanted = filter->test != OUTSIDE_SIBLINGS;
        if (filter->test == WITHIN_SIBLINGS && core->object->kind == OBJECT_DIFFERENCE && i > 0)
            wanted = false;
        if (filter->test == OUTSIDE_SIBLINGS && core->object->kind == OBJECT_DIFFERENCE && i > 0)
            wanted = true;
        if (placed_inside(&list->items[i], p, budget) != wanted) return false;
    }
    return true;
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

static bool visit_leaf(Search *search, const Core *core, const Ray *ray, bool flipped,
                       const Filter *filters) {
    if (!core->data) return false;
    LeafSink sink = {
        .base = {search->t_min, search->t, take_crossing}, .filters = filters, .budget = &search->budget};
    core->ops->cross(core->data, ray, &sink.base);
    if (!sink.taken) return false;
    Vec3 point = vec3_madd(ray->origin, ray->direction, sink.base.t_max);
    search->t = sink.base.t_max;
    search->normal = core->ops->normal(core->data, point, &sink.tag);
    if (flipped && !core->ops->keeps_normal) search->normal = vec3_negate(search->normal);
    search->found = true;
    return true;
}

static bool visit_placed(Search *search, const Placed *placed, const Ray *parent_ray, bool flipped,
                         const Filter *filters);

typedef struct SetVisit {
    Search *search;
    const Core *core;
    const Ray *ray;
    bool flipped, filtered, found;
    Filter filter;
} SetVisit;

static void visit_child(void *context, uint32_t item) {
    SetVisit *visit = context;
    bool turned = visit->core->object->kind == OBJECT_DIFFERENCE && item > 0;
    visit->filter.child = item;
    if (visit_placed(visit->search, &visit->core->children.items[item], visit->ray, visit->flipped != turned,
                     visit->filtered ? &visit->filter : visit->filter.outer))
        visit->found = true;
}

/* Inside out, a union is an intersection of its children inside out: of its surfaces those in no other child remain. */
static bool visit_set(Search *search, const Core *core, const Ray *ray, bool flipped, const Filter *filters) {
    ObjectKind kind = core->object->kind;
    bool common = kind == OBJECT_INTERSECTION || kind == OBJECT_DIFFERENCE;
    SetVisit visit = {.search = search,
                      .core = core,
                      .ray = ray,
                      .flipped = flipped,
                      .filtered = common || flipped || kind == OBJECT_MERGE,
                      .filter = {filters, core, 0, *ray, common ? WITHIN_SIBLINGS : OUTSIDE_SIBLINGS}};
    if (core->tree) {
        box_tree_ray(core->tree, ray, search->t_min, &search->t, visit_child, &visit);
    } else {
        for (uint32_t i = 0; i < core->children.count; i++) visit_child(&visit, i);
    }
    return visit.found;
}

/* Whether the ray meets everything that bounds the object, however far, or starts in it. */
static bool meets_guards(Search *search, const Core *core, const Ray *ray) {
    for (size_t i = 0; i < core->guards.count; i++) {
        Search guard = {.t_min = 0, .t = VTS_INFINITY, .budget = search->budget};
        if (!placed_inside(&core->guards.items[i], ray->origin, &guard.budget) &&
            !visit_placed(&guard, &core->guards.items[i], ray, false, NULL))
            return false;
        search->budget = guard.budget;
    }
    return true;
}

/* The normal that is left in *search is one of the parent's space. */
static bool visit_placed(Search *search, const Placed *placed, const Ray *parent_ray, bool flipped,
                         const Filter *filters) {
    const Core *core = placed->core;
    if (placed->singular || search->budget == 0) return false;
    search->budget--;
    const Ray ray = {transform_point_back(&placed->transform, parent_ray->origin),
                     transform_vector_back(&placed->transform, parent_ray->direction)};
    double near = search->t_min, far = search->t;
    if (!box_tree_clip(&core->bounds, &ray, &near, &far) || !meets_guards(search, core, &ray)) return false;
    const Filter clip = {filters, core, 0, ray, WITHIN_CLIPS};
    if (core->clips.count) filters = &clip;
    bool found = (object_has_group(core->object) ? visit_set : visit_leaf)(search, core, &ray,
                                                                 flipped != core->object->inverse, filters);
    if (found) search->normal = vec3_normalize(transform_normal(&placed->transform, search->normal));
    return found;
}

/* ---- the questions ---- */

bool shape_trace(ShapeTracer *tracer, const Object *object, const Ray *ray, double t_min, TraceHit *hit) {
    const Core *core = core_of(tracer, object, 0);
    double length = vec3_length(ray->direction);
    if (!core || !vec3_is_finite(ray->origin) || !isfinite(length) || !(length > 0)) return false;
    const Placed placed = placed_as(object, core);
    Search search = {.t_min = t_min, .t = VTS_INFINITY, .budget = MOST_VISITS};
    if (!visit_placed(&search, &placed, ray, false, NULL)) return false;
    *hit = (TraceHit){search.t, vec3_madd(ray->origin, ray->direction, search.t), search.normal};
    return true;
}

bool shape_trace_inside(ShapeTracer *tracer, const Object *object, Vec3 point) {
    const Core *core = core_of(tracer, object, 0);
    const Placed placed = placed_as(object, core);
    uint64_t budget = MOST_VISITS;
    return core && vec3_is_finite(point) && placed_inside(&placed, point, &budget);
}

const void *shape_trace_data(ShapeTracer *tracer, const Object *object) {
    const Core *core = core_of(tracer, object, 0);
    return core ? core->data : NULL;
}

Box3 shape_trace_bounds(ShapeTracer *tracer, const Object *object) {
    const Core *core = core_of(tracer, object, 0);
    return core ? core->bounds : box3_empty();
}
