#include "render/cluster.h"

#include "grow/particles.h"
#include "render/hierarchy.h"
#include "shape/intersect.h"
#include "shape/surface_mesh.h"
#include "shape/tessellate.h"

#include <string.h>

/* Meshes of so few triangles go into the cluster they are in. */
enum { FEW_TRIANGLES = 16 };

/* ---- tables by address ---- */

typedef struct Slot {
    const void *key;
    Cluster *cluster;
    size_t uses;
    bool looked; /* its looks are known */
    bool sized;
    Box3 box;    /* of the group, in its own space */
} Slot;

typedef struct SlotTable {
    Slot *slots;
    size_t slot_count, count;
} SlotTable;

static size_t address_hash(const void *key) { return (size_t)(((uintptr_t)key >> 4) * UINT64_C(0x9E3779B97F4A7C15) >> 16); }

static Slot *slot_at(SlotTable *table, const void *key) {
    size_t i = address_hash(key) & (table->slot_count - 1);
    while (table->slots[i].key && table->slots[i].key != key) i = (i + 1) & (table->slot_count - 1);
    return &table->slots[i];
}

/* Valid until the next call. */
static Slot *slot_of(Arena *arena, SlotTable *table, const void *key) {
    if (2 * table->count >= table->slot_count) {
        SlotTable grown = {.slot_count = table->slot_count ? 2 * table->slot_count : 64, .count = table->count};
        grown.slots = arena_new_array(arena, Slot, grown.slot_count);
        for (size_t i = 0; i < table->slot_count; i++)
            if (table->slots[i].key) *slot_at(&grown, table->slots[i].key) = table->slots[i];
        *table = grown;
    }
    Slot *slot = slot_at(table, key);
    if (!slot->key) table->count++;
    slot->key = key;
    return slot;
}

static const Look **look_slot(const LookTable *table, const Texture *texture) {
    size_t i = address_hash(texture) & (table->slot_count - 1);
    while (table->slots[i] && table->slots[i]->texture != texture) i = (i + 1) & (table->slot_count - 1);
    return &table->slots[i];
}

const Look *look_table_find(const LookTable *table, const Texture *texture) {
    return table->slot_count ? *look_slot(table, texture) : NULL;
}

/* ---- building ---- */

typedef struct Builder {
    ClusterSet *set;
    const Scene *scene;
    Arena *arena;
    DiagList *diags;
    double tolerance;
    ShapeTracer *tracer;
    SlotTable groups, meshes;
    bool too_deep;
} Builder;

/* What an object has from the unions around it, within the cluster. */
typedef struct Inherited {
    const Look *look;
    const Transform *look_place;
    const Object *filled;
    const Transform *filled_place;
    const Look *inside;
    uint8_t hidden;
    bool both_sides, hollow;
} Inherited;

static const Look *look_of(Builder *b, const Texture *texture) {
    LookTable *table = &b->set->looks;
    if (2 * table->count >= table->slot_count) {
        LookTable grown = {.slot_count = table->slot_count ? 2 * table->slot_count : 64, .count = table->count};
        grown.slots = arena_new_array(b->arena, const Look *, grown.slot_count);
        for (size_t i = 0; i < table->slot_count; i++)
            if (table->slots[i]) *look_slot(&grown, table->slots[i]->texture) = table->slots[i];
        *table = grown;
    }
    const Look **slot = look_slot(table, texture);
    if (*slot) return *slot;
    Look *look = arena_new(b->arena, Look);
    *look = look_from_texture(texture, &b->scene->settings);
    table->count++;
    return *slot = look;
}

