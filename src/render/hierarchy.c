#include "render/hierarchy.h"

#include "grow/particles.h"
#include "pattern/pattern.h"
#include "render/embree_ray.h"
#include "shape/extent.h"
#include "shape/intersect.h"
#include "shape/surface_mesh.h"
#include "shape/tessellate.h"

#include <embree3/rtcore.h>
#include <stdlib.h>
#include <string.h>

/* Something drawn: one solid, or one set of triangles. */
typedef struct Part {
    const Object *object; /* the solid; NULL for triangles */
    Transform to_world;
    const Look *look;
    bool casts_shadow, visible;
    TriangleSoup soup; /* world space */
    const Vec3 *origin; /* the hierarchy's */
} Part;

typedef struct PartList {
    Part **items;
    size_t count, capacity;
} PartList;

struct Hierarchy {
    RTCDevice device;
    RTCScene scene;
    Vec3 origin;      /* Embree's floats count from here, the middle of the scene: what is far from <0, 0, 0> stays exact */
    PartList parts;   /* geomID − 1 … in the order of attachment */
    PartList planes;  /* endless: tested one by one */
};

typedef struct Builder {
    Hierarchy *hierarchy;
    const Scene *scene;
    Arena *arena;
    DiagList *diags;
    double tolerance;
    ShapeTracer *tracer;
} Builder;

static const Look *make_look(Builder *b, const Texture *texture) {
    Look *look = arena_new(b->arena, Look);
    *look = look_from_texture(texture, &b->scene->settings);
    return look;
}

static Part *add_part(Builder *b, PartList *list, const Object *object, const Transform *to_world, const Look *look) {
    Part *part = arena_new(b->arena, Part);
    *part = (Part){.object = object, .to_world = *to_world, .look = look, .casts_shadow = !object->no_shadow,
                   .visible = !object->no_image, .origin = &b->hierarchy->origin};
    *list_push(b->arena, list) = part;
    return part;
}

static void add_triangles(Builder *b, const Object *object, const Transform *parent, const Transform *to_world, const Look *look) {
    Part *part = add_part(b, &b->hierarchy->parts, object, to_world, look);
    TessellateOptions options = {.tolerance = b->tolerance, .particles = particles_tessellate};
    ShapeRefusal refusal;
    part->object = NULL;
    if (!tessellate(object, parent, &options, b->arena, &part->soup, &refusal)) {
        diag_warning(b->diags, refusal.span, "not drawn: %s", refusal.reason);
        b->hierarchy->parts.count--;
    }
}

/* How far triangles may be off what they stand for: a fraction of a pixel of usual pictures, where the object is nearest. */
static double view_tolerance(const Builder *b, Box3 box) {
    static const double SHARE = 5e-4;
    const Camera *camera = &b->scene->camera;
    double width = vec3_length(camera->right);
    if (camera->kind == CAMERA_PERSPECTIVE) {
        Vec3 nearest = vec3_max(box.min, vec3_min(box.max, camera->location));
        width *= vec3_length(vec3_sub(nearest, camera->location)) / vec3_length(camera->direction);
    }
    Vec3 size = vec3_sub(box.max, box.min);
    double tolerance = double_clamp(SHARE * width, 0.01 * b->tolerance, 0.01 * vec3_length(size));
    return isfinite(tolerance) && tolerance > 0 ? tolerance : b->tolerance;
}

/* The triangles of one surface of a set, which has its own texture. */
static void add_set_surface(Builder *b, const Object *object, const TriangleSoup *soup, size_t surface,
                            const TessellateSurface *from, const Texture *inherited) {
    TriangleSoup own = {.vertices = soup->vertices};
    for (size_t t = 0; t < soup->triangles.count; t++)
        if (soup->triangles.items[t].surface == surface) *list_push(b->arena, &own.triangles) = soup->triangles.items[t];
    if (own.triangles.count == 0) return;
    Part *part = add_part(b, &b->hierarchy->parts, object, &from->place, make_look(b, from->texture ? from->texture : inherited));
    part->object = NULL;
    part->soup = own;
}

static bool looks_alike(const TessellateSurface *a, const TessellateSurface *b) { return a->texture == b->texture; }

