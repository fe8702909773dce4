/* How exact the mapping of skins is: inversion of prisms and hexahedra, folded ones too; what a chord, and a quadratic through the middle,
 * miss of a ray's curved way through texture space; rays aimed at edges and vertices, whose ways through the layer must be as long as
 * geometry says. `bench/bench_mapping [rays [boxes [ways]]]`. */
#include "../tests/unit/mapping_measures.h"
#include "base/stopwatch.h"
#include "render/skin_walk.h"

#include <stdio.h>

/* ---- leaks ---- */

/* Lengths that differ by more than this many heights count. */
static const double LEAK = 1e-6;

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

static void count_leak(Leaks *leaks, double got, double want, double height) {
    double error = (got - want) / height;
    leaks->rays++;
    leaks->sum += got, leaks->true_sum += want;
    leaks->worst = fmax(leaks->worst, fabs(error));
    leaks->missed += error < -LEAK;
    leaks->doubled += error > LEAK;
}

static void print_leaks(const char *what, const Leaks *l, double seconds) {
    printf("%-34s %llu rays in %.0f s with their checks: %llu leak, %llu count twice (more than 1e-6 heights), worst %.1e heights, sum of "
           "lengths %.10f of the true one, %.1f boxes and %.2f entries a ray\n",
           what, (unsigned long long)l->rays, seconds, (unsigned long long)l->missed, (unsigned long long)l->doubled, l->worst,
           l->sum / l->true_sum, (double)l->stretches / (double)l->rays, (double)l->entries / (double)l->rays);
}

/* A ball of triangles: each box a prism, and faces as half spaces know the truth. */
static void leaks_of_prisms(uint64_t rays) {
    static BallMesh ball;
    const Vec3 center = {.3, -.2, .1};
    const double radius = 1, height = .2;
    RandomStream r = {1};
    SkinScene s;
    Leaks leaks = {0};
    ball_make(&ball, 1);
    skin_scene_begin(&s);
    skin_scene_ball(&s, &ball, center, radius, height);
    if (skin_scene_compile(&s) != COMPILE_OK) return;
    double start = stopwatch_cpu();
    for (uint64_t i = 0; i < rays; i++) {
        Ray ray = aimed_ray(&ball, center, radius, height, i, &r);
        LayerParts parts = ball_layer_parts(&ball, center, radius, height, &ray, 0);
        count_leak(&leaks, way_length(&s.compiled.skins[0], &ray, &leaks), layer_length(&parts), radius * height);
    }
    print_leaks("prisms, aimed at edges:", &leaks, stopwatch_cpu() - start);
    skin_scene_end(&s);
}

/* Patches of an uneven grid over the unit square under one slanting height vector: together a parallelepiped. */
static const Vec3 SLANT = {.1, .25, -.05};

static Vec3 uneven_foot(double u, double v) {
    double inside = 64 * u * (1 - u) * v * (1 - v);
    return vec3(u + .02 * inside * sin(40 * u + 9 * v), 0, v + .02 * inside * cos(31 * v - 17 * u));
}
static Vec3 slanting_height(double u, double v) { return (void)u, (void)v, SLANT; }

static double slab_length(const Ray *ray) {
    double t0 = 0, t1 = VTS_INFINITY;
    double o[3] = {ray->origin.x - ray->origin.y * SLANT.x / SLANT.y, ray->origin.y / SLANT.y, ray->origin.z - ray->origin.y * SLANT.z / SLANT.y};
    double d[3] = {ray->direction.x - ray->direction.y * SLANT.x / SLANT.y, ray->direction.y / SLANT.y,
                   ray->direction.z - ray->direction.y * SLANT.z / SLANT.y};
    for (int k = 0; k < 3; k++) {
        double a = -o[k] / d[k], b = (1 - o[k]) / d[k];
        t0 = fmax(t0, fmin(a, b)), t1 = fmin(t1, fmax(a, b));
    }
    return fmax(0, t1 - t0);
}

