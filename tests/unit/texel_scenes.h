/* Reference content for the tests of voxels: meshes, and what parallel light sees of them exactly. */
#ifndef VTS_TESTS_TEXEL_SCENES_H
#define VTS_TESTS_TEXEL_SCENES_H

#include "base/random.h"
#include "texel/opacity.h"

#include <stdlib.h>
#include <string.h>

typedef struct TestMesh {
    Vec3f *vertices;
    uint32_t (*triangles)[3];
    bool *solid;
    size_t vertex_count, triangle_count, vertex_room, triangle_room;
} TestMesh;

static inline uint32_t scene_vertex(TestMesh *m, Vec3 v) {
    if (m->vertex_count == m->vertex_room) {
        m->vertex_room = 2 * m->vertex_room + 64;
        m->vertices = realloc(m->vertices, m->vertex_room * sizeof *m->vertices);
    }
    m->vertices[m->vertex_count] = vec3f_from(v);
    return (uint32_t)m->vertex_count++;
}

static inline void scene_triangle(TestMesh *m, uint32_t a, uint32_t b, uint32_t c, bool solid) {
    if (m->triangle_count == m->triangle_room) {
        m->triangle_room = 2 * m->triangle_room + 64;
        m->triangles = realloc(m->triangles, m->triangle_room * sizeof *m->triangles);
        m->solid = realloc(m->solid, m->triangle_room * sizeof *m->solid);
    }
    m->triangles[m->triangle_count][0] = a;
    m->triangles[m->triangle_count][1] = b;
    m->triangles[m->triangle_count][2] = c;
    m->solid[m->triangle_count++] = solid;
}

static inline void scene_quad(TestMesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool solid) {
    scene_triangle(m, a, b, c, solid);
    scene_triangle(m, a, c, d, solid);
}

static inline void scene_free(TestMesh *m) {
    free(m->vertices);
    free(m->triangles);
    free(m->solid);
    *m = (TestMesh){0};
}

static inline TexelMesh scene_view(const TestMesh *m) {
    return (TexelMesh){m->vertices, (const uint32_t(*)[3])m->triangles, m->vertex_count, m->triangle_count,
                       m->solid, NULL};
}

static inline Vec3 scene_direction(RandomStream *r) {
    double z = 2 * random_next_unit(r) - 1, phi = 2 * VTS_PI * random_next_unit(r), s = sqrt(1 - z * z);
    return vec3(s * cos(phi), s * sin(phi), z);
}

/* Drawn one after the other: the order in which arguments are evaluated is the compiler's. */
static inline Vec3 scene_point(RandomStream *r, double margin) {
    double x = random_next_unit(r), y = random_next_unit(r), z = random_next_unit(r), w = 1 - 2 * margin;
    return vec3(margin + w * x, margin + w * y, margin + w * z);
}

/* n directions spread over the sphere. */
static inline Vec3 scene_spread_direction(int i, int n) {
    double z = 1 - (2 * i + 1.0) / n, phi = i * VTS_PI * (3 - sqrt(5.0)), s = sqrt(1 - z * z);
    return vec3(s * cos(phi), s * sin(phi), z);
}

/* A hexagon with normal n. */
static inline void scene_leaf(TestMesh *m, Vec3 c, Vec3 n, double radius) {
    Vec3 s, t;
    uint32_t rim[6];
    vec3_frame(n, &s, &t);
    for (int i = 0; i < 6; i++)
        rim[i] = scene_vertex(
            m, vec3_madd(vec3_madd(c, s, radius * cos(i * VTS_PI / 3)), t, radius * sin(i * VTS_PI / 3)));
    for (int i = 1; i < 5; i++) scene_triangle(m, rim[0], rim[i], rim[i + 1], false);
}

static inline TestMesh scene_leaves(int count, double radius, uint64_t seed) {
    TestMesh m = {0};
    RandomStream r = {seed};
    for (int i = 0; i < count; i++) {
        Vec3 c = scene_point(&r, .1);
        scene_leaf(&m, c, scene_direction(&r), radius);
    }
    return m;
}

