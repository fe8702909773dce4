/* bench_functions SCENE POINTS: points per second of the function of the first object's pigment in the scene, on one
 * processor, through the batch evaluator: the plane z = 0 over the unit square, as POV-Ray's image_map { function … } samples
 * it. Prints seconds and the sum of the values. */
#include "base/stopwatch.h"
#include "bench_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 4096 };

static const Tape *function_of(const Scene *scene) {
    if (!scene->object_count || !scene->objects[0]->texture) return NULL;
    return scene->objects[0]->texture->pigment->function;
}

static double measure(const Tape *tape, size_t side, double *sum) {
    static double x[CHUNK], y[CHUNK], z[CHUNK], value[CHUNK];
    double start = stopwatch_cpu();
    *sum = 0;
    for (size_t row = 0; row < side; row++)
        for (size_t begin = 0; begin < side; begin += CHUNK) {
            size_t count = side - begin < CHUNK ? side - begin : CHUNK;
            for (size_t k = 0; k < count; k++) {
                x[k] = (double)(begin + k) / (double)side;
                y[k] = (double)row / (double)side;
            }
            tape_eval_batch(tape, count, (const double *const[]){x, y, z}, (double *const[]){value});
            for (size_t k = 0; k < count; k++) *sum += value[k];
        }
    return stopwatch_cpu() - start;
}

int main(int argc, char **argv) {
    if (argc != 4) return fprintf(stderr, "usage: bench_functions SCENE SIDE STDLIB\n"), 2;
    BenchScene bench;
    const Scene *scene = bench_scene_load(&bench, argv[1], argv[3], 4, 4);
    const Tape *tape = scene ? function_of(scene) : NULL;
    if (!tape) return fprintf(stderr, "bench_functions: no function in %s\n", argv[1]), 1;
    size_t side = (size_t)strtoul(argv[2], NULL, 10);
    double sum, best = 1e300;
    for (int run = 0; run < 3; run++) {
        double seconds = measure(tape, side, &sum);
        best = seconds < best ? seconds : best;
    }
    printf("%.6f %.9g\n", best, sum / (double)(side * side));
    return 0;
}