/* Of a set and all in it, whose hits name their textures. */
static void learn_looks(Builder *b, const Object *object) {
    if (object->texture) look_of(b, object->texture);
    if (object->rest && object->rest->interior_texture) look_of(b, object->rest->interior_texture);
    if (object->kind == OBJECT_TRIANGLES)
        for (size_t i = 0; i < object->as.mesh->texture_count; i++) look_of(b, object->as.mesh->textures[i]);
    size_t count;
    const BlobPart *parts = object_textured_parts(object, &count);
    b->set->blends |= parts || object->cutaway || (object->kind == OBJECT_TRIANGLES && object->as.mesh->corner_textures);
    for (size_t i = 0; i < count; i++)
        if (parts[i].texture) look_of(b, parts[i].texture);
    if (!object_has_group(object)) return;
    Slot *slot = slot_of(b->arena, &b->groups, object->as.group);
    if (slot->looked) return;
    slot->looked = true;
    for (size_t i = 0; i < object->as.group->count; i++) learn_looks(b, object->as.group->items[i]);
}

/* How often each union is copied. */
static void count_uses(Builder *b, const Object *object) {
    if (object->kind != OBJECT_UNION) return;
    if (slot_of(b->arena, &b->groups, object->as.group)->uses++) return;
    for (size_t i = 0; i < object->as.group->count; i++) count_uses(b, object->as.group->items[i]);
}

static Cluster *new_cluster(Builder *b) {
    Cluster *cluster = arena_new(b->arena, Cluster);
    cluster->depth = 1;
    cluster->bounds = cluster->box = box3_empty();
    return cluster;
}

static Item new_item(const Object *object, const Transform *place, const Inherited *has) {
    const Transform back = transform_inverse(place);
    return (Item){.object = object, .look = has->look, .look_place = has->look_place, .filled = has->filled, .filled_place = has->filled_place,
                  .inside = has->inside, .hidden = has->hidden, .both_sides = has->both_sides, .hollow = has->hollow,
                  .back = {back.linear, back.offset}};
}

static bool is_finite_box(Box3 box) { return vec3_is_finite(box.min) && vec3_is_finite(box.max); }

Box3 item_box(const Item *item) {
    Box3 box = item->cluster ? item->cluster->box : item->body ? body_bounds(item->body) : shape_bounds(item->object);
    const Transform place = item_place(item);
    if (box3_is_empty(box)) return box;
    return is_finite_box(box) ? box3_transform(&place, box) : shape_bounds_infinite();
}

static void add_item(Builder *b, Cluster *cluster, Item *item) {
    if (box3_is_empty(item_box(item))) return;
    item->number = (uint32_t)++b->set->part_count;
    if ((item->look && !item->look->even) || item->body) {
        const Transform place = item_place(item);
        item->place = arena_copy(b->arena, &place, sizeof place);
    }
    *list_push(b->arena, &cluster->items) = *item;
    if (item->cluster) cluster->depth = int_max(cluster->depth, 1 + item->cluster->depth);
}

static void add_copy(Builder *b, Cluster *cluster, const Object *object, const Cluster *of, const Transform *place, const Inherited *has) {
    Item item = new_item(object, place, has);
    item.cluster = of;
    if (of->depth >= CLUSTER_DEEPEST) {
        if (!b->too_deep) diag_warning(b->diags, object->span, "not drawn: copies within copies are more than %d deep", CLUSTER_DEEPEST);
        b->too_deep = true;
        return;
    }
    add_item(b, cluster, &item);
}

static const char *why_nothing(const Object *object) {
    if (object->kind == OBJECT_SOLID && object->as.solid->kind == SOLID_TEXT)
        return "its font cannot be read, or vts does not find its module libvts_freetype.so";
    if (object->kind == OBJECT_SOLID && object->as.solid->kind == SOLID_HEIGHT_FIELD) return "its picture cannot be read";
    return "it has no extent";
}

static void add_solid(Builder *b, Cluster *cluster, const Object *object, const Transform *place, const Inherited *has, bool plain) {
    Item item = new_item(object, place, has);
    if (!plain) item.body = body_of(b->tracer, object);
    if (!plain && !item.body) return;
    if (!plain && !body_data(item.body) && !object_has_group(object)) {
        diag_warning(b->diags, object->span, "not drawn: %s", why_nothing(object));
        return;
    }
    learn_looks(b, object);
    add_item(b, cluster, &item);
}

