#include "scene/scene_hash.h"
#include "shape/body_parts.h"

enum {
    DEEPEST = 1000, /* sets within sets */
    TREE_FROM = 8,  /* children that pay for a tree */
    FIRST_SLOTS = 64,
};

struct ShapeTracer {
    Arena *arena;
    Body **slots;
    size_t slot_count, body_count;
};

ShapeTracer *shape_tracer_create(Arena *arena) {
    ShapeTracer *tracer = arena_new(arena, ShapeTracer);
    tracer->arena = arena;
    tracer->slot_count = FIRST_SLOTS;
    tracer->slots = arena_new_array(arena, Body *, FIRST_SLOTS);
    return tracer;
}

void shape_tracer_work(const ShapeTracer *tracer, SolidWork *sum) {
    for (size_t i = 0; i < tracer->slot_count; i++) {
        const Body *body = tracer->slots[i];
        if (body && body->data && body->ops->work) body->ops->work(body->data, sum);
    }
}

static Body **find_slot(const ShapeTracer *tracer, Hash128 hash) {
    size_t i = hash.lo & (tracer->slot_count - 1);
    while (tracer->slots[i] && !hash_equal(tracer->slots[i]->hash, hash)) i = (i + 1) & (tracer->slot_count - 1);
    return &tracer->slots[i];
}

static void remember(ShapeTracer *tracer, Body *body) {
    if (2 * tracer->body_count >= tracer->slot_count) {
        Body **old = tracer->slots;
        size_t old_count = tracer->slot_count;
        tracer->slot_count *= 2;
        tracer->slots = arena_new_array(tracer->arena, Body *, tracer->slot_count);
        for (size_t i = 0; i < old_count; i++)
            if (old[i]) *find_slot(tracer, old[i]->hash) = old[i];
    }
    *find_slot(tracer, body->hash) = body;
    tracer->body_count++;
}

static const Body *prepared(ShapeTracer *tracer, const Object *object, int depth);

static BodyPlaceList place_all(ShapeTracer *tracer, const Object *const *items, size_t count, int depth) {
    BodyPlace *placed = arena_new_array(tracer->arena, BodyPlace, count);
    BodyPlaceList list = {placed, 0};
    for (size_t i = 0; i < count; i++) {
        const Body *body = prepared(tracer, items[i], depth + 1);
        if (!body) continue;
        Transform place = object_transform(items[i]);
        placed[list.count++] = (BodyPlace){.transform = place, .identity = transform_is_identity(&place),
                                           .singular = transform_is_singular(&place), .index = (uint32_t)i, .body = body};
    }
    return list;
}

/* ---- boxes ---- */

static bool is_finite_box(Box3 box) { return vec3_is_finite(box.min) && vec3_is_finite(box.max); }
static Box3 infinite_box(void) { return (Box3){vec3_splat(-VTS_INFINITY), vec3_splat(VTS_INFINITY)}; }
static Box3 common(Box3 a, Box3 b) { return (Box3){vec3_max(a.min, b.min), vec3_min(a.max, b.max)}; }

static Box3 moved(const BodyPlace *placed, Box3 box) {
    if (box3_is_empty(box) || placed->identity) return box;
    if (placed->singular) return box3_empty();
    return is_finite_box(box) ? box3_transform(&placed->transform, box) : infinite_box();
}

static Box3 placed_bounds(const BodyPlace *placed) { return moved(placed, placed->body->bounds); }
static Box3 placed_reach(const BodyPlace *placed) { return moved(placed, placed->body->reach); }

/* Sheets have no inside; but a disc's is half of space. */
static Box3 leaf_reach(const Body *body) {
    if (body->object->kind == OBJECT_DISC || body->object->kind == OBJECT_PLANE) return infinite_box();
    return body->bounds;
}

static Box3 set_reach(const Body *body) {
    const BodyPlace *items = body->children.items;
    size_t count = body->children.count;
    ObjectKind kind = (ObjectKind)body->object->kind;
    bool all = kind == OBJECT_INTERSECTION;
    if (kind == OBJECT_DIFFERENCE) count = size_min(count, 1);
    if (count == 0) return box3_empty();
    Box3 box = placed_reach(&items[0]);
    for (size_t i = 1; i < count; i++) box = (all ? common : box3_union)(box, placed_reach(&items[i]));
    return box;
}

