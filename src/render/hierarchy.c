#include "render/hierarchy.h"

#include "render/blockers.h"
#include "render/embree_module.h"
#include "render/embree_ray.h"
#include "render/hit.h"
#include "render/thin.h"
#include "shape/box_tree.h"
#include "shape/intersect.h"

struct Hierarchy {
    Embree embree;
    ClusterSet set;
    const Cluster *all;
    bool clear; /* something lets light through */
    bool plain; /* no line of sight goes on from anything */
    VistaPieces pieces;
    const Blockers *blockers; /* where the scene has media */
    double reach; /* from the middle of what is bounded; 0: there is nothing */
};

enum { SOLIDS = 0, TRIANGLES = 1 }; /* geomID in a cluster */

/* ---- what is met ---- */

typedef struct Query {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const Cluster *cluster;
    const struct Query *outer;
    const Item *copy; /* that this cluster is seen through */
    Ray ray;          /* in the cluster */
    double t_min, shift; /* Embree's t counts from shift */
    RayPurpose purpose;
    RayWidth width;   /* as t, the same in all clusters */
    bool any;         /* whatever is met will do */
    Found *found;
} Query;

static void keep_path(const Query *query, const Item *item) {
    int depth = 1;
    for (const Query *q = query; q->copy; q = q->outer) depth++;
    query->found->depth = depth;
    query->found->path[--depth] = item;
    for (const Query *q = query; q->copy; q = q->outer) query->found->path[--depth] = q->copy;
}

/* Places are not set: nothing within it has a look. */
static bool meet_plain(const Object *object, const Ray *ray, double t_min, double t_max, BodyHit *hit) {
    ShapeHit met;
    if (!shape_meet(object, ray, t_min, t_max, &met)) return false;
    hit->t = met.t;
    hit->normal = hit->flat = object->inverse ? vec3_negate(met.normal) : met.normal;
    hit->leaf = hit->data = object;
    hit->place = met.point;
    hit->tag = (SolidTag){.part = met.part};
    hit->looked = hit->filled = hit->cut_object = NULL;
    hit->hollow = false; /* the item knows */
    hit->cut = NULL;
    return true;
}

static bool cluster_meet(Query *query);

static bool meet_copy(const Query *outer, const Item *item) {
    Query query = {.cluster = item->cluster, .outer = outer, .copy = item, .ray = item_ray(item, &outer->ray), .t_min = outer->t_min,
                   .purpose = outer->purpose, .width = outer->width, .any = outer->any, .found = outer->found};
    return cluster_meet(&query);
}

/* Whether the item is met nearer than what was found so far, which it then replaces. */
static bool meet_item(const Query *query, const Item *item) {
    Found *found = query->found;
    if (item->hidden >> query->purpose & 1) return false;
    if (item->cluster) return meet_copy(query, item);
    const Ray ray = item_ray(item, &query->ray);
    if (query->any)
        return item->body ? body_crosses_wide(item->body, item->object, &ray, query->width, query->t_min, found->t)
                          : shape_crosses(item->object, &ray, query->t_min, found->t);
    BodyHit *hit = &found->body;
    bool met = item->body ? body_meet_wide(item->body, item->object, &ray, query->width, query->t_min, found->t, hit)
                          : meet_plain(item->object, &ray, query->t_min, found->t, hit);
    if (!met) return false;
    found->t = hit->t;
    found->normal = mat3_apply_transposed(&item->back.linear, hit->normal);
    found->flat = item->body ? mat3_apply_transposed(&item->back.linear, hit->flat) : found->normal;
    found->cluster = NULL;
    keep_path(query, item);
    return true;
}

/* ---- triangles ---- */

typedef struct ExactTriangle {
    Vec3 normal; /* (b - a) × (c - a) */
    double t;
} ExactTriangle;

