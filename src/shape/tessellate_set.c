/* Sets: the triangles of each surface, cut where it meets the others, as their exact insides tell. */
#include "base/random.h"
#include "shape/box_tree.h"
#include "shape/intersect.h"
#include "shape/set_bounds.h"
#include "shape/solid_project.h"
#include "shape/soup_refine.h"
#include "shape/soup_stitch.h"
#include "shape/tessellate_parts.h"

enum { MOST_TRIANGLES = 1000000, MOST_TRIES = 8, BORDER_HALVINGS = 10 };

/* Where another surface passes, edges are cut to COARSE steps; those whose ends differ to one. */
static const double COARSE = 3, JOIN = 0.6;

typedef struct SideList {
    int8_t *items;
    size_t count, capacity;
} SideList;

/* Where borders cross the edges of the leaf being cut. Both triangles at an edge ask. */
typedef struct BorderSlot {
    uint64_t key; /* lower vertex << 32 | higher one; 0: free */
    SoupVertex vertex;
} BorderSlot;

typedef struct BorderTable {
    BorderSlot *slots;
    size_t mask, count;
} BorderTable;

typedef struct LeafMesh {
    TriangleSoup whole; /* in the set's space */
    const BoxTree *boxes; /* over its triangles */
    bool flat;          /* triangles are the surface itself */
} LeafMesh;

typedef struct Cutter {
    TessellateWalk *walk;
    const Object *object;
    SetTree tree;
    Box3 region;      /* holds all that may be seen */
    LeafMesh *meshes; /* per leaf */
    const BoxTree *boxes; /* over the leaves */
    double step;          /* length of edges that cross a border */
    double reach, slack;  /* how far from a point of the triangles the surface is looked for; how far it may be */
    size_t first_surface;
    /* of the leaf being cut */
    uint32_t leaf;
    TriangleSoup *soup;
    SideList sides;   /* per vertex of soup; UNKNOWN until asked */
    BorderTable borders;
    uint32_t *copies; /* per vertex of soup: where it is in the output, + 1; 0: nowhere yet */
} Cutter;

enum { UNKNOWN = 2 };

bool tessellate_is_set(const Object *object) {
    if (object_clipped_by(object).count) return true;
    if (object->kind == OBJECT_SOLID) {
        const Solid *solid = object->as.solid; /* what may have no end is made as far as its bounds reach */
        return solid->kind == SOLID_ISOSURFACE || solid->kind == SOLID_QUADRIC || solid->kind == SOLID_POLYNOMIAL ||
               (solid->kind == SOLID_PARAMETRIC && solid->as.parametric.container);
    }
    return object->kind == OBJECT_INTERSECTION || object->kind == OBJECT_DIFFERENCE || object->kind == OBJECT_MERGE;
}

/* ---- the surfaces ---- */

static bool is_flat(const Object *object) {
    return object->kind == OBJECT_BOX || object->kind == OBJECT_PLANE || object->kind == OBJECT_DISC ||
           object->kind == OBJECT_TRIANGLES || object->kind == OBJECT_PARTICLES || object->kind == OBJECT_BRANCHES || object->kind == OBJECT_SURFACE;
}

static bool has_no_end(const SetLeaf *leaf) {
    if (leaf->object->kind == OBJECT_PLANE) return true;
    return leaf->data && leaf->ops->bounds && !set_box_is_finite(leaf->ops->bounds(leaf->data)) &&
           !box3_is_empty(leaf->ops->bounds(leaf->data));
}

/* The set's box in the leaf's space, a little wider, so that what is cut off ends outside. */
static Box3 local_region(const Cutter *c, const SetLeaf *leaf) {
    Vec3 margin = vec3_splat(0.01 * vec3_length(vec3_sub(c->region.max, c->region.min)) + 4 * c->reach);
    Box3 wide = {vec3_sub(c->region.min, margin), vec3_add(c->region.max, margin)};
    Transform back = transform_inverse(&leaf->to_root);
    return box3_transform(&back, wide);
}

