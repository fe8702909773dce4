/* The figures of voxels: what they show and hide against the geometry, their memory, time to build and to read them.
 *
 *   bench_texel                        all of it, about a minute
 *   bench_texel CONTENT RESOLUTION [THREADS]   builds one: leaves, foliage, grass, tree, sheet, ball …
 *
 * Seconds are of the processor, so that other programs disturb them less. */
#include "base/stopwatch.h"
#include "texel/texel_sky.h"
#include "texel_measures.h"

#include <stdio.h>

/* ---- contents ---- */

/* A trunk, three ranks of branches and leaves at their ends: 4 closed cylinders deep, as an L-system makes them. */
static void add_branch(TestMesh *m, Vec3 from, Vec3 along, double length, int rank, RandomStream *r) {
    Vec3 s, t, to = vec3_madd(from, along, length);
    TestMesh stem = scene_cylinder(from, to, length * 0.035, 6);
    uint32_t first = (uint32_t)m->vertex_count;
    for (size_t i = 0; i < stem.vertex_count; i++) scene_vertex(m, vec3_from_f(stem.vertices[i]));
    for (size_t i = 0; i < stem.triangle_count; i++)
        scene_triangle(m, first + stem.triangles[i][0], first + stem.triangles[i][1],
                       first + stem.triangles[i][2], true);
    scene_free(&stem);
    vec3_frame(along, &s, &t);
    for (int i = 0; rank < 4 && i < 5; i++) {
        double turn = 2.4 * i + random_next_unit(r), at = 0.45 + 0.55 * i / 4;
        Vec3 out = vec3_madd(vec3_scale(s, cos(turn)), t, sin(turn)),
             way = vec3_normalize(vec3_madd(vec3_scale(along, 0.8), out, 0.75));
        add_branch(m, vec3_madd(from, along, at * length), way, length * 0.55, rank + 1, r);
    }
    for (int i = 0; rank == 4 && i < 4; i++)
        scene_leaf(m, vec3_madd(to, scene_direction(r), 0.02), scene_direction(r), 0.012);
}

static TestMesh tree(void) {
    TestMesh m = {0};
    RandomStream r = {4};
    add_branch(&m, vec3(.5, .01, .5), vec3(0, 1, 0), .42, 0, &r);
    return m;
}

/* N98's foliage has 6,336 leaves in 256³; how large they are it does not say. */
static TestMesh foliage(void) { return scene_leaves(6336, .02, 1); }
static TestMesh leaves(void) { return scene_leaves(600, .035, 1); }
static TestMesh few_leaves(void) { return scene_leaves(60, .05, 2); }
static TestMesh grass(void) { return scene_grass(300, .6, .006, 4); }
static TestMesh lawn(void) { return scene_grass(2400, .6, .006, 4); }
static TestMesh face_on(void) { return scene_sheet(vec3(0, 0, 1), .45); }
static TestMesh tilted(void) { return scene_sheet(vec3_normalize(vec3(.3, .2, .93)), .4); }
static TestMesh diagonal(void) { return scene_sheet(vec3_normalize(vec3(1, 1, 1)), .4); }
static TestMesh ball(void) { return scene_sphere(vec3(.5, .5, .5), .4, 48); }
static TestMesh box(void) { return scene_box(vec3(.23, .31, .17), vec3(.71, .77, .83)); }
static TestMesh stem(void) { return scene_cylinder(vec3(.2, .1, .3), vec3(.7, .9, .6), .04, 24); }
static TestMesh twig(void) { return scene_cylinder(vec3(.2, .1, .3), vec3(.7, .9, .6), .004, 12); }

static const struct {
    const char *name;
    TestMesh (*make)(void);
    double walls; /* at the finest level of 64³ */
} contents[] = {{"leaves", leaves, .5}, {"60 leaves", few_leaves, .5},
                {"grass", grass, .5},   {"sheet", face_on, .5},
                {"tilted", tilted, .5}, {"diagonal", diagonal, .5},
                {"ball", ball, 1},      {"box", box, 1},
                {"stem", stem, 1},      {"twig", twig, .5},
                {"tree", tree, 0},      {"foliage", foliage, .5},
                {"lawn", lawn, .5}};

/* ---- measures ---- */

static VoxelLayer *build(const TestMesh *mesh, int resolution, Pool *pool, TexelBuildStats *stats,
                         double *cpu) {
    TexelMesh view = scene_view(mesh);
    TexelBuildOptions options = {.resolution = resolution,
                                 .extent = {1, 1, 1},
                                 .cyclic = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z,
                                 .pool = pool};
    double start = stopwatch_cpu();
    VoxelLayer *layer = voxel_layer_build(&view, &options, stats);
    if (cpu) *cpu = stopwatch_cpu() - start;
    if (!layer) exit(1);
    return layer;
}

static void measure_areas(void) {
    printf("\nprojected area in 64 directions, relative to its mean: greatest error, and rms, by level from 128³\n");
    for (size_t i = 0; i < VTS_ARRAY_COUNT(contents) - 3; i++) {
        TestMesh mesh = contents[i].make();
        VoxelLayer *layer = build(&mesh, 128, NULL, NULL, NULL);
        printf("%-10s", contents[i].name);
        for (int level = 0; level < 8; level++) {
            AreaError e = measure_area_error(layer, level, &mesh, contents[i].walls);
            printf("  %4.1f, %4.1f %%", 100 * e.worst_shape, 100 * e.shape);
        }
        printf("\n");
        voxel_layer_destroy(layer);
        scene_free(&mesh);
    }
}