/* Surfaces with the same texture become one part. */
static void add_set(Builder *b, const Object *object, const Transform *parent, const Texture *inherited) {
    TessellateSurfaces surfaces = {0};
    ShapeRefusal refusal, doubt = {0};
    TriangleSoup soup = {0};
    Transform own = object_transform(object), to_world = transform_then(&own, parent);
    Box3 box = box3_transform(parent, shape_extent(b->tracer, object));
    const TessellateOptions options = {.tolerance = view_tolerance(b, box), .particles = particles_tessellate, .doubt = &doubt,
                                       .surfaces = &surfaces};
    if (!tessellate(object, parent, &options, b->arena, &soup, &refusal)) {
        diag_warning(b->diags, refusal.span, "not drawn: %s", refusal.reason);
        return;
    }
    if (doubt.reason) diag_warning(b->diags, doubt.span, "this is coarser than asked: %s", doubt.reason);
    if (surfaces.count == 0) *list_push(b->arena, &surfaces) = (TessellateSurface){NULL, to_world};
    for (size_t t = 0; t < soup.triangles.count; t++) {
        uint16_t surface = soup.triangles.items[t].surface;
        for (uint16_t i = 0; i < surface; i++)
            if (looks_alike(&surfaces.items[i], &surfaces.items[surface])) {
                soup.triangles.items[t].surface = i;
                break;
            }
    }
    for (size_t i = 0; i < surfaces.count; i++) add_set_surface(b, object, &soup, i, &surfaces.items[i], inherited);
}

static void add_surface(Builder *b, const Object *object, const Transform *to_world, const Look *look) {
    SurfaceMeshOptions options = {.tolerance = b->tolerance};
    SurfaceMesh mesh;
    ShapeRefusal refusal;
    const Surface *surface = object->as.surface;
    if (!surface_mesh_build(surface, &options, b->arena, &mesh, &refusal)) {
        diag_error(b->diags, refusal.span, "this surface cannot be drawn: %s", refusal.reason);
        return;
    }
    Part *part = add_part(b, &b->hierarchy->parts, object, to_world, look);
    part->object = NULL;
    TriangleSoup *soup = &part->soup;
    for (size_t i = 0; i < mesh.vertex_count; i++)
        soup_vertex(b->arena, soup, transform_point(to_world, mesh.vertices[i]), vec3(0, 0, 0), (double)NAN, (double)NAN);
    /* A bilinear patch is cut along both diagonals through its middle, which lies on the patch. */
    for (size_t i = 0; i < mesh.cell_count; i++) {
        const SurfaceCell *cell = &mesh.cells[i];
        const uint32_t *v = cell->vertex;
        if (cell->corner_count == 3) {
            soup_triangle(b->arena, soup, v[0], v[1], v[2], false);
            continue;
        }
        Vec3 middle = vec3(0, 0, 0);
        for (int k = 0; k < 4; k++) middle = vec3_madd(middle, mesh.vertices[v[k]], 0.25);
        uint32_t m = soup_vertex(b->arena, soup, transform_point(to_world, middle), vec3(0, 0, 0), (double)NAN, (double)NAN);
        for (int k = 0; k < 4; k++) soup_triangle(b->arena, soup, v[k], v[(k + 1) % 4], m, false);
    }
}

/* Flattens the tree of objects: each leaf gets its own part, the transform to the scene and the texture it inherits. */
static void add_object(Builder *b, const Object *object, const Transform *parent, const Texture *inherited) {
    Transform own = object_transform(object), to_world = transform_then(&own, parent);
    const Texture *texture = object->texture ? object->texture : inherited;
    if (object_clipped_by(object).count) {
        add_set(b, object, parent, texture);
        return;
    }
    switch (object->kind) {
    case OBJECT_UNION:
    case OBJECT_MERGE:
        for (size_t i = 0; i < object->as.group->count; i++) add_object(b, object->as.group->items[i], &to_world, texture);
        return;
    case OBJECT_SPHERE: case OBJECT_BOX: case OBJECT_CYLINDER: case OBJECT_CONE: case OBJECT_DISC: case OBJECT_TORUS:
        add_part(b, &b->hierarchy->parts, object, &to_world, make_look(b, texture));
        return;
    case OBJECT_PLANE: add_part(b, &b->hierarchy->planes, object, &to_world, make_look(b, texture)); return;
    case OBJECT_TRIANGLES:
    case OBJECT_PARTICLES: add_triangles(b, object, parent, &to_world, make_look(b, texture)); return;
    case OBJECT_SURFACE:
        if (!object->texture && object->as.surface->texture) texture = object->as.surface->texture;
        add_surface(b, object, &to_world, make_look(b, texture));
        return;
    case OBJECT_TEXEL: return; /* a skin of its own */
    case OBJECT_INTERSECTION:
    case OBJECT_DIFFERENCE:
    case OBJECT_SOLID: add_set(b, object, parent, texture); return;
    case OBJECT_UNMODELLED:
        return; /* named in a warning when the scene was read */
    }
}