/* Curved blades with a V profile: open sheets, thinner than a voxel. */
static inline TestMesh scene_grass(int count, double height, double width, uint64_t seed) {
    enum { STEPS = 8 };
    TestMesh m = {0};
    RandomStream r = {seed};
    for (int b = 0; b < count; b++) {
        Vec3 root = scene_point(&r, .3);
        root.y = 0.01;
        double phi = 2 * VTS_PI * random_next_unit(&r), bend = (.1 + .3 * random_next_unit(&r)) * height;
        double tall = (.6 + .4 * random_next_unit(&r)) * height;
        Vec3 out = vec3(cos(phi), 0, sin(phi)), side = vec3(-sin(phi), 0, cos(phi));
        uint32_t last[3] = {0};
        for (int i = 0; i <= STEPS; i++) {
            double t = (double)i / STEPS, w = width * (1 - t);
            Vec3 mid = vec3_madd(vec3_add(root, vec3(0, tall * t, 0)), out, bend * t * t),
                 fold = vec3_scale(out, .5 * w);
            uint32_t now[3] = {scene_vertex(&m, vec3_add(vec3_madd(mid, side, -w), fold)),
                               scene_vertex(&m, mid),
                               scene_vertex(&m, vec3_add(vec3_madd(mid, side, w), fold))};
            if (i) {
                scene_quad(&m, last[0], last[1], now[1], now[0], false);
                scene_quad(&m, last[1], last[2], now[2], now[1], false);
            }
            memcpy(last, now, sizeof last);
        }
    }
    return m;
}

static inline TestMesh scene_sphere(Vec3 c, double radius, int steps) {
    TestMesh m = {0};
    for (int i = 0; i <= steps; i++)
        for (int j = 0; j < 2 * steps; j++) {
            double th = VTS_PI * i / steps, ph = VTS_PI * j / steps;
            scene_vertex(&m, vec3_madd(c, vec3(sin(th) * cos(ph), cos(th), sin(th) * sin(ph)), radius));
        }
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < 2 * steps; j++) {
            uint32_t n = (uint32_t)(2 * steps), a = (uint32_t)i * n + (uint32_t)j,
                     b = (uint32_t)i * n + (uint32_t)(j + 1) % n;
            scene_quad(&m, a, b, b + n, a + n, true);
        }
    return m;
}

/* A closed cylinder from a to b. */
static inline TestMesh scene_cylinder(Vec3 a, Vec3 b, double radius, int sides) {
    TestMesh m = {0};
    Vec3 s, t;
    vec3_frame(vec3_normalize(vec3_sub(b, a)), &s, &t);
    uint32_t ends[2] = {scene_vertex(&m, a), scene_vertex(&m, b)}, n = (uint32_t)sides;
    for (uint32_t i = 0; i < n; i++) {
        double phi = 2 * VTS_PI * i / sides;
        Vec3 out = vec3_madd(vec3_scale(s, radius * cos(phi)), t, radius * sin(phi));
        scene_vertex(&m, vec3_add(a, out));
        scene_vertex(&m, vec3_add(b, out));
    }
    for (uint32_t i = 0; i < n; i++) {
        uint32_t p = 2 + 2 * i, q = 2 + 2 * ((i + 1) % n);
        scene_quad(&m, p, q, q + 1, p + 1, true);
        scene_triangle(&m, ends[0], q, p, true);
        scene_triangle(&m, ends[1], p + 1, q + 1, true);
    }
    return m;
}

static inline TestMesh scene_box(Vec3 lo, Vec3 hi) {
    static const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    TestMesh m = {0};
    for (int i = 0; i < 8; i++)
        scene_vertex(&m, vec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z));
    for (int f = 0; f < 6; f++) scene_quad(&m, faces[f][0], faces[f][1], faces[f][2], faces[f][3], true);
    return m;
}

