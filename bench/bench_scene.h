/* A scene for a measurement, as the program reads it. */
#ifndef VTS_BENCH_SCENE_H
#define VTS_BENCH_SCENE_H

#include "eval/eval.h"

/* Everything that the scene lives in. It stays until the program ends. */
typedef struct BenchScene {
    Arena arenas[3];
    DiagList diags;
    SourceSet sources;
    Interner names;
    const Scene *scene;
} BenchScene;

/* Reads the scene at `path` for a picture of width × height, with includes of the folder `stdlib`; returns bench->scene, NULL if there is an error in it. */
const Scene *bench_scene_load(BenchScene *bench, const char *path, const char *stdlib, int width, int height);

#endif
