#include "shape/set_tree.h"

#include "shape/intersect.h"
#include "shape/set_bounds.h"

/* ---- building ---- */

typedef struct Builder {
    SetTree *tree;
    ShapeTracer *tracer;
    Arena *arena;
    bool full;
} Builder;

/* What parts get from the sets around them. */
typedef struct Around {
    Transform to_root;
    const Texture *texture;
    Transform texture_place;
    bool hidden;
} Around;

static uint32_t reserve_nodes(Builder *b, size_t count) {
    size_t first = b->tree->node_count;
    while (b->tree->node_capacity < first + count)
        arena_list_grow_(b->arena, (void **)&b->tree->nodes, &b->tree->node_capacity, b->tree->node_count,
                         sizeof *b->tree->nodes);
    for (size_t i = 0; i < count; i++) b->tree->nodes[first + i] = (SetNode){.bounds = box3_empty()};
    b->tree->node_count += count;
    return (uint32_t)first;
}

static void fill_node(Builder *b, uint32_t index, const Object *object, const Around *outer);

static Around around(const Object *object, const Around *outer) {
    Transform own = object_transform(object);
    Around inner = *outer;
    inner.to_root = transform_then(&own, &outer->to_root);
    if (object->texture) {
        inner.texture = object->texture;
        inner.texture_place = inner.to_root;
    }
    return inner;
}

static void add_leaf(Builder *b, SetNode *node, const Object *object, const Around *here) {
    SetTree *tree = b->tree;
    if (tree->leaf_count == tree->leaf_capacity)
        arena_list_grow_(b->arena, (void **)&tree->leaves, &tree->leaf_capacity, tree->leaf_count, sizeof *tree->leaves);
    if (tree->leaf_count >= SET_MOST_LEAVES) b->full = true;
    SetLeaf leaf = {.object = object, .ops = solid_ops(object), .to_root = here->to_root, .texture = here->texture,
                    .texture_place = here->texture_place, .hidden = here->hidden,
                    .singular = transform_is_singular(&here->to_root)};
    if (leaf.ops->cross) leaf.data = shape_trace_data(b->tracer, object);
    node->kind = SET_LEAF;
    node->bounds = set_leaf_bounds(&leaf);
    if (!b->full) tree->leaves[tree->leaf_count++] = leaf;
}

/* Nodes move while their parts are added: by number, and put back as a whole. */
static void fill_parts(Builder *b, SetNode *node, const Object *const *items, size_t count, const Around *here) {
    node->first_child = reserve_nodes(b, count);
    node->child_count = (uint32_t)count;
    for (size_t i = 0; i < count && !b->full; i++)
        fill_node(b, node->first_child + (uint32_t)i, items[i], here);
}

static bool is_field_solid(const Object *object, SolidKind kind) {
    return object->kind == OBJECT_SOLID && object->as.solid->kind == kind;
}

/* A closed isosurface is its field and its container, which both show. */
static void fill_isosurface(Builder *b, SetNode *node, const Object *object, const Around *here) {
    Around inner = *here;
    inner.hidden |= object->as.solid->as.isosurface.open;
    const Object *container = object->as.solid->as.isosurface.container;
    node->kind = SET_ALL;
    node->first_child = reserve_nodes(b, 2);
    node->child_count = 2;
    fill_node(b, node->first_child, container, &inner);
    SetNode field = {.leaf_begin = (uint32_t)b->tree->leaf_count};
    add_leaf(b, &field, object, here);
    field.leaf_end = (uint32_t)b->tree->leaf_count;
    b->tree->nodes[node->first_child + 1] = field;
}

static void fill_clips(Builder *b, SetNode *node, const Object *object, const Around *here) {
    Around inner = *here;
    inner.hidden = true;
    ObjectList clips = object_clipped_by(object);
    const Object *container = is_field_solid(object, SOLID_PARAMETRIC) ? object->as.solid->as.parametric.container : NULL;
    node->first_clip = reserve_nodes(b, clips.count + (container != NULL));
    node->clip_count = (uint32_t)clips.count + (container != NULL);
    for (size_t i = 0; i < clips.count && !b->full; i++)
        fill_node(b, node->first_clip + (uint32_t)i, clips.items[i], &inner);
    if (container) fill_node(b, node->first_clip + (uint32_t)clips.count, container, &inner);
}

/* Of what has no end that is known, `bounded_by` tells it. */
static Box3 bounded_box(const Object *object, const Transform *to_root) {
    ObjectList guards = object_bounded_by(object);
    Box3 box = shape_bounds_infinite();
    for (size_t i = 0; i < guards.count; i++) {
        Transform own = object_transform(guards.items[i]), whole = transform_then(&own, to_root);
        Box3 guard = shape_bounds(guards.items[i]);
        if (set_box_is_finite(guard) && !guards.items[i]->inverse) box = set_box_common(box, box3_transform(&whole, guard));
    }
    return box;
}

static void fill_node(Builder *b, uint32_t index, const Object *object, const Around *outer) {
    const Around here = around(object, outer);
    SetNode node = {.leaf_begin = (uint32_t)b->tree->leaf_count, .inverse = object->inverse};
    if (object_has_group(object)) {
        bool all = object->kind == OBJECT_INTERSECTION || object->kind == OBJECT_DIFFERENCE;
        node.kind = all ? SET_ALL : SET_ANY;
        node.difference = object->kind == OBJECT_DIFFERENCE;
        fill_parts(b, &node, object->as.group->items, object->as.group->count, &here);
    } else if (is_field_solid(object, SOLID_ISOSURFACE)) {
        fill_isosurface(b, &node, object, &here);
    } else {
        add_leaf(b, &node, object, &here);
    }
    fill_clips(b, &node, object, &here);
    node.leaf_end = (uint32_t)b->tree->leaf_count;
    if (node.kind != SET_LEAF) node.bounds = set_group_bounds(b->tree, &node);
    if (!node.inverse) node.bounds = set_outer_bounds(b->tree, &node);
    if (!set_box_is_finite(node.bounds)) node.bounds = set_box_common(node.bounds, bounded_box(object, &here.to_root));
    b->tree->nodes[index] = node;
}

