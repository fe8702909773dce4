#include "render/exact_texel.h"

#include <embree3/rtcore.h>

typedef struct ExactLayer {
    Vec3f *vertices;
    uint32_t (*triangles)[3];
    size_t vertex_count, triangle_count;
} ExactLayer;

struct ExactTexel {
    Vec3 extent;
    bool cyclic[3];
    ExactLayer *layers;
    size_t layer_count;
    RTCScene scene;
};

/* A triangle is repeated at most so often along an axis; the voxels have the same limit. */
enum { MOST_WRAPS = 64, MOST_PERIODS = 1 << 12 };
/* Content in the walls of the box counts as inside, whatever rounding says; in extents. */
static const double WALL = 1e-5;

ExactTexel *exact_texel_begin(Vec3f extent, unsigned cyclic, size_t layers, Arena *arena) {
    ExactTexel *texel = arena_new(arena, ExactTexel);
    *texel = (ExactTexel){.extent = vec3_from_f(extent), .layers = arena_new_array(arena, ExactLayer, layers)};
    for (int k = 0; k < 3; k++) texel->cyclic[k] = cyclic >> k & 1;
    return texel;
}

/* ---- wrapping ---- */

/* Periods by which a triangle is to be moved so that some of it is in the box, along each axis. */
typedef struct Wraps {
    int from[3], to[3];
} Wraps;

static bool find_wraps(const ExactTexel *texel, const Vec3f corner[3], Wraps *out) {
    for (int k = 0; k < 3; k++) {
        double size = vec3_get(texel->extent, k), lo = VTS_INFINITY, hi = -VTS_INFINITY;
        for (int i = 0; i < 3; i++) {
            double x = vec3_get(vec3_from_f(corner[i]), k) / size;
            if (!isfinite(x)) return false;
            lo = double_min(lo, x), hi = double_max(hi, x);
        }
        out->from[k] = out->to[k] = 0;
        if (texel->cyclic[k]) {
            if (hi - lo > MOST_WRAPS || fabs(lo) > 1e6) return false;
            out->from[k] = (int)ceil(-hi - WALL);
            out->to[k] = (int)floor(1 - lo + WALL);
        } else if (hi < -WALL || lo > 1 + WALL) {
            return false;
        }
    }
    return true;
}

static size_t wrap_count(const Wraps *w) {
    size_t count = 1;
    for (int k = 0; k < 3; k++) count *= (size_t)(w->to[k] - w->from[k] + 1);
    return count;
}

static void add_moved(const ExactTexel *texel, ExactLayer *layer, const Vec3f corner[3], int x, int y, int z) {
    Vec3 move = vec3_mul(vec3(x, y, z), texel->extent);
    uint32_t *triangle = layer->triangles[layer->triangle_count++];
    for (int i = 0; i < 3; i++) {
        triangle[i] = (uint32_t)layer->vertex_count;
        layer->vertices[layer->vertex_count++] = vec3f_from(vec3_add(vec3_from_f(corner[i]), move));
    }
}

static void add_wrapped(const ExactTexel *texel, ExactLayer *layer, const Vec3f corner[3], const Wraps *w) {
    for (int z = w->from[2]; z <= w->to[2]; z++)
        for (int y = w->from[1]; y <= w->to[1]; y++)
            for (int x = w->from[0]; x <= w->to[0]; x++) add_moved(texel, layer, corner, x, y, z);
}

static bool load_corners(const TexelMesh *mesh, size_t triangle, Vec3f corner[3]) {
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangles[triangle][i];
        if (v >= mesh->vertex_count) return false;
        corner[i] = mesh->vertices[v];
    }
    return true;
}

void exact_texel_add_layer(ExactTexel *texel, const TexelMesh *mesh, Arena *arena) {
    ExactLayer *layer = &texel->layers[texel->layer_count++];
    size_t count = 0;
    Vec3f corner[3];
    Wraps wraps;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        if (load_corners(mesh, i, corner) && find_wraps(texel, corner, &wraps)) count += wrap_count(&wraps);
    layer->vertices = arena_new_array(arena, Vec3f, 3 * count + 1); /* Embree reads 16 bytes at the last one */
    layer->triangles = arena_push_array_(arena, count, sizeof *layer->triangles);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        if (load_corners(mesh, i, corner) && find_wraps(texel, corner, &wraps)) add_wrapped(texel, layer, corner, &wraps);
}

/* ---- Embree ---- */

