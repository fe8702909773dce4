/* What charts are made of: the noise of references, errors without it, and what the named methods do to pictures. */
#include "analytic.h"

#include <math.h>

static const char spheres[] = "camera { location <0, 1, -4> look_at <0, 0.5, 0> right x up y }\n"
                              "light_source { <-20, 30, -25> rgb 1 }\n"
                              "background { rgb <0.4, 0.5, 0.8> }\n"
                              "plane { y, 0 pigment { checker rgb 0.9, rgb 0.1 scale 0.3 } }\n"
                              "#for (I, -3, 3) sphere { <0.4*I, 0.5, 0.2*I*I>, 0.18 pigment { rgb <0.9, 0.2, 0.1> } } #end\n";

/* A layer as high as the radius over a ball of few cells, with pillars that glow, so that nothing but their outlines is compared. */
static const char curved[] = "global_settings { detail voxels }\n"
                             "camera { location <0, 0, -6> look_at <0, 0, 0> right x up y angle 42 }\n"
                             "background { rgb 0 }\n"
                             "#declare Pillars = texel { resolution 128 layer { cylinder { <0.5, 0, 0.5>, <0.5, 1, 0.5>, 0.2 }\n"
                             "  texture { pigment { gradient y color_map { [0 rgb <1, 0, 0>] [1 rgb <0, 1, 1>] } } finish { ambient 1 diffuse 0 } } } }\n"
                             "#declare S = surface { patch_grid 6, 3 function(u, v) {\n"
                             "  <cos(2*pi*u)*cos(pi*(v - 0.5)*0.9), sin(pi*(v - 0.5)*0.9), sin(2*pi*u)*cos(pi*(v - 0.5)*0.9)> } }\n"
                             "skin { surface { S } texel { Pillars } mapping { repeat <12, 5> height 1 } }\n";

/* Leaves in all directions, a few in a voxel. */
static const char leaves[] = "global_settings { detail voxels }\n"
                             "camera { location <0, 2, -4> look_at <0, 0.3, 0> right x up y angle 50 }\n"
                             "light_source { <-2000, 3000, -2500> rgb 1 parallel point_at 0 }\n"
                             "#declare R = seed(2);\n"
                             "#declare Crown = texel { resolution 32 cyclic x + z layer { #for (I, 1, 60)\n"
                             "    disc { <rand(R), rand(R), rand(R)>, <rand(R) - 0.5, rand(R) - 0.5, rand(R) - 0.5>, 0.06 } #end\n"
                             "  texture { pigment { rgb <0.4, 0.8, 0.2> } finish { diffuse 0.6, 0.3 } } } }\n"
                             "skin { surface { patch_grid 4, 4 function(u, v) { <4*u - 2, 0.4*sin(5*u), 4*v - 2> } } texel { Crown } mapping { repeat <6, 6> height 0.7 } }\n";

static VtsReference *make_reference(const Bench *b, const VtsOptions *options, int samples, const char *text) {
    VtsOptions o = *options;
    VtsReference *reference = NULL;
    o.reference_samples = samples;
    bench_write(b, text);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_reference_make(session, b->scene, NULL, &reference), VTS_OK);
    vts_session_destroy(session);
    return reference;
}

static VtsMeasure measure(const Bench *b, const VtsOptions *options, const VtsReference *reference, const char *knob, const char *value) {
    VtsOptions o = *options;
    VtsPair settings[] = {{"detail", "voxels"}, {knob, value}}; /* geometry itself would hide what is done with voxels */
    VtsMeasure m;
    o.settings = settings, o.setting_count = knob ? 2 : 1;
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_measure(session, b->scene, reference, NULL, &m), VTS_OK);
    vts_session_destroy(session);
    assert_true(m.build_wall_s >= 0 && m.render_wall_s > 0 && m.parse_wall_s > 0 && m.render_user_s >= 0);
    return m;
}

/* Four times the rays, half the noise or less: what is sampled in strata converges faster. And it is what the reference is off by. */
static void noise_is_as_told(void **state) {
    VtsOptions o = options_of_size(48, 48);
    VtsReference *coarse = make_reference(*state, &o, 8, spheres), *fine = make_reference(*state, &o, 128, spheres);
    double coarse_noise = vts_reference_noise(coarse), fine_noise = vts_reference_noise(fine);
    assert_true(coarse_noise > 0.003);
    assert_true(fine_noise < coarse_noise / 3.5);
    VtsMeasure by_coarse = measure(*state, &o, coarse, NULL, NULL), by_fine = measure(*state, &o, fine, NULL, NULL);
    printf("noise %.5f and %.5f; errors with it %.5f, %.5f, without %.5f, %.5f\n", coarse_noise, fine_noise, by_coarse.difference.rmse,
           by_fine.difference.rmse, by_coarse.rmse, by_fine.rmse);
    assert_true(by_coarse.difference.rmse > 1.2 * by_fine.difference.rmse);
    assert_true(fabs(by_coarse.rmse - by_fine.rmse) < 0.35 * (by_coarse.difference.rmse - by_fine.difference.rmse));
    vts_reference_free(coarse);
    vts_reference_free(fine);
}