bool set_tree_build(const Object *object, const Transform *place, ShapeTracer *tracer, Arena *arena, SetTree *out) {
    *out = (SetTree){0};
    Builder b = {out, tracer, arena, false};
    Around outer = {.to_root = *place};
    Transform own = object_transform(object);
    outer.texture_place = transform_then(&own, place);
    uint32_t root = reserve_nodes(&b, 1);
    fill_node(&b, root, object, &outer);
    if (b.full) return false;
    out->bounds = set_outer_bounds(out, &out->nodes[0]);
    return true;
}

/* ---- inside ---- */

/* `inverse` not regarded. */
static bool leaf_holds(const SetLeaf *leaf, Vec3 point) {
    if (leaf->singular || !leaf->data || !leaf->ops->inside) return false;
    return leaf->ops->inside(leaf->data, transform_point_back(&leaf->to_root, point));
}

static bool in_box(const Box3 *box, Vec3 p) {
    return p.x >= box->min.x && p.y >= box->min.y && p.z >= box->min.z && p.x <= box->max.x && p.y <= box->max.y &&
           p.z <= box->max.z;
}

static bool holds(const SetTree *tree, const SetNode *node, Vec3 p);

static bool child_holds(const SetTree *tree, const SetNode *node, uint32_t child, Vec3 p) {
    return holds(tree, &tree->nodes[node->first_child + child], p) != (node->difference && child > 0);
}

static bool clips_hold(const SetTree *tree, const SetNode *node, Vec3 p) {
    for (uint32_t i = 0; i < node->clip_count; i++)
        if (!holds(tree, &tree->nodes[node->first_clip + i], p)) return false;
    return true;
}

static bool group_holds(const SetTree *tree, const SetNode *node, Vec3 p) {
    bool all = node->kind == SET_ALL;
    for (uint32_t i = 0; i < node->child_count; i++)
        if (child_holds(tree, node, i, p) != all) return !all;
    return all && node->child_count > 0;
}

static bool holds(const SetTree *tree, const SetNode *node, Vec3 p) {
    bool inside = false;
    if (in_box(&node->bounds, p))
        inside = node->kind == SET_LEAF ? leaf_holds(&tree->leaves[node->leaf_begin], p) : group_holds(tree, node, p);
    return inside != node->inverse && clips_hold(tree, node, p);
}

bool set_tree_inside(const SetTree *tree, Vec3 point) { return holds(tree, &tree->nodes[0], point); }

/* ---- sides of surfaces ---- */

typedef struct Probe {
    const SetTree *tree;
    uint32_t leaf;
    Vec3 point, normal;
} Probe;

/* Whether a region holds the places just inside and just outside the surface. */
typedef struct Sides {
    bool within, beyond;
} Sides;

static Vec3 shifted(const Probe *probe, double steps) {
    return vec3_madd(probe->point, probe->normal, steps * probe->tree->coincide);
}

/* Where surfaces coincide, of two children of an intersection the earlier counts as slightly smaller, of two of a union as
 * slightly larger: so exactly one is kept where they lie back to back or cancel, and none twice. */
static bool sibling_holds(const Probe *probe, const SetNode *node, uint32_t child, uint32_t path, double outward) {
    bool all = node->kind == SET_ALL;
    if (child > path) return child_holds(probe->tree, node, child, shifted(probe, all ? -outward : outward));
    bool one = child_holds(probe->tree, node, child, shifted(probe, 1));
    return one == all ? child_holds(probe->tree, node, child, shifted(probe, -1)) : one;
}

static uint32_t child_with_leaf(const SetTree *tree, const SetNode *node, uint32_t leaf) {
    uint32_t lo = 0, hi = node->child_count;
    while (lo + 1 < hi) {
        uint32_t middle = (lo + hi) / 2;
        if (tree->nodes[node->first_child + middle].leaf_begin <= leaf)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

static Sides sides_of(const Probe *probe, const SetNode *node);

static Sides group_sides(const Probe *probe, const SetNode *node) {
    uint32_t path = child_with_leaf(probe->tree, node, probe->leaf);
    Sides sides = sides_of(probe, &probe->tree->nodes[node->first_child + path]);
    if (sides.within == sides.beyond) return sides;
    if (node->difference && path > 0) sides = (Sides){!sides.within, !sides.beyond};
    bool all = node->kind == SET_ALL;
    for (uint32_t i = 0; i < node->child_count; i++)
        if (i != path && sibling_holds(probe, node, i, path, sides.within ? 1 : -1) != all) return (Sides){!all, !all};
    return sides;
}

static Sides sides_of(const Probe *probe, const SetNode *node) {
    Sides sides = {true, false};
    if (node->kind != SET_LEAF) sides = group_sides(probe, node);
    if (node->inverse) sides = (Sides){!sides.within, !sides.beyond};
    if (sides.within != sides.beyond && !clips_hold(probe->tree, node, probe->point)) return (Sides){false, false};
    return sides;
}

SetSide set_tree_side(const SetTree *tree, uint32_t leaf, Vec3 point, Vec3 normal) {
    const Probe probe = {tree, leaf, point, normal};
    Sides sides = sides_of(&probe, &tree->nodes[0]);
    return sides.within == sides.beyond ? SET_SIDE_NONE : sides.within ? SET_SIDE_KEPT : SET_SIDE_REVERSED;
}