/* Of an intersection, or a difference, only what all of it reaches is left of its surfaces. */
static Box3 set_bounds(const Body *body, Box3 reach) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < body->children.count; i++) box = box3_union(box, placed_bounds(&body->children.items[i]));
    bool set = body->object->kind == OBJECT_INTERSECTION || body->object->kind == OBJECT_DIFFERENCE;
    return set ? common(box, reach) : box;
}

static void grow_tree(ShapeTracer *tracer, Body *body) {
    ObjectKind kind = (ObjectKind)body->object->kind;
    size_t first = kind == OBJECT_DIFFERENCE ? 1 : 0, count = body->children.count;
    if (kind == OBJECT_INTERSECTION || count < first + TREE_FROM) return;
    Box3 *boxes = arena_new_array(tracer->arena, Box3, count - first);
    body->tree_holds = true;
    for (size_t i = first; i < count; i++) {
        Box3 reach = placed_reach(&body->children.items[i]);
        boxes[i - first] = placed_bounds(&body->children.items[i]);
        if (is_finite_box(reach) || box3_is_empty(reach))
            boxes[i - first] = box3_union(boxes[i - first], reach);
        else
            body->tree_holds = false;
    }
    body->tree = box_tree_build(boxes, count - first, tracer->arena);
    body->tree_first = (uint32_t)first;
}

/* What clips takes from the surface and from the inside; what is inside out reaches everywhere. */
static void finish_boxes(Body *body) {
    body->whole = body->bounds;
    for (size_t i = 0; i < body->clips.count; i++) {
        Box3 reach = placed_reach(&body->clips.items[i]);
        body->bounds = common(body->bounds, reach);
        body->reach = common(body->reach, reach);
    }
    if (box3_is_empty(body->bounds)) body->bounds = box3_empty();
    if (box3_is_empty(body->reach)) body->reach = box3_empty();
    if (body->object->inverse) body->reach = infinite_box();
}

/* ---- bodies ---- */

static const Body *prepared(ShapeTracer *tracer, const Object *object, int depth) {
    Hash128 hash = object_shape_hash(object);
    Body **slot = find_slot(tracer, hash);
    if (*slot) return depth + (*slot)->depth > DEEPEST ? NULL : *slot;
    if (depth > DEEPEST) return NULL;
    Body *body = arena_new(tracer->arena, Body);
    *body = (Body){.hash = hash, .object = object, .ops = solid_ops(object), .data = object, .bounds = box3_empty(), .reach = box3_empty()};
    ObjectList clips = object_clipped_by(object), guards = object_bounded_by(object);
    body->clips = place_all(tracer, clips.items, clips.count, depth);
    body->guards = place_all(tracer, guards.items, guards.count, depth);
    if (object_has_group(object)) {
        body->data = NULL;
        body->children = place_all(tracer, object->as.group->items, object->as.group->count, depth);
        body->reach = set_reach(body);
        body->bounds = set_bounds(body, body->reach);
        grow_tree(tracer, body);
    } else if (body->ops->cross) {
        if (body->ops->prepare) body->data = body->ops->prepare(object, tracer->arena);
        if (body->data) body->bounds = body->ops->bounds(body->data);
        if (body->data) body->reach = leaf_reach(body);
    } else {
        body->data = NULL;
    }
    finish_boxes(body);
    const BodyPlaceList lists[] = {body->children, body->clips, body->guards};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(lists); k++)
        for (size_t i = 0; i < lists[k].count; i++) body->depth = int_max(body->depth, 1 + lists[k].items[i].body->depth);
    remember(tracer, body);
    return body;
}

const Body *body_of(ShapeTracer *tracer, const Object *object) { return prepared(tracer, object, 0); }
Box3 body_bounds(const Body *body) { return body->bounds; }
Box3 shape_trace_bounds(ShapeTracer *tracer, const Object *object) {
    const Body *body = body_of(tracer, object);
    return body ? body->whole : box3_empty();
}
const void *shape_trace_data(ShapeTracer *tracer, const Object *object) {
    const Body *body = body_of(tracer, object);
    return body ? body->data : NULL;
}
const void *body_data(const Body *body) { return body->data; }
