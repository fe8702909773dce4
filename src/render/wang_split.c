#include "render/wang.h"

#include "scene/scene_bounds.h"
#include "scene/scene_hash.h"
#include "shape/intersect.h"
#include "texel/texel.h"

#include <stdlib.h>
#include <string.h>

/* Where a thing is whole: on which grid, and how many periods from the texel's own box. */
typedef struct Spot {
    int grid;
    int64_t along_x, along_z;
} Spot;

/* A thing that stays as it is. */
typedef struct Thing {
    const Object *object;
    Box3 bounds; /* of all that goes with it, where it stands for them */
    Spot spot;
    uint32_t layer, leader; /* what it goes with; itself */
} Thing;

typedef struct ObjectsOfLayer {
    const Object **items;
    size_t count, capacity;
} ObjectsOfLayer;

typedef struct Split {
    const TexelDef *def;
    Vec3 size;
    Arena *arena;
    struct {
        Thing *items;
        size_t count, capacity;
    } things;
    ObjectsOfLayer *rest;                /* of each layer */
    ObjectsOfLayer *whole[WANG_GRIDS];   /* of each layer */
} Split;

/* ---- grids ---- */

/* A thing that touches a wall does not cross it. */
static const double HAIR = 1e-9;
/* Periods away from the box from where on numbers have no digits left for the place within. */
static const double FARTHEST = 1e6;

/* The period that the range lies in, of a grid moved by `shift`; false where it crosses a wall. */
static bool period_of(double lo, double hi, double shift, int64_t *period) {
    if (!(fabs(lo) < FARTHEST && fabs(hi) < FARTHEST)) return false;
    double first = floor(lo - shift + HAIR);
    *period = (int64_t)first;
    return hi - shift <= first + 1 + HAIR;
}

static bool find_spot(const Split *s, const Box3 *b, Spot *spot) {
    const Vec3 min = s->def->bounds.min;
    bool x = s->def->cyclic & TEXEL_CYCLIC_X, z = s->def->cyclic & TEXEL_CYCLIC_Z;
    if (box3_is_empty(*b)) return false;
    for (int grid = 0; grid < WANG_GRIDS; grid++) {
        if ((grid & 1 && !x) || (grid & 2 && !z)) continue;
        *spot = (Spot){.grid = grid};
        if (x && !period_of((b->min.x - min.x) / s->size.x, (b->max.x - min.x) / s->size.x, grid & 1 ? 0.5 : 0, &spot->along_x)) continue;
        if (z && !period_of((b->min.z - min.z) / s->size.z, (b->max.z - min.z) / s->size.z, grid & 2 ? 0.5 : 0, &spot->along_z)) continue;
        return true;
    }
    return false;
}

static void put(Split *s, const Object *object, uint32_t layer, const Spot *spot) {
    Transform place = object_transform(object);
    place.offset.x -= (double)spot->along_x * s->size.x;
    place.offset.z -= (double)spot->along_z * s->size.z;
    Transform moved = transform_of(&(Affine){place.linear, place.offset});
    *list_push(s->arena, &s->whole[spot->grid][layer]) = object_keep(s->arena, object, &moved);
}

/* ---- what can be taken apart ---- */

typedef struct PlacedUnit {
    Spot spot;
    uint32_t unit;
} PlacedUnit;

static int by_spot(const void *a, const void *b) {
    const PlacedUnit *x = a, *y = b;
    if (x->spot.grid != y->spot.grid) return x->spot.grid < y->spot.grid ? -1 : 1;
    if (x->spot.along_x != y->spot.along_x) return x->spot.along_x < y->spot.along_x ? -1 : 1;
    if (x->spot.along_z != y->spot.along_z) return x->spot.along_z < y->spot.along_z ? -1 : 1;
    return x->unit < y->unit ? -1 : 1;
}

static bool same_spot(const Spot *a, const Spot *b) { return a->grid == b->grid && a->along_x == b->along_x && a->along_z == b->along_z; }

enum { NO_GRID = WANG_GRIDS };