static void leaks_of_hexahedra(uint64_t rays) {
    enum { N = 6 };
    RandomStream r = {2};
    SkinScene s;
    Leaks leaks = {0};
    skin_scene_begin(&s);
    skin_scene_grid(&s, N, N, uneven_foot, slanting_height);
    if (skin_scene_compile(&s) != COMPILE_OK) return;
    double start = stopwatch_cpu();
    for (uint64_t i = 0; i < rays; i++) {
        int a = 1 + (int)between(&r, 0, N - 1), b = 1 + (int)between(&r, 0, N - 1);
        Vec3 p = uneven_foot((double)a / N, (double)b / N), q = uneven_foot((double)(a + 1) / N, (double)b / N), d = spread_direction(&r);
        Vec3 on = i % 4 == 0 ? p : vec3_lerp(p, q, random_next_unit(&r));
        if (i % 4 == 2) d = vec3_normalize(vec3_madd(vec3_scale(vec3_sub(q, p), between(&r, -6, 6)), SLANT, between(&r, -1, 1)));
        if (i % 4 == 3) d = vec3_normalize(vec3(d.x, .02 * d.y, d.z));
        Ray ray = {vec3_madd(vec3_madd(on, SLANT, random_next_unit(&r)), d, i % 8 == 5 ? 0 : -3), d};
        count_leak(&leaks, way_length(&s.compiled.skins[0], &ray, &leaks), slab_length(&ray), SLANT.y);
    }
    print_leaks("hexahedra, aimed at edges:", &leaks, stopwatch_cpu() - start);
    skin_scene_end(&s);
}

/* ---- places and ways ---- */

static double percent(uint64_t part, uint64_t whole) { return 100 * (double)part / (double)whole; }

static void places(bool triangle, uint64_t boxes) {
    static const double kinds[][2] = {{.1, .3}, {.5, .3}, {.5, 1}, {1, 1}, {1.5, 2}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++) {
        double start = stopwatch_cpu();
        PlaceCounts c = measure_places(triangle, kinds[i][0], kinds[i][1], boxes, 1 + i);
        printf("%s, spread %.1f, height %.1f: %llu boxes, %.1f %% folded, %.2f %% of points in several places; missed %llu, and on folds (|det J| "
               "< 1e-4) %llu; Newton's method alone: %.2f steps, %.2f %% fail, %.2f %% wrong, %llu of either in unfolded boxes, %llu with what helps it; %.1f s\n",
               triangle ? "prisms" : "hexahedra", kinds[i][0], kinds[i][1], (unsigned long long)c.boxes, percent(c.folded, c.boxes),
               percent(c.several, c.boxes), (unsigned long long)c.missed, (unsigned long long)c.missed_on_folds, c.newton_steps,
               percent(c.newton_fails, c.boxes), percent(c.newton_wrong, c.boxes), (unsigned long long)c.wrong_unfolded,
               (unsigned long long)c.lost_unfolded, stopwatch_cpu() - start);
    }
}

static void ways(size_t prisms) {
    static const double kinds[][2] = {{.1, .3}, {.3, .3}, {.5, .5}, {.5, 1}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++) {
        WayErrors e = measure_ways(prisms, kinds[i][0], kinds[i][1], 11 + i);
        printf("spread %.1f, height %.1f, %zu ways, off by voxels of 128^3 (median / 95 %%):", kinds[i][0], kinds[i][1], e.ways);
        for (int k = 0; k < MEASURE_WAYS; k++) printf("%s %s %.3f / %.3f", k ? "," : "", measure_way_names[k], e.median[k], e.percentile_95[k]);
        printf("\n");
    }
}

int main(int argc, char **argv) {
    uint64_t rays = argc > 1 ? strtoull(argv[1], NULL, 10) : 1000000, boxes = argc > 2 ? strtoull(argv[2], NULL, 10) : 1000000;
    size_t prisms = argc > 3 ? strtoull(argv[3], NULL, 10) : 2000;
    if (rays >= 2) leaks_of_prisms(rays / 2), leaks_of_hexahedra(rays / 2);
    if (boxes >= 500) places(true, boxes / 5), places(false, boxes / 500);
    if (prisms) ways(prisms);
    return 0;
}