/* ---- triangles ---- */

static void finish_cluster(Builder *b, Cluster *cluster);

static const Cluster *mesh_cluster(Builder *b, const Object *object) {
    const MeshData *mesh = object->as.mesh;
    Slot *slot = slot_of(b->arena, &b->meshes, mesh);
    if (slot->cluster) return slot->cluster;
    Cluster *cluster = slot->cluster = new_cluster(b);
    const Transform identity = transform_identity();
    const Inherited nothing = {0};
    cluster->mesh = mesh;
    *list_push(b->arena, &cluster->owners) = new_item(object, &identity, &nothing);
    for (size_t i = 0; i < mesh->vertex_count; i++) cluster->bounds = box3_add_point(cluster->bounds, mesh->vertices[i]);
    finish_cluster(b, cluster);
    return cluster;
}

static void add_mesh(Builder *b, Cluster *cluster, const Object *object, const Transform *place, const Inherited *has) {
    const MeshData *mesh = object->as.mesh;
    learn_looks(b, object);
    if (mesh->triangle_count > FEW_TRIANGLES || has->hidden) {
        add_copy(b, cluster, object, mesh_cluster(b, object), place, has);
        return;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        *list_push(b->arena, &cluster->triangles) = (ClusterTriangle){(uint32_t)cluster->owners.count, i};
        for (int k = 0; k < 3; k++)
            cluster->bounds = box3_add_point(cluster->bounds, transform_point(place, mesh->vertices[mesh->triangles[i][k]]));
    }
    Item owner = new_item(object, place, has);
    owner.number = (uint32_t)++b->set->part_count;
    *list_push(b->arena, &cluster->owners) = owner;
}

/* Triangles that were made for an object, in its parent's space, as a mesh. */
static void add_soup(Builder *b, Cluster *cluster, const Object *object, const TriangleSoup *soup, const Transform *parent,
                     const Transform *place, const Inherited *has) {
    size_t vertex_count = soup->vertices.count, triangle_count = soup->triangles.count;
    Vec3 *vertices = arena_new_array(b->arena, Vec3, vertex_count), *normals = arena_new_array(b->arena, Vec3, vertex_count);
    uint32_t(*triangles)[3] = arena_push(b->arena, triangle_count * sizeof *triangles);
    for (size_t i = 0; i < vertex_count; i++) {
        vertices[i] = soup->vertices.items[i].position;
        normals[i] = soup->vertices.items[i].normal;
    }
    for (size_t i = 0; i < triangle_count; i++) memcpy(triangles[i], soup->triangles.items[i].vertex, sizeof *triangles);
    MeshData *mesh = arena_new(b->arena, MeshData);
    *mesh = (MeshData){.vertices = vertices, .vertex_count = vertex_count, .normals = normals, .normal_count = vertex_count,
                       .triangles = (const uint32_t(*)[3])triangles, .triangle_count = triangle_count};
    Object *made = arena_new(b->arena, Object);
    *made = (Object){.span = object->span, .kind = OBJECT_TRIANGLES, .as.mesh = mesh};
    Inherited own = *has;
    if (own.look && !own.look_place) own.look_place = arena_copy(b->arena, place, sizeof *place);
    if (own.filled && !own.filled_place) own.filled_place = arena_copy(b->arena, place, sizeof *place);
    if (triangle_count) add_copy(b, cluster, made, mesh_cluster(b, made), parent, &own);
}

static void add_particles(Builder *b, Cluster *cluster, const Object *object, const Transform *parent, const Transform *place,
                          const Inherited *has) {
    TessellateOptions options = {.tolerance = b->tolerance / tessellate_stretch(&parent->linear), .particles = particles_tessellate};
    TriangleSoup soup = {0};
    ShapeRefusal refusal;
    if (tessellate(object, NULL, &options, b->arena, &soup, &refusal))
        add_soup(b, cluster, object, &soup, parent, place, has);
    else
        diag_warning(b->diags, refusal.span, "not drawn: %s", refusal.reason);
}

