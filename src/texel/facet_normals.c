#include "texel/facet_normals.h"

#include <math.h>

/* Normals that are nearer to the triangle's own say nothing that the eye could tell. */
static const float FLAT_COSINE = 1 - 5e-7f;
static const float UNITS = 32767;
enum { NO_NORMAL = INT16_MIN };

bool facet_normals_of(const TexelMesh *mesh, size_t triangle, Vec3f normals[3]) {
    if (!mesh->normals) return false;
    const uint32_t *v = mesh->triangles[triangle];
    if (v[0] >= mesh->vertex_count || v[1] >= mesh->vertex_count || v[2] >= mesh->vertex_count) return false;
    Vec3f a = mesh->vertices[v[0]], own = vec3f_cross(vec3f_sub(mesh->vertices[v[1]], a), vec3f_sub(mesh->vertices[v[2]], a));
    float length = vec3f_length(own);
    bool flat = true;
    if (!(length > 0)) return false;
    for (int i = 0; i < 3; i++) {
        Vec3f n = mesh->normals[v[i]];
        if (!(vec3f_dot(n, n) > 0.5f)) return false;
        flat = flat && vec3f_dot(n, own) >= FLAT_COSINE * length;
        normals[i] = n;
    }
    return !flat;
}

static float sign_of(float x) { return x < 0 ? -1.0f : 1.0f; }

static void pack_one(Vec3f n, int16_t out[2]) {
    float sum = fabsf(n.x) + fabsf(n.y) + fabsf(n.z);
    out[0] = out[1] = NO_NORMAL;
    if (!(sum > 0) || !isfinite(sum)) return;
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) { /* the lower half lies outside of the square's diamond */
        float folded = (1 - fabsf(y)) * sign_of(x);
        y = (1 - fabsf(x)) * sign_of(y);
        x = folded;
    }
    out[0] = (int16_t)lrintf(x * UNITS);
    out[1] = (int16_t)lrintf(y * UNITS);
}

static Vec3f unpack_one(const int16_t in[2]) {
    if (in[0] == NO_NORMAL) return vec3f(0, 0, 0);
    float x = (float)in[0] / UNITS, y = (float)in[1] / UNITS, z = 1 - fabsf(x) - fabsf(y), below = float_max(-z, 0);
    return vec3f_normalize(vec3f(x - sign_of(x) * below, y - sign_of(y) * below, z));
}

FacetNormals facet_normals_pack(const Vec3f normals[3]) {
    FacetNormals out;
    for (int i = 0; i < 3; i++) pack_one(normals[i], out.corner[i]);
    return out;
}

Vec3f facet_normals_at(const FacetNormals *normals, float s, float t) {
    Vec3f a = unpack_one(normals->corner[0]), b = unpack_one(normals->corner[1]), c = unpack_one(normals->corner[2]);
    return vec3f_madd(vec3f_madd(vec3f_scale(a, 1 - s - t), b, s), c, t);
}
