/* What voxels are measured by: the areas that they show, and what they hide of parallel light, against the exact geometry. */
#ifndef VTS_TESTS_TEXEL_MEASURES_H
#define VTS_TESTS_TEXEL_MEASURES_H

#include "texel/voxel_layer.h"
#include "texel_scenes.h"

enum { MEASURE_DIRECTIONS = 64, MEASURE_BUNDLES = 6, MEASURE_SUPERSAMPLES = 8, MEASURE_MODELS = 4 };

static const OpacityModel measure_models[MEASURE_MODELS] = {OPACITY_MEAN, OPACITY_EXPONENTIAL,
                                                            OPACITY_CORRELATED, OPACITY_CROSSING};

/* ---- areas ---- */

/* Area seen from each of the spread directions, and half the total area, over all voxels of a level. */
static inline double measure_area(const VoxelLayer *layer, int index, double seen[MEASURE_DIRECTIONS]) {
    const VoxelLevel *level = &layer->level[index];
    double volume = (double)level->sides[0] * (double)level->sides[1] * (double)level->sides[2], sum = 0;
    for (int d = 0; d < MEASURE_DIRECTIONS; d++) seen[d] = 0;
    for (size_t i = 0; i < level->code_count; i++) {
        VoxelSample v;
        if (voxel_code_is_inside(level->codes[i])) continue; /* what stops light within a solid has no area */
        voxel_code_unpack(level->codes[i], &v);
        double area = (double)v.density * (double)level->density_unit * volume;
        sum += area;
        for (int d = 0; d < MEASURE_DIRECTIONS; d++) {
            Vec3f w = vec3f_from(scene_spread_direction(d, MEASURE_DIRECTIONS));
            seen[d] += area * sqrt((double)sym3f_quadratic(&v.s, w));
        }
    }
    return sum;
}

typedef struct AreaError {
    double total, rms, worst;  /* relative to the mean over directions */
    double shape, worst_shape; /* of what is seen, relative to its own mean: rms, and at most */
} AreaError;

/* walls: how often each wall of a solid is expected to count: 1 where they stand alone, ½ where solids are thin. */
static inline AreaError measure_area_error(const VoxelLayer *layer, int level, const TestMesh *mesh,
                                           double walls) {
    double seen[MEASURE_DIRECTIONS], truth[MEASURE_DIRECTIONS], mean = 0, own = 0;
    AreaError e = {.total = measure_area(layer, level, seen)};
    for (int d = 0; d < MEASURE_DIRECTIONS; d++) {
        truth[d] = scene_projected_area(mesh, scene_spread_direction(d, MEASURE_DIRECTIONS)) * 2 * walls;
        mean += truth[d] / MEASURE_DIRECTIONS;
    }
    for (int d = 0; d < MEASURE_DIRECTIONS; d++) {
        double error = (seen[d] - truth[d]) / mean;
        e.rms += error * error / MEASURE_DIRECTIONS;
        e.worst = fmax(e.worst, fabs(error));
        own += seen[d] / MEASURE_DIRECTIONS;
    }
    for (int d = 0; d < MEASURE_DIRECTIONS; d++) {
        double error = seen[d] / own - truth[d] / mean;
        e.shape += error * error / MEASURE_DIRECTIONS;
        e.worst_shape = fmax(e.worst_shape, fabs(error));
    }
    e.rms = sqrt(e.rms);
    e.shape = sqrt(e.shape);
    e.total = e.total / mean - 1;
    return e;
}

/* ---- coverage ---- */

typedef struct Coverage {
    double truth, mean[MEASURE_MODELS]; /* mean over all pixels, per model */
    double single[MEASURE_MODELS],
        quad[MEASURE_MODELS]; /* rms per pixel of one voxel's side, one ray each; per bundle of 2 × 2 such */
} Coverage;

static inline double truth_of_pixel(const ScenePicture *p, int pixels, int x, int y) {
    int sum = 0;
    for (int j = 0; j < MEASURE_SUPERSAMPLES; j++)
        for (int i = 0; i < MEASURE_SUPERSAMPLES; i++)
            sum += p->hit[(y * MEASURE_SUPERSAMPLES + j) * pixels * MEASURE_SUPERSAMPLES +
                          x * MEASURE_SUPERSAMPLES + i];
    return sum / (double)(MEASURE_SUPERSAMPLES * MEASURE_SUPERSAMPLES);
}

static inline bool meets_cube(Vec3 at, Vec3 d) {
    double t0 = -1e9, t1 = 1e9;
    Ray ray = {at, d};
    return box3_clip_ray((Box3){{.02, .02, .02}, {.98, .98, .98}}, &ray, &t0, &t1);
}

/* One direction: a random choice of 2 × 2 pixels of the size of the level's voxels. */
static inline int cover_direction(const VoxelLayer *layer, const TestMesh *mesh, int level, Vec3 d,
                                  RandomStream *r, Coverage *sums) {
    int size[3], count = 0;
    voxel_layer_size(layer, level, size);
    double h = 1.0 / size[0];
    int pixels = (int)(1.75 / h) / 2 * 2;
    ScenePicture p = scene_picture(mesh, d, pixels * h, pixels * MEASURE_SUPERSAMPLES);
    double share = fmin(1, 500.0 / (pixels * pixels / 4));
    for (int block = 0; block < pixels * pixels / 4; block++) {
        int bx = block % (pixels / 2) * 2, by = block / (pixels / 2) * 2;
        Vec3 middle = vec3_madd(vec3_madd(vec3(.5, .5, .5), p.s, (bx + 1 - pixels * .5) * h), p.t,
                                (by + 1 - pixels * .5) * h);
        if (random_next_unit(r) > share || !meets_cube(middle, d)) continue;
        double whole[MEASURE_MODELS] = {0};
        for (int q = 0; q < 4; q++) {
            Vec3 at = vec3_madd(vec3_madd(middle, p.s, ((q & 1) - .5) * h), p.t, ((q >> 1) - .5) * h);
            double truth = truth_of_pixel(&p, pixels, bx + (q & 1), by + (q >> 1));
            sums->truth += truth / 4;
            for (int m = 0; m < MEASURE_MODELS; m++) {
                double cover =
                    1 - scene_march(layer, (float)level, measure_models[m], (float)h, at, d, h / 2);
                sums->mean[m] += cover / 4;
                sums->single[m] += (cover - truth) * (cover - truth) / 4;
                whole[m] += (cover - truth) / 4;
            }
        }
        for (int m = 0; m < MEASURE_MODELS; m++) sums->quad[m] += whole[m] * whole[m];
        count++;
    }
    free(p.hit);
    return count;
}

/* Over random directions. */
static inline Coverage measure_coverage(const VoxelLayer *layer, const TestMesh *mesh, int level) {
    Coverage c = {0};
    RandomStream r = {33};
    int count = 0;
    for (int i = 0; i < MEASURE_BUNDLES; i++)
        count += cover_direction(layer, mesh, level, scene_direction(&r), &r, &c);
    c.truth /= count;
    for (int m = 0; m < MEASURE_MODELS; m++) {
        c.mean[m] /= count;
        c.single[m] = sqrt(c.single[m] / count);
        c.quad[m] = sqrt(c.quad[m] / count);
    }
    return c;
}

#endif
