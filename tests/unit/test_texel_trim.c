/* Coarse levels hide as much as the triangles do, from directions between those that they were trimmed along. */
#include "texel/voxel_trim.h"
#include "texel_measures.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static VoxelLayer *trimmed(const TestMesh *mesh, int resolution, unsigned cyclic) {
    TexelMesh view = scene_view(mesh);
    TexelBuildOptions options = {.resolution = resolution, .extent = {1, 1, 1}, .cyclic = cyclic};
    VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
    assert_non_null(layer);
    return layer;
}

/* The mean over a picture that the whole layer is in, seen along d. */
static double hidden_by_layer(const VoxelLayer *layer, int level, Vec3 d, double size, bool trim) {
    enum { RAYS = 48, STEPS = 64 };
    Vec3 s, t;
    vec3_frame(d, &s, &t);
    double sum = 0, h = 1.0 / (double)layer->level[level].density_unit, length = 1.8 / STEPS;
    Vec3f along = vec3f_from(vec3_scale(d, length));
    for (int i = 0; i < RAYS * RAYS; i++) {
        Vec3 at = vec3_madd(vec3_madd(vec3(.5, .5, .5), s, ((i % RAYS + .5) / RAYS - .5) * size), t, ((i / RAYS + .5) / RAYS - .5) * size);
        double depth = 0;
        for (int k = 0; k < STEPS; k++) {
            VoxelSample v;
            if (voxel_layer_sample(layer, level, vec3f_from(vec3_madd(at, d, (k + .5 - STEPS / 2) * length)), &v))
                depth += (double)opacity_depth(OPACITY_CORRELATED, &v, (float)h, along);
        }
        sum += 1 - exp(-depth * (trim ? (double)voxel_layer_trim_at(layer, (float)level, along) : 1));
    }
    return sum / (RAYS * RAYS);
}

static double hidden_by_mesh(const TestMesh *mesh, Vec3 d, double size) {
    enum { PLACES = 384 };
    ScenePicture p = scene_picture(mesh, d, size, PLACES);
    double hits = 0;
    for (int i = 0; i < PLACES * PLACES; i++) hits += p.hit[i];
    free(p.hit);
    return hits / (PLACES * PLACES);
}

typedef struct HidingError {
    double trimmed, plain; /* rms over directions, relative to what is hidden */
} HidingError;

static HidingError measure(const TestMesh *mesh, int resolution, int level_from_top) {
    enum { DIRECTIONS = 10 };
    VoxelLayer *layer = trimmed(mesh, resolution, 0);
    HidingError e = {0, 0};
    RandomStream r = {77};
    for (int i = 0; i < DIRECTIONS; i++) {
        Vec3 d = scene_direction(&r);
        d.y = (d.y < 0 ? -1 : 1) * fmax(fabs(d.y), 0.25);
        d = vec3_normalize(d);
        double truth = hidden_by_mesh(mesh, d, 1.8);
        int level = layer->levels - 1 - level_from_top;
        double with = hidden_by_layer(layer, level, d, 1.8, true) / truth - 1, plain = hidden_by_layer(layer, level, d, 1.8, false) / truth - 1;
        e.trimmed += with * with / DIRECTIONS, e.plain += plain * plain / DIRECTIONS;
    }
    voxel_layer_destroy(layer);
    return (HidingError){sqrt(e.trimmed), sqrt(e.plain)};
}

static void test_coarse_levels_hide_what_triangles_hide(void **state) {
    (void)state;
    struct {
        const char *name;
        TestMesh mesh;
    } contents[] = {{"60 blades", scene_grass(60, .6, .02, 4)}, {"300 blades", scene_grass(300, .6, .006, 4)}, {"600 leaves", scene_leaves(600, .035, 1)}, {"60 leaves", scene_leaves(60, .05, 2)}};
    int failed = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(contents); i++) {
        for (int top = 0; top < 5; top++) {
            HidingError e = measure(&contents[i].mesh, 32, top);
            bool good = e.trimmed < (top ? 0.035 : 0.06) && e.trimmed < 1.1 * e.plain + 0.01;
            failed += !good;
            printf("%-10s %d voxels a side: what is hidden is off by %.3f, untrimmed %.3f%s\n", contents[i].name, 1 << top, e.trimmed, e.plain, good ? "" : "  <--");
        }
        scene_free(&contents[i].mesh);
    }
    assert_int_equal(failed, 0);
}

static void test_factors_are_those_of_directions(void **state) {
    (void)state;
    TestMesh mesh = scene_grass(60, .6, .02, 4);
    VoxelLayer *layer = trimmed(&mesh, 16, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z);
    assert_true(voxel_layer_is_trimmed(layer));
    RandomStream r = {5};
    for (int i = 0; i < 1000; i++) {
        Vec3 d = scene_direction(&r);
        float lod = (float)(5 * random_next_unit(&r)), factor = voxel_layer_trim_at(layer, lod, vec3f_from(d));
        assert_true(factor >= TRIM_LEAST && factor <= TRIM_MOST);
        assert_true(fabsf(voxel_layer_trim_at(layer, lod, vec3f_from(vec3_scale(d, 1e-3))) - factor) < 1e-4f); /* of any length */
        assert_true(fabsf(voxel_layer_trim_at(layer, lod, vec3f_from(vec3_negate(d))) - factor) < 1e-4f);     /* and both ways */
        Vec3 beside = vec3_normalize(vec3_madd(d, scene_direction(&r), 1e-4));
        assert_true(fabsf(voxel_layer_trim_at(layer, lod, vec3f_from(beside)) - factor) < 0.02f); /* without steps */
    }
    assert_true(voxel_layer_trim_at(layer, 0, vec3f(0, 0, 0)) == 1);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

/* Tall blades, of which each crosses many lines of places from a low direction. */
static void test_dense_grass_is_trimmed(void **state) {
    (void)state;
    TestMesh mesh = scene_grass(2400, .6, .006, 4);
    VoxelLayer *layer = trimmed(&mesh, 32, TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z);
    assert_true(voxel_layer_is_trimmed(layer));
    assert_true(voxel_layer_trim_at(layer, 5, vec3f(.9f, .3f, .2f)) < .5f); /* much of it stands behind the rest */
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

static void test_nothing_to_compare(void **state) {
    (void)state;
    TestMesh up = scene_grass(20, .6, .02, 4), far = {0}, none = {0};
    VoxelLayer *layer = trimmed(&up, 8, TEXEL_CYCLIC_Y);
    assert_false(voxel_layer_is_trimmed(layer));
    voxel_layer_destroy(layer);
    scene_free(&up);
    for (int i = 0; i < 3; i++) scene_vertex(&far, i == 0 ? vec3(.2, .2, .2) : vec3(i == 1 ? 1e30 : .5, .5, i == 2 ? -1e30 : .5));
    scene_triangle(&far, 0, 1, 2, false);
    layer = trimmed(&far, 8, TEXEL_CYCLIC_X);
    assert_false(voxel_layer_is_trimmed(layer));
    voxel_layer_destroy(layer);
    scene_free(&far);
    layer = trimmed(&none, 8, 0);
    assert_false(voxel_layer_is_trimmed(layer));
    voxel_layer_destroy(layer);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_coarse_levels_hide_what_triangles_hide),
                                       cmocka_unit_test(test_factors_are_those_of_directions), cmocka_unit_test(test_dense_grass_is_trimmed),
                                       cmocka_unit_test(test_nothing_to_compare)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