/* Embree's t is as coarse as floats are; shadows start at it. */
static ExactTriangle exact_triangle(const Query *query, uint32_t number, double t) {
    uint32_t triangle;
    const Item *owner;
    const Cluster *c = query->cluster;
    const MeshData *mesh = cluster_triangle(c, number, &triangle, &owner);
    Vec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = mesh->vertices[mesh->triangles[triangle][k]];
    if (!c->mesh) {
        const Transform place = item_place(owner);
        for (int k = 0; k < 3; k++) p[k] = transform_point(&place, p[k]);
    }
    ExactTriangle out = {vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])), t};
    double exact = vec3_dot(out.normal, vec3_sub(p[0], query->ray.origin)) / vec3_dot(out.normal, query->ray.direction);
    double most = 1e-3 * fabs(t - query->shift) + 1e-5 * vec3_length(vec3_sub(c->bounds.max, c->bounds.min)) / vec3_length(query->ray.direction);
    if (fabs(exact - t) < most) out.t = exact; /* seen edge-on the plane says nothing */
    return out;
}

static void filter_triangle(const struct RTCFilterFunctionNArguments *args) {
    if (args->N != 1 || args->valid[0] != -1) return;
    const Query *query = (const Query *)(const void *)args->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)args->ray;
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)args->hit;
    double t = exact_triangle(query, hit->primID, query->shift + (double)ray->tfar).t;
    if (!(t > query->t_min && t < query->found->t)) args->valid[0] = 0;
}

static void keep_triangle(const Query *query, const struct RTCRayHit *rayhit) {
    Found *found = query->found;
    uint32_t triangle;
    const Item *owner;
    ExactTriangle exact = exact_triangle(query, rayhit->hit.primID, query->shift + (double)rayhit->ray.tfar);
    found->t = exact.t;
    found->cluster = query->cluster;
    found->triangle = rayhit->hit.primID;
    found->u = (double)rayhit->hit.u;
    found->v = (double)rayhit->hit.v;
    found->normal = found->flat = exact.normal;
    cluster_triangle(query->cluster, rayhit->hit.primID, &triangle, &owner);
    keep_path(query, owner);
}

/* ---- Embree ---- */

static void bound_item(const struct RTCBoundsFunctionArguments *args) {
    const Cluster *cluster = args->geometryUserPtr;
    Box3 box = item_box(&cluster->items.items[args->primID]);
    Vec3 size = vec3_sub(cluster->bounds.max, cluster->bounds.min);
    double margin = 3e-7 * (size.x + size.y + size.z) + 1e-30; /* floats are coarser than doubles */
    Vec3 low = vec3_sub(vec3_sub(box.min, cluster->origin), vec3_splat(margin)),
         high = vec3_add(vec3_sub(box.max, cluster->origin), vec3_splat(margin));
    struct RTCBounds *b = args->bounds_o;
    b->lower_x = (float)low.x, b->lower_y = (float)low.y, b->lower_z = (float)low.z;
    b->upper_x = (float)high.x, b->upper_y = (float)high.y, b->upper_z = (float)high.z;
}