static void put_pieces(Split *s, const WangPieces *pieces, uint32_t layer) {
    Spot *spots = arena_new_array(s->arena, Spot, pieces->count);
    PlacedUnit *placed = arena_new_array(s->arena, PlacedUnit, pieces->unit_count);
    uint32_t *units = arena_new_array(s->arena, uint32_t, pieces->unit_count);
    for (size_t i = 0; i < pieces->count; i++)
        if (!find_spot(s, &pieces->bounds[i], &spots[i])) spots[i] = (Spot){.grid = NO_GRID};
    for (size_t i = 0; i < pieces->unit_count; i++) placed[i] = (PlacedUnit){spots[pieces->piece[i]], (uint32_t)i};
    qsort(placed, pieces->unit_count, sizeof *placed, by_spot);
    for (size_t begin = 0, end; begin < pieces->unit_count; begin = end) {
        for (end = begin; end < pieces->unit_count && same_spot(&placed[begin].spot, &placed[end].spot); end++) units[end - begin] = placed[end].unit;
        const Object *part = wang_pieces_pick(pieces, units, end - begin, s->arena);
        if (placed[begin].spot.grid == NO_GRID) *list_push(s->arena, &s->rest[layer]) = part;
        else put(s, part, layer, &placed[begin].spot);
    }
}

/* In the space that `outer` leads to, as tight as may be. */
static Box3 box_of(const Object *object, const Transform *outer, Arena *arena) {
    Transform own = object_transform(object), all = transform_then(&own, outer);
    Box3 box = box3_empty();
    switch (object->kind) {
    case OBJECT_UNION:
    case OBJECT_MERGE:
        for (size_t i = 0; i < object->as.group->count; i++) box = box3_union(box, box_of(object->as.group->items[i], &all, arena));
        return box;
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_SURFACE:
    case OBJECT_SOLID: box = shape_bounds(object); return box3_is_empty(box) ? box : box3_transform(&all, box);
    default: return object_bounds(object_keep(arena, object, &all));
    }
}

/* `place`: of what holds the object. */
static void take(Split *s, const Object *object, const Transform *place, uint32_t layer) {
    Transform own = object_transform(object), all = transform_then(&own, place);
    const Object *here = object_keep(s->arena, object, &all);
    WangPieces pieces;
    Spot spot;
    Box3 bounds = box_of(object, place, s->arena);
    if (find_spot(s, &bounds, &spot)) {
        uint32_t number = (uint32_t)s->things.count;
        *list_push(s->arena, &s->things) = (Thing){here, bounds, spot, layer, number};
    } else if (object->kind == OBJECT_UNION && !object->as.group->plant && !object_clipped_by(object).count) {
        for (size_t i = 0; i < object->as.group->count; i++) take(s, object->as.group->items[i], &all, layer);
    } else if (wang_pieces_of(here, s->arena, &pieces)) {
        put_pieces(s, &pieces, layer);
    } else {
        *list_push(s->arena, &s->rest[layer]) = here;
    }
}

/* ---- what goes together: a stem in one layer, its leaves in another ---- */

/* Boxes seen from above go together if half of one lies in the other, and both are little more than the larger. */
static const double SHARED = 0.5, GROWTH = 1.5;
/* Pairs that are looked at: beyond, a texel is a thicket in which nothing belongs to anything. */
static const size_t MOST_PAIRS = 4000000;

static double area_of(Box3 b) { return fmax(b.max.x - b.min.x, 0) * fmax(b.max.z - b.min.z, 0); }

static bool go_together(Box3 a, Box3 b) {
    double smaller = fmin(area_of(a), area_of(b)), larger = fmax(area_of(a), area_of(b));
    Box3 both = {vec3_max(a.min, b.min), vec3_min(a.max, b.max)};
    return !box3_is_empty(both) && area_of(both) >= SHARED * smaller && area_of(box3_union(a, b)) <= GROWTH * larger;
}

static Thing *leader_of(Split *s, Thing *thing) {
    while (s->things.items[thing->leader].leader != thing->leader) thing->leader = s->things.items[thing->leader].leader;
    return &s->things.items[thing->leader];
}

static void try_together(Split *s, Thing *a, Thing *b) {
    Thing *first = leader_of(s, a), *second = leader_of(s, b);
    Spot spot;
    if (first == second || !go_together(first->bounds, second->bounds)) return;
    Box3 both = box3_union(first->bounds, second->bounds);
    if (!find_spot(s, &both, &spot)) return;
    second->leader = first->leader;
    first->bounds = both;
    first->spot = spot;
}

