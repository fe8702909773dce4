/* How exact the mapping of skins is: inversion of prisms and hexahedra, folded ones too; what a chord, and a quadratic through the middle,
 * miss of a ray's curved way through texture space; rays aimed at edges and vertices, whose ways through the layer must be as long as
 * geometry says. `bench/bench_mapping [rays]`. */
#include "../tests/unit/skin_scenes.h"
#include "base/stopwatch.h"
#include "render/skin_fold.h"
#include "render/skin_walk.h"

#include <stdio.h>

/* ---- leaks ---- */

typedef struct Leaks {
    uint64_t rays, missed, doubled, stretches, entries;
    double sum, true_sum, worst;
} Leaks;

/* The sum of the stretches of the ray. */
static double way_length(const CompiledSkin *skin, const Ray *ray, Leaks *leaks) {
    SkinStretch s;
    double sum = 0;
    bool more = skin_stretch_first(skin, ray, 0, VTS_INFINITY, &s);
    while (more) {
        leaks->entries++;
        for (;;) {
            sum += s.t1 - s.t0;
            leaks->stretches++;
            if (!skin_stretch_goes_on(skin, &s)) break;
            s = skin_stretch_next(skin, ray, &s, VTS_INFINITY);
        }
        more = skin_stretch_again(skin, ray, &s, VTS_INFINITY, &s);
    }
    return sum;
}

/* Through a vertex, a point of an edge, along a wall, or along an edge's plane of symmetry; always from afar or from within. */
static Ray aimed_ray(const BallMesh *ball, Vec3 center, double radius, double height, uint64_t i, RandomStream *r) {
    const uint32_t *f = ball->triangles[(size_t)between(r, 0, (double)ball->triangle_count)];
    Vec3 a = ball->vertices[f[0]], b = ball->vertices[f[1]], d = spread_direction(r);
    Vec3 on = i % 4 == 0 ? a : vec3_lerp(a, b, random_next_unit(r));
    if (i % 4 == 2) d = vec3_normalize(vec3_madd(vec3_scale(vec3_sub(b, a), between(r, -1, 1)), on, between(r, -.5, .5)));
    if (i % 4 == 3) d = vec3_normalize(vec3_madd(d, on, -vec3_dot(d, on))); /* grazing */
    Vec3 target = vec3_madd(center, on, radius * (1 + height * random_next_unit(r)));
    return (Ray){vec3_madd(target, d, i % 8 == 5 ? 0 : -3 * radius), d};
}

static void measure_leaks(uint64_t rays) {
    static BallMesh ball;
    const Vec3 center = {.3, -.2, .1};
    const double radius = 1, height = .2;
    RandomStream r = {1};
    SkinScene s;
    Leaks leaks = {0};
    ball_make(&ball, 2);
    skin_scene_begin(&s);
    skin_scene_ball(&s, &ball, center, radius, height);
    if (skin_scene_compile(&s) != COMPILE_OK) return;
    const CompiledSkin *skin = &s.compiled.skins[0];
    double start = stopwatch_cpu();
    for (uint64_t i = 0; i < rays; i++) {
        Ray ray = aimed_ray(&ball, center, radius, height, i, &r);
        LayerParts parts = ball_layer_parts(&ball, center, radius, height, &ray, 0);
        double want = layer_length(&parts), got = way_length(skin, &ray, &leaks), error = (got - want) / (radius * height);
        leaks.rays++;
        leaks.sum += got, leaks.true_sum += want;
        leaks.worst = fmax(leaks.worst, fabs(error));
        leaks.missed += error < -1e-6;
        leaks.doubled += error > 1e-6;
    }
    printf("edge-aimed rays: %llu in %.0f s with their checks; leaks %llu, counted twice %llu (by more than 1e-6 heights); worst %.1e heights; sum of lengths %.9f of the true one; "
           "%.1f cells and %.2f entries a ray\n",
           (unsigned long long)leaks.rays, stopwatch_cpu() - start, (unsigned long long)leaks.missed, (unsigned long long)leaks.doubled, leaks.worst,
           leaks.sum / leaks.true_sum, (double)leaks.stretches / (double)rays, (double)leaks.entries / (double)rays);
    skin_scene_end(&s);
}

int main(int argc, char **argv) {
    measure_leaks(argc > 1 ? strtoull(argv[1], NULL, 10) : 1000000);
    return 0;
}
