/* Opacity: its laws, and what marched voxels cover against the exact geometry, for oblique bundles of rays. */
#include "texel_measures.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static VoxelSample random_voxel(RandomStream *r) {
    Vec3 n = scene_direction(r), s, t;
    vec3_frame(n, &s, &t);
    float a = (float)random_next_unit(r), b = (float)random_next_unit(r);
    const Vec3 axes[3] = {n, s, t};
    const float values[3] = {3.9f, 3.9f * a * a, 3.9f * b * b};
    VoxelSample v = {.density = exp2f((float)random_next_unit(r) * 14 - 8),
                     .gamma = (float)random_next_unit(r)};
    for (int i = 0; i < 3; i++) {
        float x = (float)axes[i].x, y = (float)axes[i].y, z = (float)axes[i].z, w = values[i];
        v.s = (Sym3f){v.s.xx + w * x * x, v.s.yy + w * y * y, v.s.zz + w * z * z,
                      v.s.xy + w * x * y, v.s.xz + w * x * z, v.s.yz + w * y * z};
    }
    return v;
}

static void test_steps_compose(void **state) {
    (void)state;
    RandomStream r = {31};
    for (int i = 0; i < 40000; i++) {
        OpacityModel model = measure_models[i % 4];
        VoxelSample v = random_voxel(&r);
        float h = exp2f(-(float)(i % 7)), a = h * (float)random_next_unit(&r),
              b = h * (float)random_next_unit(&r);
        Vec3f d = vec3f_from(scene_direction(&r));
        float ta = opacity_transmittance(model, &v, h, vec3f_scale(d, a));
        float tb = opacity_transmittance(model, &v, h, vec3f_scale(d, b));
        float both = opacity_transmittance(model, &v, h, vec3f_scale(d, a + b));
        assert_true(ta > 0 && ta <= 1 && both > 0 && both <= 1);
        if (both > 1e-30f) assert_true(fabsf(ta * tb / both - 1) < 3e-4f);
        /* the way back is as opaque */
        assert_true(opacity_transmittance(model, &v, h, vec3f_scale(d, -a)) == ta);
        assert_true(opacity_transmittance(model, &v, h, vec3f(0, 0, 0)) == 1);
        assert_true(opacity_transmittance(model, &v, h, vec3f_scale(d, 1e20f)) > 0);
    }
}

static void test_limits_of_the_laws(void **state) {
    (void)state;
    RandomStream r = {32};
    for (int i = 0; i < 4000; i++) {
        VoxelSample v = random_voxel(&r);
        Vec3f step = vec3f_scale(vec3f_from(scene_direction(&r)), .01f);
        float tau = v.density * sqrtf(sym3f_quadratic(&v.s, step)), h = 1.0f / 64;
        float random = opacity_transmittance(OPACITY_EXPONENTIAL, &v, h, step);
        assert_true(fabsf(random - expf(-tau)) < 1e-6f);
        float correlated = opacity_transmittance(OPACITY_CORRELATED, &v, h, step);
        assert_true(correlated <=
                    random + 1e-6f); /* a sheet never covers less than the same area at random */
        VoxelSample clumped = v;
        clumped.gamma = -.4f;
        assert_true(opacity_transmittance(OPACITY_CORRELATED, &clumped, h, step) >= random);
        v.gamma = 0;
        assert_true(fabsf(opacity_transmittance(OPACITY_CORRELATED, &v, h, step) - random) < 1e-6f);
        VoxelSample thin = v; /* matter much thinner than a voxel is the same in all models */
        thin.density = 1e-3f / h;
        thin.gamma = 1;
        float expected = expf(-thin.density * sqrtf(sym3f_quadratic(&thin.s, step)));
        for (int m = 0; m < 4; m++)
            assert_true(fabsf(opacity_transmittance(measure_models[m], &thin, h, step) - expected) < 2e-5f);
    }
    for (float enhancement = .5f; enhancement < 8; enhancement += .5f) {
        float gamma = opacity_gamma_for(enhancement, 2);
        assert_true(fabsf(opacity_enhancement(gamma, 2) - enhancement) < 1e-4f);
    }
    VoxelSample none = {0};
    for (int m = 0; m < 4; m++) assert_true(opacity_transmittance(measure_models[m], &none, 1, vec3f(1, 2, 3)) == 1);
}

/* ---- coverage ---- */

enum { LEVELS = 4 };