/* A large square sheet with normal n through the middle. */
static inline TestMesh scene_sheet(Vec3 n, double half) {
    TestMesh m = {0};
    Vec3 s, t, c = vec3(.5, .5, .5);
    vec3_frame(n, &s, &t);
    uint32_t v[4];
    for (int i = 0; i < 4; i++)
        v[i] = scene_vertex(
            &m, vec3_madd(vec3_madd(c, s, i == 1 || i == 2 ? half : -half), t, i >= 2 ? half : -half));
    scene_quad(&m, v[0], v[1], v[2], v[3], false);
    return m;
}

/* The surface's area seen along d, every sheet counted once, walls of solids half. */
static inline double scene_projected_area(const TestMesh *m, Vec3 d) {
    double sum = 0;
    for (size_t t = 0; t < m->triangle_count; t++) {
        Vec3 a = vec3_from_f(m->vertices[m->triangles[t][0]]),
             b = vec3_from_f(m->vertices[m->triangles[t][1]]);
        Vec3 c = vec3_from_f(m->vertices[m->triangles[t][2]]);
        sum += fabs(vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), d)) * (m->solid[t] ? .25 : .5);
    }
    return sum;
}

/* A picture of parallel rays along d: side² samples over a square of `width` around the middle of the unit cube. */
typedef struct ScenePicture {
    Vec3 d, s, t;
    double width;
    int side;
    uint8_t *hit;
} ScenePicture;

static inline void scene_picture_triangle(ScenePicture *p, const Vec3 v[3]) {
    double x[3], y[3], lo = 1e9, hi = -1e9, k = p->side / p->width;
    for (int i = 0; i < 3; i++) {
        Vec3 q = vec3_sub(v[i], vec3(.5, .5, .5));
        x[i] = (vec3_dot(q, p->s) + p->width / 2) * k - .5;
        y[i] = (vec3_dot(q, p->t) + p->width / 2) * k - .5;
        lo = fmin(lo, y[i]);
        hi = fmax(hi, y[i]);
    }
    for (int row = (int)fmax(0, ceil(lo)); row < p->side && row < hi; row++) {
        double a = 1e9, b = -1e9;
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3;
            if ((y[i] <= row) == (y[j] <= row)) continue;
            double at = x[i] + (row - y[i]) / (y[j] - y[i]) * (x[j] - x[i]);
            a = fmin(a, at);
            b = fmax(b, at);
        }
        for (int column = (int)fmax(0, ceil(a)); column < p->side && column < b; column++)
            p->hit[row * p->side + column] = 1;
    }
}

static inline ScenePicture scene_picture(const TestMesh *m, Vec3 d, double width, int side) {
    ScenePicture p = {.d = d, .width = width, .side = side, .hit = calloc((size_t)side * (size_t)side, 1)};
    vec3_frame(d, &p.s, &p.t);
    for (size_t t = 0; t < m->triangle_count; t++) {
        Vec3 v[3];
        for (int i = 0; i < 3; i++) v[i] = vec3_from_f(m->vertices[m->triangles[t][i]]);
        scene_picture_triangle(&p, v);
    }
    return p;
}

/* Transmittance of the layer's unit cube along d through the point `at` of the picture's plane, by steps of `step`. */
static inline double scene_march(const VoxelLayer *layer, float lod, OpacityModel model, float h, Vec3 at,
                                 Vec3 d, double step) {
    double t0 = -1e9, t1 = 1e9, through = 1;
    Ray ray = {at, d};
    if (!box3_clip_ray((Box3){{0, 0, 0}, {1, 1, 1}}, &ray, &t0, &t1)) return 1;
    Vec3f along = vec3f_scale(vec3f_from(d), (float)step);
    for (double t = t0 + step / 2; t < t1; t += step) {
        VoxelSample v;
        if (voxel_layer_sample_lod(layer, lod, vec3f_from(vec3_madd(at, d, t)), &v))
            through *= (double)opacity_transmittance(model, &v, h, along);
    }
    return through;
}

#endif