static void intersect_item(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    const Query *query = (const Query *)(const void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    const Cluster *cluster = args->geometryUserPtr;
    double before = query->found->t; /* triangles that were met are not in it yet */
    query->found->t = fmin(before, query->shift + (double)rayhit->ray.tfar);
    if (!meet_item(query, &cluster->items.items[args->primID])) {
        query->found->t = before;
        return;
    }
    rayhit->ray.tfar = (float)(query->found->t - query->shift);
    rayhit->hit.geomID = SOLIDS;
    rayhit->hit.primID = args->primID;
}

static void occlude_item(const struct RTCOccludedFunctionNArguments *args) {
    if (!args->valid[0]) return;
    const Query *query = (const Query *)(const void *)args->context;
    const Cluster *cluster = args->geometryUserPtr;
    if (meet_item(query, &cluster->items.items[args->primID])) ((struct RTCRay *)(void *)args->ray)->tfar = -INFINITY;
}

static void attach(const Cluster *cluster, RTCGeometry geometry, unsigned id) {
    const EmbreeShim *rtc = cluster->embree->rtc;
    rtc->SetGeometryUserData(geometry, (void *)(uintptr_t)cluster);
    rtc->CommitGeometry(geometry);
    rtc->AttachGeometryByID(cluster->scene, geometry, id);
    rtc->ReleaseGeometry(geometry);
}

static void attach_solids(const Cluster *cluster) {
    const EmbreeShim *rtc = cluster->embree->rtc;
    RTCGeometry geometry = rtc->NewGeometry(cluster->embree->device, RTC_GEOMETRY_TYPE_USER);
    rtc->SetGeometryUserPrimitiveCount(geometry, (unsigned)cluster->loose);
    rtc->SetGeometryBoundsFunction(geometry, bound_item, NULL);
    rtc->SetGeometryIntersectFunction(geometry, intersect_item);
    rtc->SetGeometryOccludedFunction(geometry, occlude_item);
    attach(cluster, geometry, SOLIDS);
}

static void put_vertex(const Cluster *cluster, float *out, Vec3 p) {
    Vec3f f = vec3f_from(vec3_sub(p, cluster->origin));
    out[0] = f.x, out[1] = f.y, out[2] = f.z;
}

/* The mesh's own triangles serve Embree. */
static bool share_mesh(const Cluster *cluster, RTCGeometry geometry) {
    const EmbreeShim *rtc = cluster->embree->rtc;
    const MeshData *mesh = cluster->mesh;
    float *v = rtc->SetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh->vertex_count);
    if (!v) return false;
    for (size_t i = 0; i < mesh->vertex_count; i++) put_vertex(cluster, v + 3 * i, mesh->vertices[i]);
    rtc->SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0, sizeof *mesh->triangles, mesh->triangle_count);
    return true;
}

static bool fill_single(const Cluster *cluster, RTCGeometry geometry) {
    const EmbreeShim *rtc = cluster->embree->rtc;
    const size_t count = cluster->triangles.count;
    float *vertices = rtc->SetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count);
    unsigned *indices = rtc->SetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count);
    if (!vertices || !indices) return false;
    for (size_t i = 0; i < cluster->triangles.count; i++) {
        const ClusterTriangle *t = &cluster->triangles.items[i];
        const Item *owner = &cluster->owners.items[t->owner];
        const Transform place = item_place(owner);
        const MeshData *mesh = owner->object->as.mesh;
        for (size_t k = 0; k < 3; k++) {
            put_vertex(cluster, vertices + 9 * i + 3 * k, transform_point(&place, mesh->vertices[mesh->triangles[t->triangle][k]]));
            indices[3 * i + k] = (unsigned)(3 * i + k);
        }
    }
    return true;
}

static size_t triangles_of(const Cluster *cluster) { return cluster->mesh ? cluster->mesh->triangle_count : cluster->triangles.count; }

/* Whether so few rays are to come that a tree in the order of Morton's codes pays, which takes a fifth of the time to build: rays through it
 * take a ninth longer, about a sixteenth of what a triangle costs less. */
static bool is_brief(const Cluster *cluster, double rays) { return 16 * (double)triangles_of(cluster) > rays; }

static bool attach_triangles(const Cluster *cluster, double rays) {
    const EmbreeShim *rtc = cluster->embree->rtc;
    RTCGeometry geometry = rtc->NewGeometry(cluster->embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!(cluster->mesh ? share_mesh : fill_single)(cluster, geometry)) {
        rtc->ReleaseGeometry(geometry);
        return false;
    }
    if (is_brief(cluster, rays)) rtc->SetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtc->SetGeometryIntersectFilterFunction(geometry, filter_triangle);
    rtc->SetGeometryOccludedFilterFunction(geometry, filter_triangle);
    attach(cluster, geometry, TRIANGLES);
    return true;
}

/* Of more triangles than this Embree keeps the numbers of their vertices in place of copies. */
enum { VAST = 2000000 };