/* Triangles without normals of their own get one each: it tells which side is which. */
static void give_normals(Arena *arena, TriangleSoup *soup) {
    size_t count = soup->triangles.count;
    for (size_t t = 0; t < count; t++) {
        uint32_t *v = soup->triangles.items[t].vertex;
        SoupVertex corner[3];
        bool whole = true;
        for (int k = 0; k < 3; k++) {
            corner[k] = soup->vertices.items[v[k]];
            whole &= vec3_length_squared(corner[k].normal) > 0;
        }
        if (whole) continue;
        Vec3 normal = vec3_normalize(vec3_cross(vec3_sub(corner[1].position, corner[0].position),
                                                vec3_sub(corner[2].position, corner[0].position)));
        for (int k = 0; k < 3; k++) {
            uint32_t fresh = soup_vertex(arena, soup, corner[k].position, normal, corner[k].uv.u, corner[k].uv.v);
            soup->triangles.items[t].vertex[k] = fresh;
        }
    }
}

static bool mesh_leaf(Cutter *c, uint32_t index) {
    const SetLeaf *leaf = &c->tree.leaves[index];
    LeafMesh *mesh = &c->meshes[index];
    mesh->flat = is_flat(leaf->object);
    if (leaf->singular) return true;
    Box3 region = local_region(c, leaf);
    TessellateWalk inner = *c->walk;
    inner.out = &mesh->whole;
    double tolerance = c->walk->options->tolerance / double_max(tessellate_stretch(&leaf->to_root.linear), 1e-300);
    if (!tessellate_shape(&inner, leaf->object, tolerance, &region)) return false;
    c->walk->tracer = inner.tracer;
    soup_transform(c->walk->arena, &mesh->whole, (SoupMark){0, 0}, &leaf->to_root);
    give_normals(c->walk->arena, &mesh->whole);
    return true;
}

/* A tree over the triangles of each leaf, and one over the leaves: a surface that is cut passes its own by. */
static void gather_boxes(Cutter *c) {
    Arena *arena = c->walk->arena;
    Box3 *whole = arena_new_array(arena, Box3, c->tree.leaf_count);
    for (uint32_t i = 0; i < c->tree.leaf_count; i++) {
        const TriangleSoup *soup = &c->meshes[i].whole;
        Box3 *boxes = arena_new_array(arena, Box3, soup->triangles.count);
        whole[i] = box3_empty();
        for (size_t t = 0; t < soup->triangles.count; t++) {
            boxes[t] = box3_empty();
            for (int k = 0; k < 3; k++)
                boxes[t] = box3_add_point(boxes[t], soup->vertices.items[soup->triangles.items[t].vertex[k]].position);
            whole[i] = box3_union(whole[i], boxes[t]);
        }
        c->meshes[i].boxes = box_tree_build(boxes, soup->triangles.count, arena);
    }
    c->boxes = box_tree_build(whole, c->tree.leaf_count, arena);
}

/* ---- sides ---- */

/* The point of the exact surface under a point of its triangles. */
static Vec3 on_surface(const Cutter *c, Vec3 point, Vec3 normal) {
    const SetLeaf *leaf = &c->tree.leaves[c->leaf];
    const ExactSurface surface = {leaf->object, leaf->ops, leaf->data};
    double t;
    if (c->meshes[c->leaf].flat) return point;
    Vec3 local = transform_point_back(&leaf->to_root, point), direction = transform_vector_back(&leaf->to_root, normal);
    return solid_project(&surface, local, direction, c->reach, &t, NULL) ? vec3_madd(point, normal, t) : point;
}

/* An isosurface's function may be slow, and what it is cut by hardly coincides with it: its triangles are near enough. */
static int side_at(const Cutter *c, const SoupVertex *v) {
    const Object *object = c->tree.leaves[c->leaf].object;
    if (object->kind == OBJECT_SOLID && object->as.solid->kind == SOLID_ISOSURFACE)
        return set_tree_side(&c->tree, c->leaf, v->position, v->normal);
    return set_tree_side(&c->tree, c->leaf, on_surface(c, v->position, v->normal), v->normal);
}

static int side_of(Cutter *c, uint32_t vertex) {
    while (c->sides.count < c->soup->vertices.count) *list_push(c->walk->arena, &c->sides) = UNKNOWN;
    if (c->sides.items[vertex] == UNKNOWN)
        c->sides.items[vertex] = (int8_t)side_at(c, &c->soup->vertices.items[vertex]);
    return c->sides.items[vertex];
}

/* ---- refining ---- */

