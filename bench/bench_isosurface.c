/* bench_isosurface SCENE STDLIB [STEP]: rays a second through the first object of the scene, an isosurface, on one processor: those of an
 * 800 × 600 picture, every STEP-th of each row and column, in tiles of 32 as the renderer has them. Prints seconds, rays, rays a
 * second, how many hit, and the sum of their distances. */
#include "base/stopwatch.h"
#include "bench_scene.h"
#include "shape/body.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 800, HEIGHT = 600, TILE = 32 };

typedef struct Count {
    double rays, hits, sum;
} Count;

static Ray ray_of(const Camera *camera, int x, int y) {
    double u = (x + 0.5) / WIDTH - 0.5, v = 0.5 - (y + 0.5) / HEIGHT;
    Vec3 way = vec3_madd(vec3_madd(camera->direction, camera->right, u), camera->up, v);
    return (Ray){camera->location, vec3_normalize(way)};
}

static void tile(const Scene *scene, const Body *body, int left, int top, int step, Count *count) {
    for (int y = top; y < top + TILE && y < HEIGHT; y += step)
        for (int x = left; x < left + TILE && x < WIDTH; x += step) {
            Ray ray = ray_of(&scene->camera, x, y);
            BodyHit hit = {.t = VTS_INFINITY};
            count->rays++;
            if (!body_meet(body, scene->objects[0], &ray, 0, VTS_INFINITY, &hit)) continue;
            count->hits++, count->sum += hit.t;
        }
}

int main(int argc, char **argv) {
    if (argc < 3) return fprintf(stderr, "usage: bench_isosurface SCENE STDLIB [STEP]\n"), 2;
    BenchScene bench;
    int step = argc > 3 ? atoi(argv[3]) : 4;
    const Scene *scene = bench_scene_load(&bench, argv[1], argv[2], WIDTH, HEIGHT);
    if (!scene || !scene->object_count || step < 1)
        return fprintf(stderr, "bench_isosurface: no object in %s\n", argv[1]), 1;
    const Body *body = body_of(shape_tracer_create(&bench.arenas[0]), scene->objects[0]);
    Count count = {0, 0, 0};
    double start = stopwatch_cpu();
    for (int top = 0; top < HEIGHT; top += TILE)
        for (int left = 0; left < WIDTH; left += TILE) tile(scene, body, left, top, step, &count);
    double seconds = stopwatch_cpu() - start;
    printf("%.3f s, %.0f rays, %.0f rays/s, %.0f hits, distances %.12g\n", seconds, count.rays,
           count.rays / seconds, count.hits, count.sum);
    return 0;
}