static bool commit(const Embree *embree, Cluster *cluster, double rays) {
    const EmbreeShim *rtc = embree->rtc;
    bool ok = true;
    cluster->embree = embree;
    cluster->scene = rtc->NewScene(embree->device);
    const bool vast = cluster->mesh && cluster->mesh->triangle_count > VAST;
    rtc->SetSceneFlags(cluster->scene, vast ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
    if (is_brief(cluster, rays)) rtc->SetSceneBuildQuality(cluster->scene, RTC_BUILD_QUALITY_LOW);
    if (cluster->loose) attach_solids(cluster);
    if (triangles_of(cluster)) ok = attach_triangles(cluster, rays);
    rtc->CommitScene(cluster->scene);
    return ok && rtc->GetDeviceError(embree->device) == RTC_ERROR_NONE;
}

/* ---- what the eye can see ---- */

static bool is_convex(const Item *item) {
    if (item->body || item->cluster) return false;
    switch (item->object->kind) {
    case OBJECT_SPHERE:
    case OBJECT_BOX: return true;
    case OBJECT_CYLINDER:
    case OBJECT_CONE: return !item->object->as.cone.open;
    default: return false;
    }
}

static void add_piece(VistaPieces *pieces, const Item *item, bool convex) {
    const Box3 box = item_box(item);
    if (item->hidden >> RAY_SEES & 1) return;
    bool plane = !item->body && !item->cluster && item->object->kind == OBJECT_PLANE;
    if (!vec3_is_finite(box.min) || !vec3_is_finite(box.max)) pieces->endless |= !plane;
    else pieces->items[pieces->count++] = (VistaPiece){.box = box, .width = thin_item(item), .whole = thin_is_known(item), .object = convex ? hit_object_of(item) + 1 : 0};
}

static void find_pieces(const Cluster *all, Arena *arena, VistaPieces *out) {
    out->items = arena_new_array(arena, VistaPiece, all->items.count + all->owners.count + 1);
    for (size_t i = 0; i < all->items.count; i++) add_piece(out, &all->items.items[i], is_convex(&all->items.items[i]));
    for (size_t i = 0; i < all->owners.count; i++) add_piece(out, &all->owners.items[i], false);
}

const VistaPieces *hierarchy_pieces(const Hierarchy *h) { return &h->pieces; }
const Blockers *hierarchy_blockers(const Hierarchy *h) { return h->blockers; }

static bool is_few(const Hierarchy *h) {
    bool few = true;
    for (size_t i = 0; i < h->set.clusters.count; i++) few &= h->set.clusters.items[i]->few != NULL;
    return few;
}

bool hierarchy_start_embree(Hierarchy *h, DiagList *diags) {
    StrBuf why = {0};
    bool runs = h->embree.device || embree_start(&h->embree, &why);
    if (!runs) diag_error(diags, (Span){0}, "Embree cannot be started on this machine%s", why.size ? why.data : "");
    strbuf_free(&why);
    return runs;
}

Hierarchy *hierarchy_build(const Scene *scene, double rays, Arena *arena, DiagList *diags) {
    Hierarchy *h = arena_new(arena, Hierarchy);
    clusters_build(scene, arena, diags, &h->set);
    h->all = h->set.clusters.items[h->set.clusters.count - 1];
    if (!box3_is_empty(h->all->bounds)) h->reach = vec3_length(vec3_sub(h->all->bounds.max, h->all->bounds.min)) / 2;
    h->clear = !h->set.default_look->opaque;
    h->plain = h->set.default_look->plain;
    for (size_t i = 0; i < h->set.looks.slot_count; i++) {
        const Look *look = h->set.looks.slots[i];
        h->clear |= look && !look->opaque;
        h->plain &= !look || look->plain;
    }
    thin_clusters(&h->set);
    find_pieces(h->all, arena, &h->pieces);
    if (scene->has_media) h->blockers = blockers_find(h->all, arena);
    /* From here on nothing is taken from the arena: if memory ran out, the device would be lost. */
    if (!is_few(h) && !hierarchy_start_embree(h, diags)) return NULL;
    for (size_t i = 0; i < h->set.clusters.count; i++)
        if (!h->set.clusters.items[i]->few && !commit(&h->embree, h->set.clusters.items[i], rays)) {
            hierarchy_destroy(h);
            diag_error(diags, (Span){0}, "there is not enough memory for the objects");
            return NULL;
        }
    return h;
}

void hierarchy_destroy(Hierarchy *h) {
    if (!h) return;
    for (size_t i = 0; i < h->set.clusters.count; i++)
        if (h->set.clusters.items[i]->scene) h->embree.rtc->ReleaseScene(h->set.clusters.items[i]->scene);
    embree_stop(&h->embree);
}

size_t hierarchy_object_count(const Hierarchy *h) { return h->set.part_count; }

bool hierarchy_bounds(const Hierarchy *h, Box3 *box) {
    *box = h->all->box;
    if (box3_is_empty(*box)) return true;
    double margin = 1e-6 * vec3_length(vec3_sub(box->max, box->min));
    *box = (Box3){vec3_sub(box->min, vec3_splat(margin)), vec3_add(box->max, vec3_splat(margin))};
    return vec3_is_finite(box->min) && vec3_is_finite(box->max);
}

double hierarchy_coarseness(const Hierarchy *h, Vec3 point) {
    return h->reach > 0 ? 1e-6 * double_min(vec3_length(vec3_sub(point, h->all->origin)), h->reach) : 0;
}
bool hierarchy_is_plain(const Hierarchy *h) { return h->plain; }
bool hierarchy_blends(const Hierarchy *h) { return h->set.blends; }
void hierarchy_work(const Hierarchy *h, SolidWork *sum) { shape_tracer_work(h->set.shapes, sum); }
bool hierarchy_is_clear(const Hierarchy *h) { return h->clear; }
const Embree *hierarchy_embree(const Hierarchy *h) { return &h->embree; }

/* ---- rays ---- */

/* The part of the ray that is near what Embree knows, so that its floats are as fine as the cluster is small; false for none. */
static bool to_embree(Query *query, struct RTCRay *out) {
    const Cluster *c = query->cluster;
    if (box3_is_empty(c->bounds)) return false;
    Vec3 size = vec3_sub(c->bounds.max, c->bounds.min), margin = vec3_splat(1e-6 * (size.x + size.y + size.z) + 1e-30);
    const Box3 box = {vec3_sub(c->bounds.min, margin), vec3_add(c->bounds.max, margin)};
    double near = query->t_min, far = query->found->t;
    if (!box_tree_clip(&box, &query->ray, &near, &far)) return false;
    query->shift = isfinite(near) ? near : 0;
    Vec3 from = vec3_madd(query->ray.origin, query->ray.direction, query->shift);
    Vec3f o = vec3f_from(vec3_sub(from, c->origin)), d = vec3f_from(query->ray.direction);
    double span = far - query->shift;
    *out = (struct RTCRay){.org_x = o.x, .org_y = o.y, .org_z = o.z, .dir_x = d.x, .dir_y = d.y, .dir_z = d.z,
                           .tnear = 0, .tfar = span < 1e30 ? (float)(span * (1 + 1e-6)) : INFINITY, .mask = UINT32_MAX};
    return embree_takes(out);
}

static bool meet_loose(const Query *query) {
    bool met = false;
    const ItemList *items = &query->cluster->items;
    for (size_t i = query->cluster->loose; i < items->count; i++) {
        met |= meet_item(query, &items->items[i]);
        if (met && query->any) break;
    }
    return met;
}

static bool clip(double low, double high, double origin, double inverse, double *near, double *far) {
    double in = (low - origin) * inverse, out = (high - origin) * inverse;
    if (in > out) {
        double swap = in;
        in = out, out = swap;
    }
    if (in > *near) *near = in;
    if (out < *far) *far = out;
    return *near <= *far;
}

/* Those that need no tree. */
static bool meet_few(const Query *query) {
    const Cluster *cluster = query->cluster;
    const Vec3 o = query->ray.origin, d = query->ray.direction, inverse = vec3(1 / d.x, 1 / d.y, 1 / d.z);
    bool met = false;
    for (size_t i = 0; i < cluster->loose; i++) {
        const Box3 *box = &cluster->few[i];
        double near = query->t_min, far = query->found->t;
        if (!clip(box->min.x, box->max.x, o.x, inverse.x, &near, &far) || !clip(box->min.y, box->max.y, o.y, inverse.y, &near, &far) ||
            !clip(box->min.z, box->max.z, o.z, inverse.z, &near, &far))
            continue;
        met |= meet_item(query, &cluster->items.items[i]);
        if (met && query->any) break;
    }
    return met;
}

static bool cluster_meet(Query *query) {
    struct RTCRayHit rayhit = {.hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    bool met = meet_loose(query);
    if (query->cluster->few) return (met && query->any) || meet_few(query) || met;
    if ((met && query->any) || !to_embree(query, &rayhit.ray)) return met;
    rtcInitIntersectContext(&query->context);
    if (query->any) {
        query->cluster->embree->rtc->Occluded1(query->cluster->scene, &query->context, &rayhit.ray);
        return rayhit.ray.tfar < 0;
    }
    query->cluster->embree->rtc->Intersect1(query->cluster->scene, &query->context, &rayhit);
    if (rayhit.hit.geomID == TRIANGLES) keep_triangle(query, &rayhit);
    return met || rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static bool meet(const Hierarchy *h, RayPurpose purpose, bool any, const Ray *ray, RayWidth width, double t_min, double t_max, Found *found) {
    if (!vec3_is_finite(ray->origin) || !vec3_is_finite(ray->direction)) return false;
    found->t = t_max;
    Query query = {.cluster = h->all, .ray = *ray, .t_min = t_min, .purpose = purpose, .width = width, .any = any, .found = found};
    return cluster_meet(&query);
}

static const RayWidth LINE = {0, 0};

bool hierarchy_meet_wide(const Hierarchy *h, RayPurpose purpose, const Ray *ray, RayWidth width, double t_min, double t_max, bool places, SurfaceHit *hit) {
    Found found;
    if (!meet(h, purpose, false, ray, width, t_min, t_max, &found)) return false;
    hit_finish(&h->set, &found, ray, places, hit);
    return true;
}

bool hierarchy_meet(const Hierarchy *h, RayPurpose purpose, const Ray *ray, double t_min, double t_max, SurfaceHit *hit) {
    return hierarchy_meet_wide(h, purpose, ray, LINE, t_min, t_max, true, hit);
}

bool hierarchy_glimpse(const Hierarchy *h, RayPurpose purpose, const Ray *ray, double t_min, double t_max, SurfaceHit *hit) {
    return hierarchy_meet_wide(h, purpose, ray, LINE, t_min, t_max, false, hit);
}

bool hierarchy_intersect(const Hierarchy *h, const Ray *ray, double t_min, double t_max, SurfaceHit *hit) {
    return hierarchy_meet(h, RAY_SEES, ray, t_min, t_max, hit);
}

bool hierarchy_occluded_wide(const Hierarchy *h, const Ray *ray, RayWidth width, double t_min, double t_max) {
    Found found;
    return meet(h, RAY_SHADOWS, true, ray, width, t_min, t_max, &found);
}

bool hierarchy_occluded(const Hierarchy *h, const Ray *ray, double t_min, double t_max) {
    return hierarchy_occluded_wide(h, ray, LINE, t_min, t_max);
}

size_t hierarchy_inside(const Hierarchy *h, Vec3 point, Filling *out, size_t most) {
    const InsideSearch search = {.cluster = h->all, .point = point, .to_cluster = {transform_identity().linear, vec3_splat(0)}};
    return vec3_is_finite(point) ? inside_gather(&search, out, 0, most) : 0;
}