/* ---- Embree ---- */

static void bound_solid(const struct RTCBoundsFunctionArguments *args) {
    const Part *part = args->geometryUserPtr;
    Box3 box = box3_transform(&part->to_world, shape_bounds(part->object));
    box = (Box3){vec3_sub(box.min, *part->origin), vec3_sub(box.max, *part->origin)};
    Vec3 m = vec3_max(vec3_max(vec3_negate(box.min), box.max), vec3_max(box.min, vec3_negate(box.max)));
    double margin = 1e-6 * (m.x + m.y + m.z) + 1e-30; /* floats are coarser than doubles */
    struct RTCBounds *b = args->bounds_o;
    b->lower_x = (float)(box.min.x - margin), b->upper_x = (float)(box.max.x + margin);
    b->lower_y = (float)(box.min.y - margin), b->upper_y = (float)(box.max.y + margin);
    b->lower_z = (float)(box.min.z - margin), b->upper_z = (float)(box.max.z + margin);
}

typedef struct HitQuery {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const Ray *ray;
    double t_min, t;
    Vec3 normal; /* of the nearest solid so far, scene space, not normalised */
    const Part *part;
    bool shadow;
} HitQuery;

static bool hit_solid(const Part *part, const Ray *ray, double t_min, double t_max, double *t, Vec3 *normal) {
    Ray local = {transform_point_back(&part->to_world, ray->origin), transform_vector_back(&part->to_world, ray->direction)};
    ShapeHit hit;
    if (!shape_intersect(part->object, &local, t_min, t_max, &hit)) return false;
    *t = hit.t;
    *normal = transform_normal(&part->to_world, hit.normal);
    return true;
}

static void try_part(HitQuery *query, const Part *part) {
    double t;
    Vec3 normal;
    if (query->shadow ? !part->casts_shadow : !part->visible) return;
    if (!hit_solid(part, query->ray, query->t_min, query->t, &t, &normal) || t >= query->t) return;
    query->t = t;
    query->normal = normal;
    query->part = part;
}

static void intersect_solid(const struct RTCIntersectFunctionNArguments *args) {
    if (!args->valid[0]) return;
    HitQuery *query = (HitQuery *)(void *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)(void *)args->rayhit;
    double before = query->t;
    query->t = fmin(query->t, (double)rayhit->ray.tfar);
    const Part *part = args->geometryUserPtr, *nearest = query->part;
    query->part = NULL;
    try_part(query, part);
    if (!query->part) {
        query->t = before;
        query->part = nearest;
        return;
    }
    rayhit->ray.tfar = (float)query->t;
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
}

static void occlude_solid(const struct RTCOccludedFunctionNArguments *args) {
    if (!args->valid[0]) return;
    HitQuery *query = (HitQuery *)(void *)args->context;
    try_part(query, args->geometryUserPtr);
    if (query->part) ((struct RTCRay *)(void *)args->ray)->tfar = -INFINITY;
}

enum { MASK_CAMERA = 1, MASK_SHADOW = 2 };

static RTCGeometry triangle_geometry(RTCDevice device, const Part *part) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    size_t nv = part->soup.vertices.count, nt = part->soup.triangles.count;
    float *v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), nv);
    unsigned *t = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), nt);
    for (size_t i = 0; i < nv; i++) {
        Vec3 p = vec3_sub(part->soup.vertices.items[i].position, *part->origin);
        v[3 * i] = (float)p.x, v[3 * i + 1] = (float)p.y, v[3 * i + 2] = (float)p.z;
    }
    for (size_t i = 0; i < nt; i++)
        for (int k = 0; k < 3; k++) t[3 * i + (size_t)k] = part->soup.triangles.items[i].vertex[k];
    return geometry;
}