static void measure_opacity(void) {
    printf("\nopacity of pixels of 2 × 2 voxels, random directions, 64³: rms error at 1, 2, 4 and 8 times "
           "coarser voxels\n");
    printf("%-10s %-34s %-27s %-27s %-27s %s\n", "", "correlated (mean error at 8)", "exponential",
           "crossing", "mean", "true");
    for (size_t i = 0; i < VTS_ARRAY_COUNT(contents) - 3; i++) {
        TestMesh mesh = contents[i].make();
        VoxelLayer *layer = build(&mesh, 64, NULL, NULL, NULL);
        Coverage c[4];
        for (int level = 0; level < 4; level++) c[level] = measure_coverage(layer, &mesh, level);
        printf("%-10s", contents[i].name);
        static const int order[MEASURE_MODELS] = {2, 1, 3, 0};
        for (int m = 0; m < MEASURE_MODELS; m++) {
            for (int level = 0; level < 4; level++) printf("  %.3f", c[level].quad[order[m]]);
            if (m == 0) printf(" %+.3f", c[3].mean[2] - c[3].truth);
        }
        printf("  %.3f\n", c[3].truth);
        voxel_layer_destroy(layer);
        scene_free(&mesh);
    }
}

static size_t count_voxels(const TexelBuildStats *s) {
    size_t voxels = 0;
    for (int i = 0; i < s->levels; i++) voxels += s->voxels[i];
    return voxels;
}

static void measure_build(const char *name, TestMesh mesh, int resolution, Pool *pool, const char *paper) {
    TexelBuildStats s;
    double cpu;
    VoxelLayer *layer = build(&mesh, resolution, pool, &s, &cpu);
    size_t voxels = count_voxels(&s);
    printf("%-9s %4d³ %8zu triangles: %6.2f s cpu, %7.2f MB, %9zu voxels (%5.2f %% of the finest), %4.1f "
           "bytes each, peak %4.0f MB  %s\n",
           name, resolution, mesh.triangle_count, cpu, (double)s.bytes / 1e6, voxels,
           100 * (double)s.voxels[0] / pow(resolution, 3), (double)s.bytes / (double)voxels,
           (double)peak_resident_bytes() / 1e6, paper);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

static void measure_builds(Pool *pool) {
    printf("\nbuilding, %d threads (peak: of the process so far); Neyret 1998\n", pool_threads(pool));
    measure_build("tree", tree(), 128, pool, "1.3 MB (128³)");
    measure_build("grass", grass(), 128, pool, "5 MB (128³)");
    measure_build("lawn", lawn(), 128, pool, "5 MB (128³)");
    measure_build("foliage", foliage(), 256, pool, "18 MB (256³)");
    measure_build("ball", ball(), 256, pool, "6.5 MB (256³, a car)");
    measure_build("tree", tree(), 512, pool, "");
    measure_build("sheet", tilted(), 1024, pool, "");
    measure_build("foliage", foliage(), 512, pool, "");
}

static void measure_sky(Pool *pool) {
    TestMesh mesh = grass();
    VoxelLayer *layer = build(&mesh, 128, pool, NULL, NULL);
    const VoxelLayer *layers[] = {layer};
    double start = stopwatch_cpu();
    TexelSky *sky = texel_sky_build(layers, 1,
                                    &(TexelSkyOptions){.opacity = OPACITY_CORRELATED,
                                                       .repeated = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z,
                                                       .pool = pool});
    if (!sky) exit(1);
    printf("\nsky visibility of grass 128³: %.2f s cpu, %.0f kB\n", stopwatch_cpu() - start,
           (double)texel_sky_bytes(sky) / 1e3);
    texel_sky_destroy(sky);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

/* ---- reading ---- */

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
    for (size_t i = 0; i < VTS_ARRAY_COUNT(points); i++) points[i] = vec3f_from(scene_point(&r, 0));
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

static void measure_reading(const VoxelLayer *layer) {
    int size[3];
    voxel_layer_size(layer, 0, size);
    for (int level = 0; level < int_min(4, voxel_layer_levels(layer)); level++) {
        float h = (float)(1 << level) / (float)size[0];
        read_coherent(layer, (float)level, h / 2);
        read_random(layer, (float)level);
        march_rays(layer, (float)level, h);
    }
    read_coherent(layer, 0.5f, 1 / (float)size[0]);
    read_random(layer, 0.5f);
}

static void measure_one(const char *name, int resolution, Pool *pool) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(contents); i++) {
        if (strcmp(contents[i].name, name) != 0) continue;
        measure_build(name, contents[i].make(), resolution, pool, "");
        return;
    }
    fprintf(stderr, "bench_texel: no content '%s'\n", name);
}

int main(int argc, char **argv) {
    Pool *pool = pool_create(argc > 3 ? atoi(argv[3]) : 2);
    if (argc > 1) {
        measure_one(argv[1], argc > 2 ? atoi(argv[2]) : 128, pool);
    } else {
        measure_areas();
        measure_opacity();
        measure_builds(pool);
        measure_sky(pool);
        TestMesh mesh = foliage();
        VoxelLayer *layer = build(&mesh, 256, pool, NULL, NULL);
        printf("\nreading foliage 256³\n");
        measure_reading(layer);
        voxel_layer_destroy(layer);
        scene_free(&mesh);
    }
    pool_destroy(pool);
    return 0;
}