typedef struct Neighbourhood {
    const Cutter *cutter;
    Box3 box;
    Vec3 middle;
    double reach;
    const TriangleSoup *soup; /* of the leaf that is looked at */
} Neighbourhood;

/* A box of a slanting triangle is large: its plane has to pass, too. */
static bool triangle_passes(void *context, uint32_t item) {
    const Neighbourhood *here = context;
    const SoupVertex *vertices = here->soup->vertices.items;
    const uint32_t *v = here->soup->triangles.items[item].vertex;
    Vec3 a = vertices[v[0]].position;
    Vec3 n = vec3_cross(vec3_sub(vertices[v[1]].position, a), vec3_sub(vertices[v[2]].position, a));
    return fabs(vec3_dot(n, vec3_sub(here->middle, a))) <= here->reach * (fabs(n.x) + fabs(n.y) + fabs(n.z));
}

static bool leaf_passes(void *context, uint32_t leaf) {
    Neighbourhood *here = context;
    const LeafMesh *mesh = &here->cutter->meshes[leaf];
    if (leaf == here->cutter->leaf || mesh->whole.triangles.count == 0) return false;
    here->soup = &mesh->whole;
    return box_tree_touch(mesh->boxes, &here->box, triangle_passes, here);
}

/* The ball about the middle of an edge holds all triangles of which it is the longest. */
static bool others_are_near(const Cutter *c, Vec3 a, Vec3 b, double length) {
    Neighbourhood here = {.cutter = c, .middle = vec3_scale(vec3_add(a, b), 0.5), .reach = 0.87 * length + c->slack};
    here.box = (Box3){vec3_sub(here.middle, vec3_splat(here.reach)), vec3_add(here.middle, vec3_splat(here.reach))};
    return box_tree_touch(c->boxes, &here.box, leaf_passes, &here);
}

static bool split_edge(void *context, const TriangleSoup *soup, uint32_t a, uint32_t b) {
    Cutter *c = context;
    Vec3 p = soup->vertices.items[a].position, q = soup->vertices.items[b].position;
    double length = vec3_length(vec3_sub(p, q));
    if (!(length > c->step)) return false;
    if (length > COARSE * c->step) return others_are_near(c, p, q, length);
    return side_of(c, a) != side_of(c, b);
}

/* ---- cutting ---- */