static int by_least_x(const void *a, const void *b) {
    const Thing *const *x = a, *const *y = b;
    if ((*x)->bounds.min.x != (*y)->bounds.min.x) return (*x)->bounds.min.x < (*y)->bounds.min.x ? -1 : 1;
    return *x < *y ? -1 : 1;
}

static void keep_together(Split *s) {
    size_t count = s->things.count, pairs = 0;
    if (s->def->layer_count < 2 || !count) return;
    Thing **sorted = arena_new_array(s->arena, Thing *, count);
    double *most = arena_new_array(s->arena, double, count);
    for (size_t i = 0; i < count; i++) sorted[i] = &s->things.items[i];
    qsort(sorted, count, sizeof *sorted, by_least_x);
    double *least = arena_new_array(s->arena, double, count);
    for (size_t i = 0; i < count; i++) least[i] = sorted[i]->bounds.min.x, most[i] = sorted[i]->bounds.max.x;
    for (size_t i = 0; i < count; i++)
        for (size_t k = i + 1; k < count && least[k] <= most[i] && pairs < MOST_PAIRS; k++, pairs++)
            if (sorted[i]->layer != sorted[k]->layer) try_together(s, sorted[i], sorted[k]);
}

/* ---- the parts ---- */

static const TexelDef *make_part(const Split *s, const ObjectsOfLayer *objects, bool densities, Vec3 shift, unsigned cyclic, const char *what) {
    TexelDef *part = arena_new(s->arena, TexelDef);
    TexelLayer *layers = arena_new_array(s->arena, TexelLayer, s->def->layer_count);
    *part = *s->def;
    part->name = arena_printf(s->arena, "%s%s", s->def->name, what);
    part->bounds = (Box3){vec3_add(s->def->bounds.min, shift), vec3_add(s->def->bounds.max, shift)};
    part->cyclic = cyclic;
    part->layers = layers;
    part->layer_count = 0;
    for (size_t i = 0; i < s->def->layer_count; i++) {
        const TexelLayer *from = &s->def->layers[i];
        if (!objects[i].count && !(densities && from->density)) continue;
        TexelLayer *layer = &layers[part->layer_count++];
        *layer = *from;
        layer->contents = objects[i].items;
        layer->content_count = objects[i].count;
        layer_rehash(layer);
    }
    texel_rehash(part);
    return part->layer_count ? part : NULL;
}

static bool anything_whole(const Split *s) {
    if (s->things.count) return true;
    for (int grid = 0; grid < WANG_GRIDS; grid++)
        for (size_t i = 0; i < s->def->layer_count; i++)
            if (s->whole[grid][i].count) return true;
    return false;
}

WangParts wang_split(const TexelDef *def, Arena *arena) {
    static const char *const names[WANG_GRIDS] = {"", " over x", " over z", " at corners"};
    Split s = {.def = def, .size = vec3_sub(def->bounds.max, def->bounds.min), .arena = arena};
    WangParts parts = {.rest = def};
    if (def->file) return parts;
    s.rest = arena_new_array(arena, ObjectsOfLayer, def->layer_count);
    for (int grid = 0; grid < WANG_GRIDS; grid++) s.whole[grid] = arena_new_array(arena, ObjectsOfLayer, def->layer_count);
    Transform identity = transform_identity();
    for (size_t i = 0; i < def->layer_count; i++)
        for (size_t k = 0; k < def->layers[i].content_count; k++) take(&s, def->layers[i].contents[k], &identity, (uint32_t)i);
    if (!anything_whole(&s)) return parts;
    keep_together(&s);
    for (size_t i = 0; i < s.things.count; i++) put(&s, s.things.items[i].object, s.things.items[i].layer, &leader_of(&s, &s.things.items[i])->spot);
    for (int grid = 0; grid < WANG_GRIDS; grid++) {
        Vec3 shift = {grid & 1 ? s.size.x / 2 : 0, 0, grid & 2 ? s.size.z / 2 : 0};
        parts.whole[grid] = make_part(&s, s.whole[grid], false, shift, def->cyclic & TEXEL_CYCLIC_Y, names[grid]);
    }
    parts.rest = make_part(&s, s.rest, true, vec3(0, 0, 0), def->cyclic, " beneath");
    return parts;
}
