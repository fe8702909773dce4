/* Exact geometry of a picture that cannot keep max_error anyway is bounded; of one that can it is not. Its horizon is right, by whatever it is drawn. */
#include "analytic.h"

/* A rolling field of bushes of leaves, seen from its border to the horizon. */
static const char field[] =
    "camera { location <0, 3, -22> look_at <0, 0, 0> right 1.5*x up y angle 50 }\n"
    "light_source { <-200, 150, -100> rgb 1.3 parallel point_at 0 }\n"
    "background { rgb <0.6, 0.7, 0.9> }\n"
    "#declare S = seed(5);\n"
    "#declare Bush = texel { cyclic x + z layer { mesh { #for (I, 1, 2500) #local P = <rand(S), 0.8*rand(S), rand(S)>; #local R = 360*<rand(S), rand(S), rand(S)>;\n"
    "  triangle { P, P + vrotate(0.03*x, R), P + vrotate(0.03*z, R) } #end } texture { pigment { rgb <0.2, 0.5, 0.1> } } } }\n"
    "#declare Ground = surface { patch_grid 30, 30 function(u, v) { <90*u - 45, 0.8*sin(20*u)*cos(17*v), 400*v - 25> } texture { pigment { rgb <0.5, 0.4, 0.2> } } }\n"
    "object { Ground }\n"
    "skin { surface { Ground } texel { Bush } mapping { repeat <60, 270> height 1.2 } }\n";

typedef struct Work {
    double triangles, steps, error;
} Work;

static Work work_of(const Bench *b, const char *knobs, double max_error) {
    static char scene[4096];
    VtsOptions o = options_of_size(128, 96);
    o.max_error = max_error;
    snprintf(scene, sizeof scene, "global_settings { assumed_gamma 1 %s }\n%s", knobs, field);
    bench_write(b, scene);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *report = vts_report(session);
    Work work = {number_after(report, "\"texel_triangles\":"), number_after(report, "\"march_steps\":"), number_after(report, "\"error_estimate\":")};
    print_message("%s %g: %g triangles, %g steps, error %g\n", knobs, max_error, work.triangles, work.steps, work.error);
    vts_session_destroy(session);
    return work;
}

/* What a step costs, in triangles: with the boxes around them. */
static const double STEP_TRIANGLES = 8;

static void what_cannot_be_kept_is_bounded(void **state) {
    Work voxels = work_of(*state, "detail voxels", 0.001), chosen = work_of(*state, "", 0.001);
    double alone = STEP_TRIANGLES * voxels.steps;
    assert_true(chosen.triangles + STEP_TRIANGLES * chosen.steps < 6 * alone);
    assert_true(chosen.triangles > 0);
    assert_true(chosen.error > 0.001); /* and the report says so */
}

static void what_can_be_kept_is(void **state) {
    Work chosen = work_of(*state, "", 0.03);
    assert_true(chosen.error > 0 && chosen.error < 0.03);
}

/* The layer is far lower than a pixel at the horizon, 400 away. One cone a pixel met it or passed over it: 0.072 and 0.058. */
static void horizons_are_right(void **state) {
    VtsOptions drawn = options_of_size(64, 48), exact = drawn;
    exact.reference_samples = 96;
    for (int voxels = 0; voxels < 2; voxels++) {
        static char scene[4096];
        snprintf(scene, sizeof scene, "global_settings { assumed_gamma 1 %s }\n%s", voxels ? "detail voxels" : "", field);
        Picture truth = bench_see(*state, &exact, scene, true), picture = bench_see(*state, &drawn, scene, false);
        const int row = 14; /* down to 18: what is around the horizon */
        double sum = 0;
        for (int y = row; y < row + 4; y++)
            for (int i = 0; i < 3 * 64; i++) sum += pow((double)pixel_at(&picture, 0, y)[i] - (double)pixel_at(&truth, 0, y)[i], 2);
        double rms = sqrt(sum / (4 * 3 * 64));
        print_message("%s: %.4f\n", voxels ? "voxels" : "auto", rms);
        assert_true(rms < 0.035);
        picture_free(&truth);
        picture_free(&picture);
    }
}

/* Where voxels are right enough, and far cheaper, there is no geometry at all. */
static void voxels_that_keep_it_are_alone(void **state) {
    Work chosen = work_of(*state, "", 0.016);
    assert_true(chosen.triangles <= 0 && chosen.steps > 0);
    assert_true(chosen.error > 0 && chosen.error < 0.016);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(horizons_are_right), cmocka_unit_test(what_cannot_be_kept_is_bounded), cmocka_unit_test(what_can_be_kept_is),
                                       cmocka_unit_test(voxels_that_keep_it_are_alone)};
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
