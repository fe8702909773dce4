/* A set of the language (union, merge, intersection, difference, what is clipped, isosurfaces in their containers) as one
 * flat tree over its surfaces, in the space of what is made of it. It tells which part of each surface bounds the whole. */
#ifndef VTS_SHAPE_SET_TREE_H
#define VTS_SHAPE_SET_TREE_H

#include "shape/solid.h"
#include "shape/trace.h"

/* One solid or sheet. */
typedef struct SetLeaf {
    const Object *object; /* never a group */
    const SolidOps *ops;  /* members may be NULL: a sheet, or nothing at all */
    const void *data;     /* NULL: nothing is known but its triangles */
    Transform to_root;    /* object space → the set's */
    bool singular;
    const Texture *texture;  /* the innermost around it within the set; NULL: none */
    Transform texture_place; /* of the object that has it: its parent's space → the set's */
    bool hidden; /* of a clip: it divides space and is not seen */
} SetLeaf;

typedef enum SetKind { SET_LEAF, SET_ANY, SET_ALL } SetKind;

/* Holds a point where any or all of its children do; after `inverse` comes what clips it. Leaves of a node have numbers in a
 * row, and so have its children. */
typedef struct SetNode {
    uint8_t kind;
    bool inverse, difference; /* difference: children but the first count inside out */
    uint32_t first_child, child_count;
    uint32_t first_clip, clip_count;
    uint32_t leaf_begin, leaf_end;
    Box3 bounds; /* of its region before `inverse`; infinite where none is known */
} SetNode;

typedef struct SetTree {
    SetNode *nodes; /* the root is the first */
    size_t node_count, node_capacity;
    SetLeaf *leaves;
    size_t leaf_count, leaf_capacity;
    Box3 bounds;     /* of the whole region */
    double coincide; /* surfaces nearer to each other than this count as one */
} SetTree;

enum { SET_MOST_LEAVES = 65536 };

/* `place`: the object's parent → the set's space. False when it has more than SET_MOST_LEAVES surfaces. The tree lives in
 * `arena`, and the tracer as long. */
bool set_tree_build(const Object *object, const Transform *place, ShapeTracer *tracer, Arena *arena, SetTree *out);

/* What a surface is to the whole at one of its points. */
typedef enum SetSide { SET_SIDE_REVERSED = -1, SET_SIDE_NONE = 0, SET_SIDE_KEPT = 1 } SetSide;

/* The point lies on the surface of that leaf, whose unit normal (to the leaf's own outside) is given. SET_SIDE_NONE where
 * both sides of it are inside or both are outside; SET_SIDE_REVERSED where the whole lies on the normal's side. Of surfaces
 * that coincide one is kept, or none where they cancel each other. */
SetSide set_tree_side(const SetTree *tree, uint32_t leaf, Vec3 point, Vec3 normal);
/* Whether the point is in the whole. */
bool set_tree_inside(const SetTree *tree, Vec3 point);

#endif