static void add_surface(Builder *b, Cluster *cluster, const Object *object, const Transform *place, const Inherited *has) {
    SurfaceMeshOptions options = {.tolerance = b->tolerance / tessellate_stretch(&place->linear)};
    SurfaceMesh mesh;
    TriangleSoup soup = {0};
    ShapeRefusal refusal;
    const Surface *surface = object->as.surface;
    if (!surface_mesh_build(surface, &options, b->arena, &mesh, &refusal)) {
        diag_error(b->diags, refusal.span, "this surface cannot be drawn: %s", refusal.reason);
        return;
    }
    for (size_t i = 0; i < mesh.vertex_count; i++)
        soup_vertex(b->arena, &soup, mesh.vertices[i], vec3(0, 0, 0), (double)NAN, (double)NAN);
    /* A bilinear patch is cut along both diagonals through its middle, which lies on the patch. */
    for (size_t i = 0; i < mesh.cell_count; i++) {
        const SurfaceCell *cell = &mesh.cells[i];
        const uint32_t *v = cell->vertex;
        if (cell->corner_count == 3) {
            soup_triangle(b->arena, &soup, v[0], v[1], v[2], false);
            continue;
        }
        Vec3 middle = vec3(0, 0, 0);
        for (int k = 0; k < 4; k++) middle = vec3_madd(middle, mesh.vertices[v[k]], 0.25);
        uint32_t m = soup_vertex(b->arena, &soup, middle, vec3(0, 0, 0), (double)NAN, (double)NAN);
        for (int k = 0; k < 4; k++) soup_triangle(b->arena, &soup, v[k], v[(k + 1) % 4], m, false);
    }
    add_soup(b, cluster, object, &soup, place, place, has);
}

/* ---- the tree of objects ---- */

static uint8_t hidden_from(const Object *object) {
    return (uint8_t)((object->no_image ? 1 << RAY_SEES : 0) | (object->no_shadow ? 1 << RAY_SHADOWS : 0) |
                     (object->no_reflection ? 1 << RAY_MIRRORS : 0) | (object->no_radiosity ? 1 << RAY_GATHERS : 0));
}

static void add_object(Builder *b, Cluster *cluster, const Object *object, const Transform *parent, const Inherited *outer);

static void add_children(Builder *b, Cluster *cluster, const Object *object, const Transform *place, const Inherited *has) {
    Inherited inside = *has;
    if (inside.look && !inside.look_place) inside.look_place = arena_copy(b->arena, place, sizeof *place);
    if (inside.filled && !inside.filled_place) inside.filled_place = arena_copy(b->arena, place, sizeof *place);
    for (size_t i = 0; i < object->as.group->count; i++) add_object(b, cluster, object->as.group->items[i], place, &inside);
}

static void add_union(Builder *b, Cluster *cluster, const Object *object, const Transform *place, const Inherited *has) {
    Slot *slot = slot_of(b->arena, &b->groups, object->as.group);
    if (slot->uses < 2 || object->as.group->count < 2) {
        add_children(b, cluster, object, place, has);
        return;
    }
    const Cluster *of = slot->cluster;
    if (!of) {
        const Transform identity = transform_identity();
        const Inherited nothing = {0};
        Cluster *made = new_cluster(b);
        add_children(b, made, object, &identity, &nothing);
        finish_cluster(b, made);
        slot_of(b->arena, &b->groups, object->as.group)->cluster = made;
        of = made;
    }
    add_copy(b, cluster, object, of, place, has);
}

