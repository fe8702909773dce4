#include "bench_scene.h"

#include "hooks.h"

const Scene *bench_scene_load(BenchScene *bench, const char *path, const char *stdlib, int width, int height) {
    Arena *arenas = bench->arenas;
    for (int k = 0; k < 3; k++) arena_init(&arenas[k], NULL, 0);
    EvalGeometry geometry = hooks_geometry(&arenas[0], NULL);
    EvalOptions options = {.stdlib_dir = stdlib,
                           .image_width = width,
                           .image_height = height,
                           .limits = eval_limits_default(),
                           .geometry = &geometry};
    source_set_init(&bench->sources, &arenas[0]);
    diag_init(&bench->diags, &arenas[0], &bench->sources);
    interner_init(&bench->names, &arenas[0]);
    bench->scene = NULL;
    EvalStatus status = eval_file(path, &options, &bench->sources, &bench->diags, &bench->names, &arenas[1], &arenas[2], &bench->scene);
    return status == EVAL_OK ? bench->scene : (bench->scene = NULL);
}