static void attach(Hierarchy *h, Part *part) {
    RTCGeometry geometry;
    if (part->object) {
        geometry = rtcNewGeometry(h->device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcSetGeometryBoundsFunction(geometry, bound_solid, NULL);
        rtcSetGeometryIntersectFunction(geometry, intersect_solid);
        rtcSetGeometryOccludedFunction(geometry, occlude_solid);
    } else {
        geometry = triangle_geometry(h->device, part);
    }
    rtcSetGeometryUserData(geometry, part);
    rtcSetGeometryMask(geometry, (part->visible ? MASK_CAMERA : 0u) | (part->casts_shadow ? MASK_SHADOW : 0u));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(h->scene, geometry);
    rtcReleaseGeometry(geometry);
}

/* Of everything finite: what is small in the scene is small against its size. */
static Box3 scene_box(const Scene *scene) {
    Box3 box = box3_empty();
    for (size_t i = 0; i < scene->object_count; i++) {
        const Object *object = scene->objects[i];
        Box3 own = shape_bounds(object);
        Transform place = object_transform(object);
        if (vec3_is_finite(own.min) && vec3_is_finite(own.max)) box = box3_union(box, box3_transform(&place, own));
    }
    return box3_is_empty(box) ? (Box3){{0, 0, 0}, {1, 0, 0}} : box;
}

Hierarchy *hierarchy_build(const Scene *scene, Arena *arena, DiagList *diags) {
    Hierarchy *h = arena_new(arena, Hierarchy);
    Box3 box = scene_box(scene);
    h->origin = vec3_scale(vec3_add(box.min, box.max), 0.5);
    Builder builder = {h, scene, arena, diags, 1e-4 * fmax(vec3_length(vec3_sub(box.max, box.min)), 1e-6),
                       shape_tracer_create(arena)};
    Transform identity = transform_identity();
    for (size_t i = 0; i < scene->object_count; i++) add_object(&builder, scene->objects[i], &identity, scene->default_texture);
    /* From here on nothing is taken from the arena: if memory ran out, the device would be lost. */
    h->device = rtcNewDevice("threads=1,set_affinity=0");
    if (!h->device) {
        diag_error(diags, (Span){0}, "Embree cannot be started on this machine");
        return NULL;
    }
    h->scene = rtcNewScene(h->device);
    rtcSetSceneFlags(h->scene, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < h->parts.count; i++) attach(h, h->parts.items[i]);
    rtcCommitScene(h->scene);
    return h;
}

void hierarchy_destroy(Hierarchy *h) {
    if (!h) return;
    if (h->scene) rtcReleaseScene(h->scene);
    if (h->device) rtcReleaseDevice(h->device);
}

size_t hierarchy_object_count(const Hierarchy *h) { return h->parts.count + h->planes.count; }
bool hierarchy_bounds(const Hierarchy *h, Box3 *box) {
    struct RTCBounds b;
    *box = box3_empty();
    if (h->planes.count) return false;
    if (!h->parts.count) return true;
    rtcGetSceneBounds(h->scene, &b);
    Vec3 lower = vec3((double)b.lower_x, (double)b.lower_y, (double)b.lower_z), upper = vec3((double)b.upper_x, (double)b.upper_y, (double)b.upper_z);
    double margin = 1e-6 * vec3_length(vec3_sub(upper, lower));
    *box = (Box3){vec3_sub(vec3_add(h->origin, lower), vec3_splat(margin)), vec3_add(vec3_add(h->origin, upper), vec3_splat(margin))};
    return vec3_is_finite(box->min) && vec3_is_finite(box->max);
}

void *hierarchy_device(const Hierarchy *h) { return h->device; }

static struct RTCRay to_embree(const Hierarchy *h, const Ray *ray, double t_min, double t_max, unsigned mask) {
    Vec3f o = vec3f_from(vec3_sub(ray->origin, h->origin));
    return (struct RTCRay){.org_x = o.x, .org_y = o.y, .org_z = o.z,
                           .dir_x = (float)ray->direction.x, .dir_y = (float)ray->direction.y, .dir_z = (float)ray->direction.z,
                           .tnear = (float)t_min, .tfar = t_max < 1e30 ? (float)t_max : INFINITY, .mask = mask};
}

static uint32_t part_number(const Hierarchy *h, const Part *part) {
    for (size_t i = 0; i < h->planes.count; i++)
        if (h->planes.items[i] == part) return (uint32_t)(h->parts.count + i);
    return UINT32_MAX;
}

/* The hit again in doubles: Embree's t is as coarse as floats at the ray's origin are, and shadows start there. */
static double on_triangle(const Part *part, unsigned triangle, const Ray *ray, double t, Vec3 *normal) {
    const uint32_t *v = part->soup.triangles.items[triangle].vertex;
    const SoupVertex *at = part->soup.vertices.items;
    Vec3 p = at[v[0]].position;
    *normal = vec3_cross(vec3_sub(at[v[1]].position, p), vec3_sub(at[v[2]].position, p));
    double exact = vec3_dot(*normal, vec3_sub(p, ray->origin)) / vec3_dot(*normal, ray->direction);
    return fabs(exact - t) < 1e-3 * fabs(t) ? exact : t; /* seen edge-on the plane says nothing */
}

bool hierarchy_intersect(const Hierarchy *h, const Ray *ray, double t_min, double t_max, SurfaceHit *hit) {
    HitQuery query = {.ray = ray, .t_min = t_min, .t = t_max};
    rtcInitIntersectContext(&query.context);
    for (size_t i = 0; i < h->planes.count; i++) try_part(&query, h->planes.items[i]);
    const Part *plane = query.part;
    struct RTCRayHit rayhit = {.ray = to_embree(h, ray, t_min, query.t, MASK_CAMERA), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    if (embree_takes(&rayhit.ray)) rtcIntersect1(h->scene, &query.context, &rayhit);
    const Part *part = plane;
    if (rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        part = h->parts.items[rayhit.hit.geomID];
        hit->object = rayhit.hit.geomID;
        if (part->object) {
            hit->t = query.t;
        } else {
            hit->t = on_triangle(part, rayhit.hit.primID, ray, (double)rayhit.ray.tfar, &query.normal);
        }
    } else if (part) {
        hit->object = part_number(h, part);
        hit->t = query.t;
    } else {
        return false;
    }
    Vec3 normal = vec3_normalize(query.normal);
    hit->flat = vec3_dot(normal, ray->direction) > 0 ? vec3_negate(normal) : normal;
    if (!part->object && part->soup.vertices.items) {
        /* Smooth normals where the triangles have them. */
        const SoupTriangle *triangle = &part->soup.triangles.items[rayhit.hit.primID];
        const SoupVertex *v = part->soup.vertices.items;
        double u = (double)rayhit.hit.u, w = (double)rayhit.hit.v;
        Vec3 smooth = vec3_madd(vec3_madd(vec3_scale(v[triangle->vertex[0]].normal, 1 - u - w), v[triangle->vertex[1]].normal, u),
                                v[triangle->vertex[2]].normal, w);
        if (vec3_length_squared(smooth) > 0.01) normal = vec3_normalize(smooth);
    }
    hit->normal = vec3_dot(normal, ray->direction) > 0 ? vec3_negate(normal) : normal;
    hit->look = part->look;
    hit->space = part->to_world;
    hit->uv = (TexCoord){0, 0};
    hit->leaving = vec3_dot(query.normal, ray->direction) > 0;
    hit->solid = part->object;
    hit->interior = NULL;
    hit->filled = hit->object;
    return true;
}

bool hierarchy_meet(const Hierarchy *h, RayPurpose purpose, const Ray *ray, double t_min, double t_max, SurfaceHit *hit) {
    (void)purpose;
    return hierarchy_intersect(h, ray, t_min, t_max, hit);
}

bool hierarchy_occluded(const Hierarchy *h, const Ray *ray, double t_min, double t_max) {
    HitQuery query = {.ray = ray, .t_min = t_min, .t = t_max, .shadow = true};
    rtcInitIntersectContext(&query.context);
    for (size_t i = 0; i < h->planes.count && !query.part; i++) try_part(&query, h->planes.items[i]);
    if (query.part) return true;
    struct RTCRay shadow = to_embree(h, ray, t_min, t_max, MASK_SHADOW);
    if (embree_takes(&shadow)) rtcOccluded1(h->scene, &query.context, &shadow);
    return shadow.tfar < 0;
}