static void attach_layer(ExactTexel *texel, RTCDevice device, unsigned number) {
    const ExactLayer *layer = &texel->layers[number];
    if (layer->triangle_count == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, layer->vertices, 0, sizeof(Vec3f), layer->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, layer->triangles, 0, 3 * sizeof(uint32_t),
                               layer->triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(texel->scene, geometry, number);
    rtcReleaseGeometry(geometry);
}

bool exact_texel_commit(ExactTexel *texel, void *embree_device) {
    RTCDevice device = embree_device;
    texel->scene = rtcNewScene(device);
    if (!texel->scene) return false;
    rtcSetSceneFlags(texel->scene, RTC_SCENE_FLAG_ROBUST);
    for (size_t i = 0; i < texel->layer_count; i++) attach_layer(texel, device, (unsigned)i);
    rtcCommitScene(texel->scene);
    return rtcGetDeviceError(device) == RTC_ERROR_NONE;
}

void exact_texel_destroy(ExactTexel *texel) {
    if (!texel || !texel->scene) return;
    rtcReleaseScene(texel->scene);
    texel->scene = NULL;
}

size_t exact_texel_triangles(const ExactTexel *texel) {
    size_t count = 0;
    for (size_t i = 0; i < texel->layer_count; i++) count += texel->layers[i].triangle_count;
    return count;
}

static void describe_hit(const ExactTexel *texel, const struct RTCHit *found, Vec3 period, ExactTexelHit *hit) {
    const ExactLayer *layer = &texel->layers[found->geomID];
    const uint32_t *v = layer->triangles[found->primID];
    Vec3 a = vec3_from_f(layer->vertices[v[0]]), b = vec3_from_f(layer->vertices[v[1]]), c = vec3_from_f(layer->vertices[v[2]]);
    hit->layer = found->geomID;
    hit->period = period;
    hit->corner = vec3_add(a, period);
    hit->normal = vec3_normalize(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* One period's triangles. Embree's floats count from the beginning of the piece. */
static bool shoot_period(const ExactTexel *texel, Vec3 from, Vec3 along, double s0, double s1, Vec3 period, ExactTexelHit *hit) {
    Vec3f o = vec3f_from(vec3_sub(vec3_madd(from, along, s0), period)), d = vec3f_from(along);
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit rayhit = {.ray = {.org_x = o.x, .org_y = o.y, .org_z = o.z, .dir_x = d.x, .dir_y = d.y, .dir_z = d.z,
                                       .tfar = (float)(s1 - s0), .mask = 0xFFFFFFFFu},
                               .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    if (!hit) {
        rtcOccluded1(texel->scene, &context, &rayhit.ray);
        return rayhit.ray.tfar < 0;
    }
    rtcIntersect1(texel->scene, &context, &rayhit);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit->s = s0 + (double)rayhit.ray.tfar;
    describe_hit(texel, &rayhit.hit, period, hit);
    return true;
}

/* Narrows [*s0, *s1] to the box, along axes that are not cyclic. */
static bool clip_to_box(const ExactTexel *texel, Vec3 from, Vec3 along, double *s0, double *s1) {
    for (int k = 0; k < 3; k++) {
        if (texel->cyclic[k]) continue;
        double p = vec3_get(from, k), d = vec3_get(along, k), size = vec3_get(texel->extent, k), wall = WALL * size;
        if (d == 0) {
            if (p < -wall || p > size + wall) return false;
            continue;
        }
        double a = (-wall - p) / d, b = (size + wall - p) / d;
        *s0 = double_max(*s0, double_min(a, b));
        *s1 = double_min(*s1, double_max(a, b));
    }
    return *s0 < *s1;
}

/* The period along axis k that the path enters or is in at s; *end gets the s at which it leaves it. */
static double period_at(const ExactTexel *texel, Vec3 from, Vec3 along, int k, double s, double *end) {
    double size = vec3_get(texel->extent, k), p = vec3_get(from, k), d = vec3_get(along, k);
    double period = floor((p + s * d) / size);
    *end = d > 0 ? ((period + 1) * size - p) / d : d < 0 ? (period * size - p) / d : VTS_INFINITY;
    if (*end <= s) { /* on the wall, on the way out */
        period += d > 0 ? 1 : -1;
        *end += size / fabs(d);
    }
    return period * size;
}

bool exact_texel_shoot(const ExactTexel *texel, Vec3 from, Vec3 along, double s0, double s1, ExactTexelHit *hit) {
    if (!clip_to_box(texel, from, along, &s0, &s1)) return false;
    double s = s0;
    for (int i = 0; i < MOST_PERIODS && s < s1; i++) {
        double end = s1, at[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            double leaves;
            if (!texel->cyclic[k]) continue;
            at[k] = period_at(texel, from, along, k, s, &leaves);
            end = double_min(end, leaves);
        }
        if (shoot_period(texel, from, along, s, end, vec3(at[0], at[1], at[2]), hit)) return true;
        if (!(end > s)) return false;
        s = end;
    }
    return false;
}
