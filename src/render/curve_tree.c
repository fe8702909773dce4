#include "render/curve_tree.h"

#include <math.h>

enum { WIDE = 4, LEAF_ITEMS = 2, BINS = 8, DEEPEST_SPLIT = 48, STACK = (WIDE - 1) * (DEEPEST_SPLIT + 40) + 1 };

/* Four children: inner nodes where count is 0, else `count` items from `first`. Absent ones have boxes that nothing meets. */
typedef struct TreeNode {
    float lo[3][WIDE], hi[3][WIDE];
    uint32_t first[WIDE], count[WIDE];
} TreeNode;

struct CurveTree {
    const TreeNode *nodes;
};

typedef struct Builder {
    struct {
        TreeNode *items;
        size_t count, capacity;
    } nodes;
    Arena *arena; /* of the list */
    const Box3 *boxes;
    uint32_t *order;
} Builder;

typedef struct Range {
    uint32_t first, count;
    Box3 box;
} Range;

/* ---- building ---- */

static double doubled_center(const Box3 *box, int axis) { return vec3_get(box->min, axis) + vec3_get(box->max, axis); }

static double half_area(Box3 b) {
    Vec3 d = vec3_sub(b.max, b.min);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

static Range range_of(const Builder *b, uint32_t first, uint32_t count) {
    Range r = {first, count, box3_empty()};
    for (uint32_t i = 0; i < count; i++) r.box = box3_union(r.box, b->boxes[b->order[first + i]]);
    return r;
}

typedef struct Bin {
    Box3 box;
    uint32_t count;
} Bin;

static int bin_of(const Box3 *box, int axis, double lo, double scale) {
    return int_clamp((int)((doubled_center(box, axis) - lo) * scale), 0, BINS - 1);
}

/* The border between bins where the areas of both sides, each times its number of items, are least. */
static int cheapest_border(const Bin bins[BINS]) {
    double cost_left[BINS] = {0}, least = VTS_INFINITY;
    int best = 1;
    Box3 box = box3_empty();
    uint32_t count = 0;
    for (int i = 0; i < BINS - 1; i++) {
        box = box3_union(box, bins[i].box), count += bins[i].count;
        cost_left[i + 1] = count ? count * half_area(box) : 0;
    }
    box = box3_empty(), count = 0;
    for (int i = BINS - 1; i > 0; i--) {
        box = box3_union(box, bins[i].box), count += bins[i].count;
        double cost = cost_left[i] + (count ? count * half_area(box) : 0);
        if (cost < least) least = cost, best = i;
    }
    return best;
}

/* How many items of the range go to the left; they are moved there. */
static uint32_t split_range(const Builder *b, const Range *r, int depth) {
    Box3 centers = box3_empty();
    for (uint32_t i = 0; i < r->count; i++) {
        const Box3 *box = &b->boxes[b->order[r->first + i]];
        centers = box3_add_point(centers, vec3(doubled_center(box, 0), doubled_center(box, 1), doubled_center(box, 2)));
    }
    Vec3 size = vec3_sub(centers.max, centers.min);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    double lo = vec3_get(centers.min, axis), scale = BINS / vec3_get(size, axis);
    if (!isfinite(scale) || depth >= DEEPEST_SPLIT) return r->count / 2;
    Bin bins[BINS];
    for (int i = 0; i < BINS; i++) bins[i] = (Bin){box3_empty(), 0};
    for (uint32_t i = 0; i < r->count; i++) {
        const Box3 *box = &b->boxes[b->order[r->first + i]];
        Bin *bin = &bins[bin_of(box, axis, lo, scale)];
        bin->box = box3_union(bin->box, *box), bin->count++;
    }
    int border = cheapest_border(bins);
    uint32_t low = r->first, high = r->first + r->count;
    while (low < high) {
        uint32_t item = b->order[low];
        if (bin_of(&b->boxes[item], axis, lo, scale) < border) low++;
        else b->order[low] = b->order[--high], b->order[high] = item;
    }
    uint32_t left = low - r->first;
    return left == 0 || left == r->count ? r->count / 2 : left;
}

/* The largest range that is no leaf yet; −1: none. */
static int next_to_split(const Range *ranges, int count) {
    int best = -1;
    double most = -1;
    for (int i = 0; i < count; i++)
        if (ranges[i].count > LEAF_ITEMS && half_area(ranges[i].box) > most) most = half_area(ranges[i].box), best = i;
    return best;
}

static float below(double x) { return nextafterf((float)x, -INFINITY); }
static float above(double x) { return nextafterf((float)x, INFINITY); }

static void set_child(TreeNode *node, int k, const Range *r) {
    for (int axis = 0; axis < 3; axis++) {
        node->lo[axis][k] = below(vec3_get(r->box.min, axis));
        node->hi[axis][k] = above(vec3_get(r->box.max, axis));
    }
    node->first[k] = r->first, node->count[k] = r->count;
}

static void set_absent(TreeNode *node, int k) {
    for (int axis = 0; axis < 3; axis++) node->lo[axis][k] = 1e30f, node->hi[axis][k] = -1e30f;
    node->first[k] = node->count[k] = 0;
}

static uint32_t make_node(Builder *b, Range whole, int depth) {
    Range ranges[WIDE] = {whole};
    int count = 1;
    for (int i; count < WIDE && (i = next_to_split(ranges, count)) >= 0; count++) {
        Range r = ranges[i];
        uint32_t left = split_range(b, &r, depth);
        ranges[i] = range_of(b, r.first, left);
        ranges[count] = range_of(b, r.first + left, r.count - left);
    }
    uint32_t index = (uint32_t)b->nodes.count;
    TreeNode node;
    list_push_sole(b->arena, &b->nodes);
    for (int k = 0; k < WIDE; k++) {
        if (k >= count || ranges[k].count == 0) {
            set_absent(&node, k);
            continue;
        }
        set_child(&node, k, &ranges[k]);
        if (ranges[k].count <= LEAF_ITEMS) continue;
        node.first[k] = make_node(b, ranges[k], depth + 1);
        node.count[k] = 0;
    }
    b->nodes.items[index] = node;
    return index;
}

const CurveTree *curve_tree_build(const Box3 *boxes, size_t count, uint32_t *order, Arena *arena, Arena *scratch) {
    CurveTree *tree = arena_new(arena, CurveTree);
    for (size_t i = 0; i < count; i++) order[i] = (uint32_t)i;
    Builder b = {.arena = scratch, .boxes = boxes, .order = order};
    make_node(&b, range_of(&b, 0, (uint32_t)count), 0);
    tree->nodes = arena_copy(arena, b.nodes.items, b.nodes.count * sizeof *b.nodes.items);
    return tree;
}

/* ---- walking ---- */

/* The chord from s0 on as floats, by way of slabs: boxes are met as if grown by how far the curve leaves its chord. */
typedef struct Slabs {
    float into[3], out_of[3]; /* the origin, shifted by the spread against the direction and with it */
    float inverse[3];
    bool backwards[3];
} Slabs;

static Slabs slabs_of(const Curve *curve, double margin, double s0) {
    Slabs slabs;
    Vec3 from = vec3_madd(curve->from, curve->chord, s0), spread = curve_spread(curve);
    for (int k = 0; k < 3; k++) {
        double d = vec3_get(curve->chord, k), x = vec3_get(from, k), least = 1e-18;
        double grow = vec3_get(spread, k) + margin + 1e-6 * (1 + fabs(x)); /* with what floats lose */
        if (fabs(d) < least) d = least;
        slabs.backwards[k] = d < 0;
        slabs.inverse[k] = (float)(1 / d);
        slabs.into[k] = (float)(d < 0 ? x - grow : x + grow);
        slabs.out_of[k] = (float)(d < 0 ? x + grow : x - grow);
    }
    return slabs;
}

static void meet_children(const TreeNode *node, const Slabs *slabs, float length, float enter[WIDE], float leave[WIDE]) {
    for (int k = 0; k < WIDE; k++) enter[k] = 0, leave[k] = length;
    for (int axis = 0; axis < 3; axis++) {
        const float *near = slabs->backwards[axis] ? node->hi[axis] : node->lo[axis];
        const float *far = slabs->backwards[axis] ? node->lo[axis] : node->hi[axis];
        float into = slabs->into[axis], out_of = slabs->out_of[axis], inverse = slabs->inverse[axis];
        for (int k = 0; k < WIDE; k++) {
            float a = (near[k] - into) * inverse, b = (far[k] - out_of) * inverse;
            enter[k] = float_max(enter[k], a);
            leave[k] = float_min(leave[k], b);
        }
    }
}

typedef struct Visit {
    float s; /* after s0 */
    uint32_t first, count;
} Visit;

void curve_tree_walk(const CurveTree *tree, const Curve *curve, double margin, double s0, const double *s1,
                     bool (*visit)(void *context, uint32_t first, uint32_t count), void *context) {
    Slabs slabs = slabs_of(curve, margin, s0);
    Visit stack[STACK] = {{0, 0, 0}};
    int depth = 1;
    while (depth > 0) {
        Visit at = stack[--depth];
        float length = (float)(*s1 - s0) * 1.000001f;
        if (at.s > length) continue;
        if (at.count) {
            if (visit(context, at.first, at.count)) return;
            continue;
        }
        const TreeNode *node = &tree->nodes[at.first];
        float enter[WIDE], leave[WIDE];
        meet_children(node, &slabs, length, enter, leave);
        int base = depth;
        for (int k = 0; k < WIDE; k++) {
            if (!(enter[k] <= leave[k])) continue;
            int i = depth++;
            for (; i > base && stack[i - 1].s < enter[k]; i--) stack[i] = stack[i - 1];
            stack[i] = (Visit){enter[k], node->first[k], node->count[k]};
        }
    }
}