static void sizes_must_agree(void **state) {
    const Bench *b = *state;
    VtsOptions o = options_of_size(8, 8), other = options_of_size(8, 9);
    VtsReference *reference = make_reference(b, &o, 2, spheres);
    VtsMeasure m;
    VtsSession *session = vts_session_create(&other, NULL);
    assert_int_equal(vts_measure(session, b->scene, reference, NULL, &m), VTS_ERROR_USAGE);
    assert_non_null(strstr(vts_diagnostics(session), "8 x 8"));
    vts_session_destroy(session);
    vts_reference_free(reference);
    vts_reference_free(NULL);
}

static void references_are_loaded_with_and_without_noise(void **state) {
    const Bench *b = *state;
    VtsOptions o = options_of_size(16, 12);
    char error[200];
    VtsReference *loaded = NULL;
    const char *const none[2] = {"/nonexistent/reference.pfm", NULL};
    assert_int_equal(vts_reference_load(none, &loaded, error, sizeof error), VTS_ERROR_FILE);
    assert_null(loaded);
    assert_true(error[0]);
    assert_int_equal(bench_try(b, &o, spheres), VTS_OK);
    const char *const once[2] = {b->output, NULL}, *const twice[2] = {b->output, b->output};
    assert_int_equal(vts_reference_load(once, &loaded, NULL, 0), VTS_OK);
    assert_true(vts_reference_noise(loaded) < 0);
    VtsMeasure m = measure(b, &o, loaded, NULL, NULL);
    assert_true(m.rmse == 0 && m.difference.rmse == 0 && m.difference.flip < 1e-6);
    vts_reference_free(loaded);
    assert_int_equal(vts_reference_load(twice, &loaded, NULL, 0), VTS_OK);
    assert_true(vts_reference_noise(loaded) == 0);
    vts_reference_free(loaded);
}

static void knobs_are_checked(void **state) {
    (void)state;
    char error[300];
    assert_int_equal(vts_setting_check("ray_path", "exact", error, sizeof error), VTS_OK);
    assert_string_equal(error, "");
    assert_int_equal(vts_setting_check("max_error", "1/255", NULL, 0), VTS_OK);
    static const char *const wrong[][3] = {{"ray_pth", "exact", "ray_path"},  {"ray_path", "exakt", "exact"}, {"zzzzzz", "1", "there are"},
                                           {"quadrature", "none", "ring8"},   {"max_error", "0", "1/255"},    {"max_error", "1/0", "1/255"},
                                           {"max_error", "nan", "1/255"},     {"samples", "1.5", "whole"},    {"samples", "257", "256"},
                                           {"shadow_aperture", "2x", "1000"}, {"", "", "there are"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(vts_setting_check(wrong[i][0], wrong[i][1], error, sizeof error), VTS_ERROR_USAGE);
        assert_non_null(strstr(error, wrong[i][2]));
    }
    assert_string_equal(vts_setting_values("opacity_model")[0], "correlated");
    assert_null(vts_setting_values("samples"));
    assert_null(vts_setting_values("nothing"));
}

/* Chords miss what bent paths meet. */
static void bent_paths_are_nearer_to_the_reference(void **state) {
    VtsOptions o = options_of_size(64, 64);
    VtsReference *reference = make_reference(*state, &o, 32, curved);
    VtsMeasure straight = measure(*state, &o, reference, "ray_path", "straight"), box = measure(*state, &o, reference, "ray_path", "box");
    VtsMeasure exact = measure(*state, &o, reference, "ray_path", "exact"), plain = measure(*state, &o, reference, NULL, NULL);
    printf("curved layer: RMSE straight %.4f, box %.4f, exact %.4f (noise %.4f)\n", straight.rmse, box.rmse, exact.rmse, vts_reference_noise(reference));
    assert_true(box.rmse < 0.85 * straight.rmse);
    assert_true(fabs(exact.rmse - box.rmse) < 0.05 * box.rmse);
    assert_true(plain.difference.rmse == box.difference.rmse && plain.voxels_visited == box.voxels_visited);
    vts_reference_free(reference);
}

static void every_method_draws_its_own_picture(void **state) {
    static const char *const knobs[] = {"opacity_model", "quadrature", "filtering", "ray_path"};
    VtsOptions o = options_of_size(32, 32);
    VtsReference *reference = make_reference(*state, &o, 4, leaves);
    for (size_t k = 0; k < sizeof knobs / sizeof *knobs; k++) {
        double errors[8];
        const char *const *values = vts_setting_values(knobs[k]);
        for (size_t i = 0; values[i]; i++) {
            errors[i] = measure(*state, &o, reference, knobs[k], values[i]).difference.rmse;
            assert_true(errors[i] > 0 && errors[i] < 0.5);
            for (size_t j = 0; j < i; j++) assert_true(errors[i] != errors[j]);
        }
    }
    vts_reference_free(reference);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_as_told),
        cmocka_unit_test(sizes_must_agree),
        cmocka_unit_test(references_are_loaded_with_and_without_noise),
        cmocka_unit_test(knobs_are_checked),
        cmocka_unit_test(bent_paths_are_nearer_to_the_reference),
        cmocka_unit_test(every_method_draws_its_own_picture),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