static bool comes_before(Vec3 a, Vec3 b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/* Where the side changes on an edge, the same seen from both ends, moved onto the surface. */
static SoupVertex find_border(Cutter *c, uint32_t a, uint32_t b) {
    if (comes_before(c->soup->vertices.items[b].position, c->soup->vertices.items[a].position)) {
        uint32_t first = a;
        a = b;
        b = first;
    }
    const SoupVertex from = c->soup->vertices.items[a], to = c->soup->vertices.items[b];
    int side = side_of(c, a);
    double lo = 0, hi = 1;
    for (int i = 0; i < BORDER_HALVINGS; i++) {
        SoupVertex middle = soup_between(&from, &to, (lo + hi) / 2);
        if (side_at(c, &middle) == side)
            lo = (lo + hi) / 2;
        else
            hi = (lo + hi) / 2;
    }
    SoupVertex vertex = soup_between(&from, &to, (lo + hi) / 2);
    vertex.position = on_surface(c, vertex.position, vertex.normal);
    return vertex;
}

static BorderSlot *border_slot(const BorderTable *table, uint64_t key) {
    size_t i = random_mix(key) & table->mask;
    while (table->slots[i].key && table->slots[i].key != key) i = (i + 1) & table->mask;
    return &table->slots[i];
}

static void make_room(Arena *arena, BorderTable *table) {
    if (table->slots && 2 * table->count <= table->mask) return;
    size_t room = table->slots ? 2 * (table->mask + 1) : 64;
    BorderTable larger = {arena_new_array(arena, BorderSlot, room), room - 1, table->count};
    for (size_t i = 0; table->slots && i <= table->mask; i++)
        if (table->slots[i].key) *border_slot(&larger, table->slots[i].key) = table->slots[i];
    *table = larger;
}

static SoupVertex border_vertex(Cutter *c, uint32_t a, uint32_t b) {
    uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    make_room(c->walk->arena, &c->borders);
    BorderSlot *slot = border_slot(&c->borders, key);
    if (!slot->key) {
        *slot = (BorderSlot){key, find_border(c, a, b)};
        c->borders.count++;
    }
    return slot->vertex;
}

static uint32_t put_vertex(Cutter *c, const SoupVertex *vertex, int side) {
    TriangleSoup *out = c->walk->out;
    *list_push(c->walk->arena, &out->vertices) = *vertex;
    SoupVertex *put = &out->vertices.items[out->vertices.count - 1];
    if (side == SET_SIDE_REVERSED) put->normal = vec3_negate(put->normal);
    return (uint32_t)(out->vertices.count - 1);
}

/* A vertex of the leaf's triangles; all that it is a corner of have its side. */
static uint32_t put_own(Cutter *c, uint32_t vertex) {
    if (!c->copies[vertex]) c->copies[vertex] = 1 + put_vertex(c, &c->soup->vertices.items[vertex], side_of(c, vertex));
    return c->copies[vertex] - 1;
}

static void put_triangle(Cutter *c, uint32_t v, uint32_t w, uint32_t x, int side) {
    bool turned = side == SET_SIDE_REVERSED;
    *list_push(c->walk->arena, &c->walk->out->triangles) =
        (SoupTriangle){{v, turned ? x : w, turned ? w : x}, false, (uint16_t)(c->first_surface + c->leaf)};
}

/* The part of a triangle at its corner a, between the borders on the edges to the other two. */
static void put_corner(Cutter *c, uint32_t a, const SoupVertex *after, const SoupVertex *before) {
    int side = side_of(c, a);
    if (side == SET_SIDE_NONE) return;
    uint32_t v = put_own(c, a), w = put_vertex(c, after, side), x = put_vertex(c, before, side);
    put_triangle(c, v, w, x, side);
}

/* Corner `lone` has a side of its own. */
static void cut_off(Cutter *c, const uint32_t v[3], int lone) {
    const uint32_t a = v[lone], b = v[(lone + 1) % 3], d = v[(lone + 2) % 3];
    const SoupVertex ab = border_vertex(c, a, b), da = border_vertex(c, d, a);
    int side = side_of(c, b);
    put_corner(c, a, &ab, &da);
    if (side == SET_SIDE_NONE) return;
    uint32_t p = put_vertex(c, &ab, side), q = put_own(c, b), r = put_own(c, d), s = put_vertex(c, &da, side);
    put_triangle(c, p, q, r, side);
    put_triangle(c, p, r, s, side);
}

/* All corners differ: what lies between them is dropped. */
static void cut_off_all(Cutter *c, const uint32_t v[3]) {
    SoupVertex middle[3];
    for (int k = 0; k < 3; k++) middle[k] = border_vertex(c, v[k], v[(k + 1) % 3]);
    for (int k = 0; k < 3; k++) put_corner(c, v[k], &middle[k], &middle[(k + 2) % 3]);
}

static void cut_triangle(Cutter *c, const uint32_t v[3]) {
    int side[3] = {side_of(c, v[0]), side_of(c, v[1]), side_of(c, v[2])};
    if (side[0] != side[1] && side[1] != side[2] && side[2] != side[0])
        cut_off_all(c, v);
    else if (side[0] != side[1] || side[1] != side[2])
        cut_off(c, v, side[0] == side[1] ? 2 : side[0] == side[2] ? 1 : 0);
    else if (side[0] != SET_SIDE_NONE)
        put_triangle(c, put_own(c, v[0]), put_own(c, v[1]), put_own(c, v[2]), side[0]);
}

static bool cut_leaf(Cutter *c, uint32_t leaf) {
    const TriangleSoup *whole = &c->meshes[leaf].whole;
    TriangleSoup soup = {0};
    if (c->tree.leaves[leaf].hidden || whole->triangles.count == 0) return true;
    for (size_t i = 0; i < whole->vertices.count; i++) *list_push(c->walk->arena, &soup.vertices) = whole->vertices.items[i];
    for (size_t i = 0; i < whole->triangles.count; i++) *list_push(c->walk->arena, &soup.triangles) = whole->triangles.items[i];
    c->leaf = leaf;
    c->soup = &soup;
    c->sides = (SideList){0};
    c->borders = (BorderTable){0};
    const RefineRules rules = {split_edge, NULL, c, MOST_TRIANGLES, c->walk->options->interrupted};
    if (!soup_refine(c->walk->arena, &soup, (SoupMark){0, 0}, &rules)) return false;
    c->copies = arena_new_array(c->walk->arena, uint32_t, soup.vertices.count);
    for (size_t t = 0; t < soup.triangles.count && !tessellate_interrupted(c->walk); t++) cut_triangle(c, soup.triangles.items[t].vertex);
    return true;
}

/* ---- the whole ---- */

static bool mesh_all(Cutter *c) {
    c->meshes = arena_new_array(c->walk->arena, LeafMesh, c->tree.leaf_count);
    for (uint32_t i = 0; i < c->tree.leaf_count; i++)
        if (tessellate_interrupted(c->walk) || !mesh_leaf(c, i)) return false;
    gather_boxes(c);
    return true;
}

/* Where surfaces may be: the set's box if it ends, else around those that end. */
static bool find_region(Cutter *c) {
    bool ends = set_box_is_finite(c->tree.bounds);
    c->region = ends ? c->tree.bounds : box3_empty();
    for (size_t i = 0; i < c->tree.leaf_count && !ends; i++) {
        const SetLeaf *leaf = &c->tree.leaves[i];
        if (leaf->hidden || leaf->singular) continue;
        if (has_no_end(leaf)) return tessellate_refuse(c->walk, leaf->object, "no end of it is known");
        Box3 own = leaf->data && leaf->ops->bounds ? leaf->ops->bounds(leaf->data) : shape_bounds(leaf->object);
        if (!box3_is_empty(own)) c->region = box3_union(c->region, box3_transform(&leaf->to_root, own));
    }
    return true;
}

/* As fine as the tolerance, but at least 16 and at most 20000 steps across. */
static void choose_step(Cutter *c) {
    double size = vec3_length(vec3_sub(c->region.max, c->region.min)), tolerance = c->walk->options->tolerance;
    c->step = double_clamp(c->walk->options->parts > 0 ? size / (8.0 * c->walk->options->parts) : tolerance, size / 20000, size / 16);
    c->slack = double_min(tolerance, size / 16);
    c->reach = 4 * c->slack;
    c->tree.coincide = c->step / 64;
}

static void name_surfaces(Cutter *c) {
    TessellateSurfaces *surfaces = c->walk->options->surfaces;
    if (!surfaces) return;
    c->first_surface = surfaces->count;
    for (size_t i = 0; i < c->tree.leaf_count; i++)
        *list_push(c->walk->arena, surfaces) = (TessellateSurface){c->tree.leaves[i].texture, c->tree.leaves[i].texture_place};
}

bool tessellate_set(TessellateWalk *walk, const Object *object, const Transform *outer) {
    Cutter c = {.walk = walk, .object = object};
    if (!set_tree_build(object, outer, tessellate_tracer(walk), walk->arena, &c.tree))
        return tessellate_refuse(walk, object, "it has more than 65536 surfaces");
    if (box3_is_empty(c.tree.bounds)) return true;
    if (!find_region(&c)) return false;
    if (box3_is_empty(c.region)) return true;
    choose_step(&c);
    if (!(c.step > 0)) return true;
    SoupMark since = soup_mark(walk->out);
    name_surfaces(&c);
    if (!mesh_all(&c)) return tessellate_interrupted(walk) ? tessellate_give_up(walk) : false;
    for (int i = 0; i < MOST_TRIES; i++, c.step *= 4) {
        bool done = true;
        for (uint32_t leaf = 0; leaf < c.tree.leaf_count && done; leaf++) {
            progress_update(walk->options->progress, walk->options->stage, leaf, c.tree.leaf_count);
            done = cut_leaf(&c, leaf) && walk->out->triangles.count - since.triangle <= MOST_TRIANGLES;
        }
        if (tessellate_interrupted(walk)) return tessellate_give_up(walk);
        if (done) break;
        if (i == 0) tessellate_doubt(walk, object, "its cuts would need too many triangles: they are coarser than asked");
        walk->out->vertices.count = since.vertex;
        walk->out->triangles.count = since.triangle;
    }
    soup_stitch(walk->arena, walk->out, since, JOIN * c.step);
    soup_mark_closed(walk->arena, walk->out, since);
    return true;
}
