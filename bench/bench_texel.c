/* Time to build and to read voxels: a cube of random leaves. bench_texel [resolution [leaves [threads]]] */
#include "base/random.h"
#include "base/stopwatch.h"
#include "texel/opacity.h"

#include <stdio.h>
#include <stdlib.h>

enum { LEAF_VERTICES = 6, LEAF_TRIANGLES = 4 };

static Vec3 random_direction(RandomStream *r) {
    double z = 2 * random_next_unit(r) - 1, phi = 2 * VTS_PI * random_next_unit(r), s = sqrt(1 - z * z);
    return vec3(s * cos(phi), s * sin(phi), z);
}

static Vec3 random_point(RandomStream *r) {
    double x = random_next_unit(r), y = random_next_unit(r), z = random_next_unit(r);
    return vec3(x, y, z);
}

/* `count` hexagons of radius 0.02 … 0.035; memory is the process's. */
static TexelMesh random_leaves(int count) {
    Vec3f *vertices = calloc((size_t)count * LEAF_VERTICES, sizeof *vertices);
    uint32_t(*triangles)[3] = calloc((size_t)count * LEAF_TRIANGLES, sizeof *triangles);
    RandomStream r = {1};
    if (!vertices || !triangles) exit(1);
    for (int leaf = 0; leaf < count; leaf++) {
        Vec3 s, t, middle = random_point(&r);
        double radius = 0.02 + 0.015 * random_next_unit(&r);
        vec3_frame(random_direction(&r), &s, &t);
        for (int i = 0; i < LEAF_VERTICES; i++) {
            double phi = i * VTS_PI / 3;
            Vec3 rim = vec3_madd(vec3_scale(s, radius * cos(phi)), t, radius * sin(phi));
            vertices[leaf * LEAF_VERTICES + i] = vec3f_from(vec3_add(middle, rim));
        }
        for (int i = 0; i < LEAF_TRIANGLES; i++) {
            uint32_t first = (uint32_t)(leaf * LEAF_VERTICES), *corner = triangles[leaf * LEAF_TRIANGLES + i];
            corner[0] = first;
            corner[1] = first + (uint32_t)i + 1;
            corner[2] = first + (uint32_t)i + 2;
        }
    }
    return (TexelMesh){vertices, (const uint32_t(*)[3])triangles, (size_t)count * LEAF_VERTICES,
                       (size_t)count * LEAF_TRIANGLES, NULL};
}

static void print_build(const TexelBuildStats *s, int threads) {
    size_t voxels = 0;
    for (int i = 0; i < s->levels; i++) voxels += s->voxels[i];
    printf("build %dx%dx%d, %d threads: %.3f s, %.1f MB, %zu voxels (%.1f %% of the finest level), %.1f "
           "bytes each, "
           "peak %.0f MB\n",
           s->size[0], s->size[1], s->size[2], threads, s->seconds, (double)s->bytes / 1e6, voxels,
           100 * (double)s->voxels[0] / s->size[0] / s->size[1] / s->size[2],
           (double)s->bytes / (double)voxels, (double)peak_resident_bytes() / 1e6);
}

/* Steps of half a voxel along parallel rays. */
static void read_coherent(const VoxelLayer *layer, float lod, float step) {
    size_t samples = 0, occupied = 0;
    float sum = 0;
    double start = stopwatch_cpu();
    for (int ray = 0; samples < 4000000; ray++) {
        Vec3f p = vec3f((float)(ray % 256) / 256, (float)(ray / 256 % 256) / 256, 0),
              d = vec3f(0.05f, 0.1f, 1);
        for (float t = 0; t < 1; t += step, samples++) {
            VoxelSample v;
            occupied += voxel_layer_sample_lod(layer, lod, vec3f_madd(p, d, t), &v);
            sum += v.density;
        }
    }
    double seconds = stopwatch_cpu() - start;
    printf("lod %.1f coherent: %.1f M samples/s, %.0f %% occupied [%g]\n", (double)lod,
           (double)samples / seconds / 1e6, 100 * (double)occupied / (double)samples, (double)sum);
}

static void read_random(const VoxelLayer *layer, float lod) {
    enum { SAMPLES = 2000000 };
    static Vec3f points[1 << 16];
    RandomStream r = {2};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(points); i++) points[i] = vec3f_from(random_point(&r));
    float sum = 0;
    double start = stopwatch_cpu();
    for (int i = 0; i < SAMPLES; i++) {
        VoxelSample v;
        voxel_layer_sample_lod(layer, lod, points[(size_t)i % VTS_ARRAY_COUNT(points)], &v);
        sum += v.density;
    }
    double seconds = stopwatch_cpu() - start;
    printf("lod %.1f random:   %.1f M samples/s [%g]\n", (double)lod, SAMPLES / seconds / 1e6, (double)sum);
}

/* Whole rays, as the renderer marches them: skip, sample, attenuate. */
static void march_rays(const VoxelLayer *layer, float lod, float h) {
    enum { RAYS = 40000 };
    size_t samples = 0;
    float opacity = 0;
    double start = stopwatch_cpu();
    for (int ray = 0; ray < RAYS; ray++) {
        Vec3f p = vec3f((float)(ray % 200) / 220, (float)(ray / 200 % 200) / 220, 0);
        Vec3f d = vec3f_normalize(vec3f(0.05f, 0.1f, 1)), step = vec3f_scale(d, h / 2);
        float through = 1;
        for (float t = 0; t < 0.99f && through > 1.0f / 512; t += h / 2) {
            t += voxel_layer_skip(layer, lod, vec3f_madd(p, d, t), d, 0.99f - t);
            VoxelSample v;
            samples++;
            if (voxel_layer_sample_lod(layer, lod, vec3f_madd(p, d, t), &v))
                through *= opacity_transmittance(OPACITY_CORRELATED, &v, h, step);
        }
        opacity += 1 - through;
    }
    double seconds = stopwatch_cpu() - start;
    printf("lod %.1f rays:     %.0f k rays/s, %.1f samples each, mean opacity %.3f\n", (double)lod,
           RAYS / seconds / 1e3, (double)samples / RAYS, (double)opacity / RAYS);
}

int main(int argc, char **argv) {
    int resolution = argc > 1 ? atoi(argv[1]) : 256, leaves = argc > 2 ? atoi(argv[2]) : 6336;
    int threads = argc > 3 ? atoi(argv[3]) : 2;
    TexelMesh mesh = random_leaves(leaves);
    Pool *pool = pool_create(threads);
    TexelBuildOptions options = {.resolution = resolution,
                                 .extent = {1, 1, 1},
                                 .cyclic = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z,
                                 .pool = pool};
    TexelBuildStats stats;
    VoxelLayer *layer = voxel_layer_build(&mesh, &options, &stats);
    pool_destroy(pool);
    if (!layer) return 1;
    print_build(&stats, threads);
    for (int level = 0; level < 4; level++) {
        float h = (float)(1 << level) / (float)stats.size[0];
        read_coherent(layer, (float)level, h / 2);
        read_random(layer, (float)level);
        march_rays(layer, (float)level, h);
    }
    read_coherent(layer, 0.5f, 1 / (float)stats.size[0]);
    read_random(layer, 0.5f);
    voxel_layer_destroy(layer);
    return 0;
}
