#include "shape/box_tree.h"

enum { LEAF_ITEMS = 4, DEEPEST = 128 };

/* Inner nodes: children at `first` and `first` + 1. Leaves: `count` items from `first`. */
typedef struct TreeNode {
    Box3 box;
    uint32_t first, count;
} TreeNode;

struct BoxTree {
    const Box3 *boxes;
    uint32_t *items;
    TreeNode *nodes;
    size_t node_count;
};

static double middle(double a, double b) {
    double m = a / 2 + b / 2;
    return isfinite(m) ? m : isfinite(a) ? a : isfinite(b) ? b : 0;
}

static double center(const Box3 *box, int axis) {
    return middle(vec3_get(box->min, axis), vec3_get(box->max, axis));
}

static Box3 box_of_items(const BoxTree *tree, uint32_t first, uint32_t count) {
    Box3 box = box3_empty();
    for (uint32_t i = 0; i < count; i++) box = box3_union(box, tree->boxes[tree->items[first + i]]);
    return box;
}

/* The axis along which the middles lie furthest apart, and half way along it; false when they all coincide. */
static bool choose_split(const BoxTree *tree, const TreeNode *node, int *axis, double *at) {
    Box3 middles = box3_empty();
    for (uint32_t i = 0; i < node->count; i++) {
        const Box3 *box = &tree->boxes[tree->items[node->first + i]];
        middles = box3_add_point(middles, vec3(center(box, 0), center(box, 1), center(box, 2)));
    }
    Vec3 size = vec3_sub(middles.max, middles.min);
    *axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    *at = middle(vec3_get(middles.min, *axis), vec3_get(middles.max, *axis));
    return vec3_get(size, *axis) > 0;
}

/* Moves the items on the low side to the front; returns their number. */
static uint32_t partition(BoxTree *tree, const TreeNode *node, int axis, double at) {
    uint32_t low = node->first, high = node->first + node->count;
    while (low < high) {
        uint32_t item = tree->items[low];
        if (center(&tree->boxes[item], axis) < at) {
            low++;
        } else {
            tree->items[low] = tree->items[--high];
            tree->items[high] = item;
        }
    }
    return low - node->first;
}

static void split(BoxTree *tree, size_t index, int depth) {
    TreeNode *node = &tree->nodes[index];
    int axis;
    double at;
    node->box = box_of_items(tree, node->first, node->count);
    if (node->count <= LEAF_ITEMS || depth >= DEEPEST) return;
    uint32_t low = choose_split(tree, node, &axis, &at) ? partition(tree, node, axis, at) : 0;
    if (low == 0 || low == node->count) low = node->count / 2;
    size_t children = tree->node_count;
    tree->node_count += 2;
    tree->nodes[children] = (TreeNode){.first = node->first, .count = low};
    tree->nodes[children + 1] = (TreeNode){.first = node->first + low, .count = node->count - low};
    node->first = (uint32_t)children;
    node->count = 0;
    split(tree, children, depth + 1);
    split(tree, children + 1, depth + 1);
}

const BoxTree *box_tree_build(const Box3 *boxes, size_t count, Arena *arena) {
    BoxTree *tree = arena_new(arena, BoxTree);
    tree->boxes = arena_copy(arena, boxes, count * sizeof *boxes);
    tree->items = arena_new_array(arena, uint32_t, count);
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!box3_is_empty(boxes[i])) tree->items[kept++] = (uint32_t)i;
    tree->nodes = arena_new_array(arena, TreeNode, 2 * (size_t)kept + 1);
    tree->nodes[0] = (TreeNode){.count = kept};
    tree->node_count = 1;
    split(tree, 0, 0);
    return tree;
}