/* limits: of the correlated model, at voxels 1, 2, 4 and 8 times coarser: rms per bundle of two voxels' width. */
static void check_coverage(const char *name, TestMesh mesh, const double limits[LEVELS], double mean_limit) {
    TexelMesh view = scene_view(&mesh);
    TexelBuildOptions options = {.resolution = 64, .extent = {1, 1, 1}};
    VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
    for (int level = 0; level < LEVELS; level++) {
        Coverage c = measure_coverage(layer, &mesh, level);
        print_message("%-13s %dx: true %.3f | mean, rms per voxel, per 2x2: exp %.3f %.3f %.3f | crossing "
                      "%.3f %.3f %.3f | "
                      "correlated %.3f %.3f %.3f\n",
                      name, 1 << level, c.truth, c.mean[1], c.single[1], c.quad[1], c.mean[3], c.single[3],
                      c.quad[3], c.mean[2], c.single[2], c.quad[2]);
        assert_true(c.quad[2] < limits[level]);
        assert_true(fabs(c.mean[2] - c.truth) < mean_limit);
    }
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

static void test_coverage_of_leaves_and_grass(void **state) {
    (void)state;
    check_coverage("600 leaves", scene_leaves(600, .035, 1), (double[]){.06, .065, .065, .05}, .03);
    check_coverage("60 leaves", scene_leaves(60, .05, 2), (double[]){.045, .045, .045, .035}, .012);
    check_coverage("grass", scene_grass(300, .6, .012, 3), (double[]){.035, .035, .045, .055}, .028);
}

static void test_coverage_of_sheets(void **state) {
    (void)state;
    check_coverage("sheet", scene_sheet(vec3(0, 0, 1), .45), (double[]){.06, .075, .085, .12}, .025);
    check_coverage("tilted sheet", scene_sheet(vec3_normalize(vec3(.3, .2, .93)), .4),
                   (double[]){.03, .055, .04, .06}, .025);
    check_coverage("diagonal", scene_sheet(vec3_normalize(vec3(1, 1, 1)), .4),
                   (double[]){.03, .03, .055, .065}, .03);
}

static void test_coverage_of_solids(void **state) {
    (void)state;
    check_coverage("sphere", scene_sphere(vec3(.5, .5, .5), .4, 48), (double[]){.015, .02, .04, .065}, .01);
    check_coverage("box", scene_box(vec3(.23, .31, .17), vec3(.71, .77, .83)),
                   (double[]){.025, .04, .045, .065}, .02);
    check_coverage("cylinder", scene_cylinder(vec3(.2, .1, .3), vec3(.7, .9, .6), .04, 24),
                   (double[]){.015, .03, .035, .023}, .006);
    check_coverage("thin cylinder", scene_cylinder(vec3(.2, .1, .3), vec3(.7, .9, .6), .004, 12),
                   (double[]){.01, .01, .01, .01}, .003);
}

/* An intact sheet stops light from every side, and a solid's two walls together. What is left gets through where a sheet goes
 * over from one layer of voxels to the next: there a ray may pass between the two, another ray meets both. */
static void test_sheets_are_tight(void **state) {
    (void)state;
    RandomStream r = {34};
    double sum = 0, worst = 0, solid_worst = 0;
    int count = 0;
    TestMesh sphere = scene_sphere(vec3(.5, .5, .5), .3, 48);
    for (int i = 0; i < 24; i++) {
        Vec3 n = scene_direction(&r), s, t;
        vec3_frame(n, &s, &t);
        TestMesh mesh = i < 20 ? scene_sheet(n, .45) : sphere;
        TexelMesh view = scene_view(&mesh);
        TexelBuildOptions options = {.resolution = 64, .extent = {1, 1, 1}};
        VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
        for (int k = 0; k < 200; k++) {
            double u = random_next_unit(&r) - .5, v = random_next_unit(&r) - .5;
            Vec3 d = scene_direction(&r), at = vec3_madd(vec3_madd(vec3(.5, .5, .5), s, .5 * u), t, .5 * v);
            if (i >= 20) at = vec3(.5, .5, .5);
            int level = k % 3;
            float h = (float)(1 << level) / 64;
            if (fabs(vec3_dot(d, n)) < .2 && i < 20) continue;
            double through = scene_march(layer, (float)level, OPACITY_CORRELATED, h, at, d, (double)h / 2);
            if (i >= 20) {
                solid_worst = fmax(solid_worst, through);
                continue;
            }
            sum += through;
            worst = fmax(worst, through);
            count++;
        }
        voxel_layer_destroy(layer);
        if (i < 20) scene_free(&mesh);
    }
    scene_free(&sphere);
    print_message("let through: sheets mean %.3f worst %.3f, sphere worst %.3f\n", sum / count, worst,
                  solid_worst);
    assert_true(sum / count < .04 && worst < .6 && solid_worst < .002);
}

/* Published averaging loses most of the opacity of far leaves, which is why the other models exist. */
static void test_mean_opacity_vanishes(void **state) {
    (void)state;
    TestMesh mesh = scene_leaves(600, .035, 1);
    TexelMesh view = scene_view(&mesh);
    TexelBuildOptions options = {.resolution = 64, .extent = {1, 1, 1}};
    VoxelLayer *layer = voxel_layer_build(&view, &options, NULL);
    double cover[2] = {0};
    for (int level = 0; level < 5; level += 4) {
        float finest = 1.0f / 64, h = (float)(1 << level) * finest;
        for (int i = 0; i < 400; i++) {
            Vec3f p = vec3f((float)(i % 20 + .5) / 20, (float)(i / 20 + .5) / 20, 0),
                  step = vec3f(0, 0, h / 2);
            float through = 1;
            for (int k = 0; (float)k * h / 2 < 1; k++) {
                VoxelSample v;
                if (voxel_layer_sample(layer, level, vec3f_madd(p, step, (float)k + .5f), &v))
                    through *= opacity_transmittance_mean(&v, finest, h, step);
            }
            cover[level / 4] += (double)(1 - through) / 400;
        }
    }
    print_message("mean opacity: %.3f at the finest level, %.3f at 16 times coarser\n", cover[0], cover[1]);
    assert_true(cover[1] < .4 * cover[0]);
    voxel_layer_destroy(layer);
    scene_free(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps_compose),
        cmocka_unit_test(test_limits_of_the_laws),
        cmocka_unit_test(test_coverage_of_leaves_and_grass),
        cmocka_unit_test(test_coverage_of_sheets),
        cmocka_unit_test(test_coverage_of_solids),
        cmocka_unit_test(test_sheets_are_tight),
        cmocka_unit_test(test_mean_opacity_vanishes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
