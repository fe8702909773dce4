#include "shape/set_bounds.h"

#include "shape/intersect.h"

bool set_box_is_finite(Box3 box) { return vec3_is_finite(box.min) && vec3_is_finite(box.max); }

Box3 set_box_common(Box3 a, Box3 b) { return (Box3){vec3_max(a.min, b.min), vec3_min(a.max, b.max)}; }

/* ---- leaves ---- */

/* 0·∞ is 0 here: a side without end stays out of the axes that it does not touch. */
static void move_axis(const Transform *t, int row, Box3 box, double *lo, double *hi) {
    *lo = *hi = vec3_get(t->offset, row);
    for (int i = 0; i < 3; i++) {
        double c = vec3_get(t->linear.c[i], row), a = vec3_get(box.min, i), b = vec3_get(box.max, i);
        if (c == 0) continue;
        *lo += c > 0 ? c * a : c * b;
        *hi += c > 0 ? c * b : c * a;
    }
}

static Box3 moved(const Transform *t, Box3 box) {
    double lo[3], hi[3];
    if (box3_is_empty(box)) return box3_empty();
    for (int i = 0; i < 3; i++) move_axis(t, i, box, &lo[i], &hi[i]);
    return (Box3){{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

/* The inside of a quadric whose axes are those of space: along an axis with a square it ends if all squares are positive. */
static Box3 quadric_box(const Solid *s) {
    const double square[3] = {s->as.quadric.squares.x, s->as.quadric.squares.y, s->as.quadric.squares.z};
    const double linear[3] = {s->as.quadric.linear.x, s->as.quadric.linear.y, s->as.quadric.linear.z};
    double rest = -s->as.quadric.constant, lo[3], hi[3];
    if (vec3_length_squared(s->as.quadric.mixed) > 0) return shape_bounds_infinite();
    for (int i = 0; i < 3; i++) {
        if (!(square[i] >= 0) || (square[i] == 0 && linear[i] != 0)) return shape_bounds_infinite();
        if (square[i] > 0) rest += linear[i] * linear[i] / (4 * square[i]);
    }
    for (int i = 0; i < 3; i++) {
        double half = square[i] > 0 ? sqrt(double_max(rest / square[i], 0)) : VTS_INFINITY;
        double middle = square[i] > 0 ? -linear[i] / (2 * square[i]) : 0;
        lo[i] = middle - half, hi[i] = middle + half;
    }
    return (Box3){{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

/* Half a space whose border stands square to an axis ends there. */
static Box3 half_space_box(Vec3 normal, Vec3 point) {
    double lo[3], hi[3];
    for (int i = 0; i < 3; i++) {
        double n = vec3_get(normal, i);
        lo[i] = n < -(1 - 1e-12) ? vec3_get(point, i) : -VTS_INFINITY;
        hi[i] = n > 1 - 1e-12 ? vec3_get(point, i) : VTS_INFINITY;
    }
    return (Box3){{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

static Vec3 plane_normal(const SetLeaf *leaf) {
    return vec3_normalize(transform_normal(&leaf->to_root, leaf->object->as.plane.normal));
}

static Vec3 plane_point(const SetLeaf *leaf) {
    const Object *o = leaf->object;
    return transform_point(&leaf->to_root, vec3_scale(o->as.plane.normal, o->as.plane.distance));
}

Box3 set_leaf_bounds(const SetLeaf *leaf) {
    const Object *o = leaf->object;
    if (leaf->singular) return box3_empty();
    if (o->kind == OBJECT_PLANE) return half_space_box(plane_normal(leaf), plane_point(leaf));
    if (o->kind == OBJECT_DISC) return shape_bounds_infinite();
    if (o->kind == OBJECT_SOLID && o->as.solid->kind == SOLID_QUADRIC) return moved(&leaf->to_root, quadric_box(o->as.solid));
    if (!leaf->ops->cross) return moved(&leaf->to_root, shape_bounds(o));
    if (!leaf->data) return box3_empty();
    Box3 box = leaf->ops->bounds(leaf->data);
    if (o->kind == OBJECT_SOLID && o->as.solid->kind == SOLID_HEIGHT_FIELD) box.min.y = -VTS_INFINITY; /* inside below */
    return moved(&leaf->to_root, box);
}

/* ---- groups ---- */

enum { MOST_HALF_SPACES = 48 };

/* Points with dot(normal, p) <= distance. */
typedef struct HalfSpace {
    Vec3 normal;
    double distance;
} HalfSpace;

static size_t gather_half_spaces(const SetTree *tree, const SetNode *node, HalfSpace *out) {
    size_t count = 0;
    for (uint32_t i = 0; i < node->child_count && count < MOST_HALF_SPACES; i++) {
        const SetNode *child = &tree->nodes[node->first_child + i];
        if (child->kind != SET_LEAF) continue;
        const SetLeaf *leaf = &tree->leaves[child->leaf_begin];
        if (leaf->object->kind != OBJECT_PLANE || leaf->singular) continue;
        Vec3 n = plane_normal(leaf);
        if (child->inverse != (node->difference && i > 0)) n = vec3_negate(n);
        out[count++] = (HalfSpace){n, vec3_dot(n, plane_point(leaf))};
    }
    return count;
}

static void add_box_sides(Box3 box, double reach, HalfSpace *out, size_t *count) {
    for (int i = 0; i < 3; i++) {
        Vec3 axis = {i == 0, i == 1, i == 2};
        out[(*count)++] = (HalfSpace){axis, double_min(vec3_get(box.max, i), reach)};
        out[(*count)++] = (HalfSpace){vec3_negate(axis), double_min(-vec3_get(box.min, i), reach)};
    }
}

static bool common_point(const HalfSpace *a, const HalfSpace *b, const HalfSpace *c, Vec3 *out) {
    Vec3 bc = vec3_cross(b->normal, c->normal), ca = vec3_cross(c->normal, a->normal),
         ab = vec3_cross(a->normal, b->normal);
    double determinant = vec3_dot(a->normal, bc);
    if (fabs(determinant) < 1e-9) return false;
    Vec3 sum = vec3_madd(vec3_madd(vec3_scale(bc, a->distance), ca, b->distance), ab, c->distance);
    *out = vec3_scale(sum, 1 / determinant);
    return vec3_is_finite(*out);
}

static bool all_hold(const HalfSpace *all, size_t count, Vec3 p) {
    for (size_t i = 0; i < count; i++)
        if (vec3_dot(all[i].normal, p) > all[i].distance + 1e-9 * (1 + fabs(all[i].distance) + vec3_length(p))) return false;
    return true;
}

/* The corners of the polytope, if it ends; sides that only end at `reach` are without end. */
static Box3 polytope_box(const HalfSpace *all, size_t count, double reach) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++)
            for (size_t k = j + 1; k < count; k++) {
                Vec3 p;
                if (common_point(&all[i], &all[j], &all[k], &p) && all_hold(all, count, p)) box = box3_add_point(box, p);
            }
    double *sides[6] = {&box.min.x, &box.min.y, &box.min.z, &box.max.x, &box.max.y, &box.max.z};
    for (int i = 0; i < 6 && !box3_is_empty(box); i++)
        if (fabs(*sides[i]) > reach / 2) *sides[i] = i < 3 ? -VTS_INFINITY : VTS_INFINITY;
    return box;
}

static Box3 narrowed_by_planes(const SetTree *tree, const SetNode *node, Box3 box) {
    HalfSpace all[MOST_HALF_SPACES + 6];
    size_t count = gather_half_spaces(tree, node, all);
    double reach = 1;
    if (count == 0) return box;
    for (size_t i = 0; i < count; i++) reach = double_max(reach, fabs(all[i].distance));
    reach *= 1e7;
    if (!isfinite(reach)) return box;
    add_box_sides(box, reach, all, &count);
    Box3 narrow = polytope_box(all, count, reach);
    return box3_is_empty(narrow) ? narrow : set_box_common(box, narrow);
}

Box3 set_outer_bounds(const SetTree *tree, const SetNode *node) {
    Box3 box = node->inverse ? shape_bounds_infinite() : node->bounds;
    for (uint32_t i = 0; i < node->clip_count; i++)
        box = set_box_common(box, set_outer_bounds(tree, &tree->nodes[node->first_clip + i]));
    return box;
}

static Box3 any_bounds(const SetTree *tree, const SetNode *node) {
    Box3 box = box3_empty();
    for (uint32_t i = 0; i < node->child_count; i++) {
        Box3 child = set_outer_bounds(tree, &tree->nodes[node->first_child + i]);
        if (!box3_is_empty(child)) box = box3_union(box, child);
    }
    return box;
}

/* What a child of a difference takes away ends nothing. */
static Box3 all_bounds(const SetTree *tree, const SetNode *node) {
    Box3 box = shape_bounds_infinite();
    for (uint32_t i = 0; i < node->child_count; i++) {
        const SetNode *child = &tree->nodes[node->first_child + i];
        if (node->difference && i > 0) {
            if (!child->inverse || child->clip_count) continue;
            box = set_box_common(box, child->bounds);
        } else {
            box = set_box_common(box, set_outer_bounds(tree, child));
        }
    }
    return set_box_is_finite(box) || box3_is_empty(box) ? box : narrowed_by_planes(tree, node, box);
}

Box3 set_group_bounds(const SetTree *tree, const SetNode *node) {
    if (node->child_count == 0) return box3_empty();
    return (node->kind == SET_ALL ? all_bounds : any_bounds)(tree, node);
}