static bool clip_axis(double lo, double hi, double origin, double direction, double *t_near, double *t_far) {
    double margin = 1e-13 * (fabs(origin) + double_max(fabs(lo), fabs(hi)));
    if (!isfinite(margin)) margin = 0;
    lo -= margin;
    hi += margin;
    if (direction == 0) return origin >= lo && origin <= hi;
    double inverse = 1 / direction, a = (lo - origin) * inverse, b = (hi - origin) * inverse;
    if (isinf(inverse)) a = (lo - origin) / direction, b = (hi - origin) / direction;
    *t_near = double_max(*t_near, double_min(a, b));
    *t_far = double_min(*t_far, double_max(a, b));
    return *t_near <= *t_far;
}

bool box_tree_clip(const Box3 *box, const Ray *ray, double *t_near, double *t_far) {
    Vec3 o = ray->origin, d = ray->direction;
    return clip_axis(box->min.x, box->max.x, o.x, d.x, t_near, t_far) &&
           clip_axis(box->min.y, box->max.y, o.y, d.y, t_near, t_far) &&
           clip_axis(box->min.z, box->max.z, o.z, d.z, t_near, t_far);
}

void box_tree_ray(const BoxTree *tree, const Ray *ray, double t_min, const double *t_max,
                  void (*visit)(void *context, uint32_t item), void *context) {
    struct {
        uint32_t node;
        double t;
    } stack[DEEPEST + 2];
    size_t depth = 0;
    double near = t_min, far = *t_max;
    if (!box_tree_clip(&tree->nodes[0].box, ray, &near, &far)) return;
    stack[depth].node = 0;
    stack[depth++].t = near;
    while (depth) {
        depth--;
        const TreeNode *node = &tree->nodes[stack[depth].node];
        if (stack[depth].t > *t_max) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            uint32_t item = tree->items[node->first + i];
            near = t_min, far = *t_max;
            if (box_tree_clip(&tree->boxes[item], ray, &near, &far)) visit(context, item);
        }
        if (node->count || tree->node_count == 1) continue;
        double t[2];
        bool met[2];
        for (uint32_t k = 0; k < 2; k++) {
            t[k] = t_min, far = *t_max;
            met[k] = box_tree_clip(&tree->nodes[node->first + k].box, ray, &t[k], &far);
        }
        uint32_t later = t[0] <= t[1];
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t child = k == 0 ? later : 1 - later;
            if (!met[child]) continue;
            stack[depth].node = node->first + child;
            stack[depth++].t = t[child];
        }
    }
}

static bool touches(const Box3 *a, const Box3 *b) {
    return a->min.x <= b->max.x && a->min.y <= b->max.y && a->min.z <= b->max.z && b->min.x <= a->max.x &&
           b->min.y <= a->max.y && b->min.z <= a->max.z;
}

bool box_tree_touch(const BoxTree *tree, const Box3 *box, bool (*visit)(void *context, uint32_t item), void *context) {
    uint32_t stack[DEEPEST + 2];
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth) {
        const TreeNode *node = &tree->nodes[stack[--depth]];
        if (!touches(&node->box, box)) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            uint32_t item = tree->items[node->first + i];
            if (touches(&tree->boxes[item], box) && visit(context, item)) return true;
        }
        if (node->count || tree->node_count == 1) continue;
        stack[depth++] = node->first + 1;
        stack[depth++] = node->first;
    }
    return false;
}

bool box_tree_point(const BoxTree *tree, Vec3 point, bool (*visit)(void *context, uint32_t item),
                    void *context) {
    const Box3 box = {point, point};
    return box_tree_touch(tree, &box, visit, context);
}

void box_tree_descend(const BoxTree *tree, bool (*meets)(const void *context, const Box3 *box),
                      void (*visit)(void *context, uint32_t item), void *context) {
    uint32_t stack[DEEPEST + 2];
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth) {
        const TreeNode *node = &tree->nodes[stack[--depth]];
        if (box3_is_empty(node->box) || !meets(context, &node->box)) continue;
        for (uint32_t i = 0; i < node->count; i++) {
            uint32_t item = tree->items[node->first + i];
            if (meets(context, &tree->boxes[item])) visit(context, item);
        }
        if (node->count || tree->node_count == 1) continue;
        stack[depth++] = node->first + 1;
        stack[depth++] = node->first;
    }
}