static void add_object(Builder *b, Cluster *cluster, const Object *object, const Transform *parent, const Inherited *outer) {
    Transform own = object_transform(object), place = transform_then(&own, parent);
    Inherited has = *outer;
    if (transform_is_singular(&place)) return;
    if (object->texture) has.look = look_of(b, object->texture), has.look_place = NULL, has.inside = NULL;
    has.hidden |= hidden_from(object);
    has.both_sides |= object->double_illuminate;
    has.hollow |= object->rest && object->rest->hollow;
    if (object->rest && object->rest->interior) has.filled = object, has.filled_place = NULL;
    if (object->rest && object->rest->interior_texture) has.inside = look_of(b, object->rest->interior_texture);
    bool set = object_clipped_by(object).count || object_bounded_by(object).count;
    switch (object->kind) {
    case OBJECT_UNION:
        if (set || object->inverse)
            add_solid(b, cluster, object, &place, &has, false);
        else
            add_union(b, cluster, object, &place, &has);
        return;
    case OBJECT_SPHERE: case OBJECT_BOX: case OBJECT_CYLINDER: case OBJECT_CONE: case OBJECT_DISC: case OBJECT_TORUS: case OBJECT_PLANE:
        add_solid(b, cluster, object, &place, &has, !set);
        return;
    case OBJECT_TRIANGLES:
        if (set)
            add_solid(b, cluster, object, &place, &has, false);
        else
            add_mesh(b, cluster, object, &place, &has);
        return;
    case OBJECT_BRANCHES:
    case OBJECT_PARTICLES: add_particles(b, cluster, object, parent, &place, &has); return;
    case OBJECT_SURFACE:
        if (!object->texture && object->as.surface->texture) has.look = look_of(b, object->as.surface->texture), has.look_place = NULL;
        add_surface(b, cluster, object, &place, &has);
        return;
    case OBJECT_MERGE:
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_SOLID: add_solid(b, cluster, object, &place, &has, false); return;
    case OBJECT_TEXEL: return; /* a skin of its own */
    case OBJECT_VOLUME: return; /* volumes.h */
    case OBJECT_UNMODELLED: return; /* named in a warning when the scene was read */
    }
}

/* ---- what Embree gets to know ---- */

static double size_of(Box3 box) {
    Vec3 size = vec3_sub(box.max, box.min);
    return fmax(size.x, fmax(size.y, size.z));
}

static void swap_items(Item *a, Item *b) {
    Item other = *a;
    *a = *b;
    *b = other;
}

enum { MOST_GIANTS = 6 };

/* A sky that is a sphere around everything would leave the floats of everything few digits: it goes to the loose ones. */
static void set_giants_apart(Cluster *cluster) {
    for (int n = 0; n < MOST_GIANTS && cluster->loose > 1; n++) {
        Box3 all = cluster->bounds, rest = cluster->bounds;
        size_t largest = 0;
        double most = 0;
        for (size_t i = 0; i < cluster->loose; i++) {
            Box3 box = item_box(&cluster->items.items[i]);
            all = box3_union(all, box);
            if (size_of(box) > most) most = size_of(box), largest = i;
        }
        for (size_t i = 0; i < cluster->loose; i++)
            if (i != largest) rest = box3_union(rest, item_box(&cluster->items.items[i]));
        if (!(size_of(rest) < size_of(all) / 4)) return;
        swap_items(&cluster->items.items[largest], &cluster->items.items[--cluster->loose]);
    }
}

/* Wider by roundings, so that no ray lies in a side. */
static Box3 wider(Box3 box) {
    Vec3 far = vec3(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y)), fmax(fabs(box.min.z), fabs(box.max.z)));
    Vec3 margin = vec3_add(vec3_scale(vec3_add(far, vec3_splat(vec3_length(far))), 1e-9), vec3_splat(1e-30));
    return (Box3){vec3_sub(box.min, margin), vec3_add(box.max, margin)};
}

static void bound_few(Builder *b, Cluster *cluster) {
    if (cluster->loose > CLUSTER_FEW || cluster->triangles.count || cluster->mesh) return;
    Box3 *few = arena_new_array(b->arena, Box3, CLUSTER_FEW);
    for (size_t i = 0; i < cluster->loose; i++) few[i] = wider(item_box(&cluster->items.items[i]));
    cluster->few = few;
}

static void finish_cluster(Builder *b, Cluster *cluster) {
    cluster->loose = cluster->items.count;
    for (size_t i = 0; i < cluster->loose;) {
        Item *items = cluster->items.items;
        if (is_finite_box(item_box(&items[i])))
            i++;
        else
            swap_items(&items[i], &items[--cluster->loose]);
    }
    cluster->box = cluster->bounds;
    if (cluster->loose > CLUSTER_FEW || cluster->triangles.count) set_giants_apart(cluster);
    bound_few(b, cluster);
    for (size_t i = 0; i < cluster->items.count; i++) {
        Box3 box = item_box(&cluster->items.items[i]);
        if (i < cluster->loose) cluster->bounds = box3_union(cluster->bounds, box);
        cluster->box = box3_union(cluster->box, box);
    }
    for (size_t i = 0; i < cluster->items.count; i++) {
        const Item *item = &cluster->items.items[i];
        if (item->filled || (item->cluster && item->cluster->filled.count)) *list_push(b->arena, &cluster->filled) = (uint32_t)i;
    }
    cluster->origin = box3_is_empty(cluster->bounds) ? vec3_splat(0) : vec3_lerp(cluster->bounds.min, cluster->bounds.max, 0.5);
    *list_push(b->arena, &b->set->clusters) = cluster;
}

static Box3 group_box(Builder *b, const ObjectGroup *group);

/* Copies share it: each vertex is looked at once. */
static Box3 mesh_box(Builder *b, const Object *object) {
    Slot *slot = slot_of(b->arena, &b->meshes, object->as.mesh);
    if (!slot->sized) slot->box = shape_bounds(object);
    slot->sized = true;
    return slot->box;
}

/* Of everything finite, in the parent's space. */
static Box3 finite_box(Builder *b, const Object *object) {
    Box3 own = object_has_group(object)               ? group_box(b, object->as.group)
               : object->kind == OBJECT_TRIANGLES ? mesh_box(b, object)
                                                  : shape_bounds(object);
    Transform place = object_transform(object);
    return is_finite_box(own) ? box3_transform(&place, own) : box3_empty();
}

static Box3 group_box(Builder *b, const ObjectGroup *group) {
    Slot *slot = slot_of(b->arena, &b->groups, group);
    if (slot->sized) return slot->box;
    Box3 box = box3_empty();
    for (size_t i = 0; i < group->count; i++) box = box3_union(box, finite_box(b, group->items[i]));
    slot = slot_of(b->arena, &b->groups, group);
    slot->sized = true;
    return slot->box = box;
}

/* How far triangles may be off what they stand for: what is small in the scene is small against its size. */
static double scene_tolerance(Builder *b) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < b->scene->object_count; i++) box = box3_union(box, finite_box(b, b->scene->objects[i]));
    return 1e-4 * (box3_is_empty(box) ? 1 : fmax(vec3_length(vec3_sub(box.max, box.min)), 1e-6));
}

void clusters_build(const Scene *scene, Arena *arena, DiagList *diags, ClusterSet *out) {
    *out = (ClusterSet){0};
    Builder b = {.set = out, .scene = scene, .arena = arena, .diags = diags,
                 .tracer = shape_tracer_create(arena)};
    out->shapes = b.tracer;
    const Transform identity = transform_identity();
    const Inherited nothing = {0};
    b.tolerance = scene_tolerance(&b);
    out->default_look = look_of(&b, scene->default_texture);
    for (size_t i = 0; i < scene->object_count; i++) count_uses(&b, scene->objects[i]);
    Cluster *all = new_cluster(&b);
    for (size_t i = 0; i < scene->object_count; i++) add_object(&b, all, scene->objects[i], &identity, &nothing);
    finish_cluster(&b, all);
}
