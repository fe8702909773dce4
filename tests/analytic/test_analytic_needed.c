/* Of what a scene asks for, only what its picture can show is built. */
#include "analytic.h"

/* A lawn of 400 m; a texel is 40 cm wide, its blades a few millimetres. */
static const char lawn[] =
    "light_source { <-20000, 30000, -25000> rgb 1 parallel point_at 0 }\n"
    "background { rgb <0.4, 0.5, 0.8> }\n"
    "#declare S = seed(3);\n"
    "#declare Tuft = texel { resolution 256 cyclic x + z layer { particles { count 16 {\n"
    "  position <rand(S), 0, rand(S)> velocity <0.3*rand(S)-0.15, 0.9, 0.3*rand(S)-0.15> acceleration <0, -0.3, 0.1> life 1\n"
    "  width 0.05, 0.005 profile \"v\" } } texture { pigment { rgb <0.2, 0.5, 0.1> } finish { diffuse 0.6, 0.3 } } } }\n"
    "#declare Ground = surface { patch_grid 8, 8 function(u, v) { <400*u - 200, sin(7*u)*cos(5*v), 400*v - 200> } }\n"
    "object { Ground pigment { rgb <0.1, 0.08, 0.04> } }\n"
    "skin { surface { Ground } texel { Tuft } mapping { repeat <1000, 1000> height 0.3 } jitter { height 0.3 scale 2 seed 4 } }\n";

typedef struct Built {
    double needed, built, voxels;
} Built;

static Built seen_from(const Bench *b, const char *camera, const char *knobs) {
    static char scene[4096];
    VtsOptions o = options_of_size(64, 48);
    snprintf(scene, sizeof scene, "global_settings { assumed_gamma 1 %s }\ncamera { %s right 4/3*x }\n%s", knobs, camera, lawn);
    bench_write(b, scene);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *report = vts_report(session);
    assert_true(number_after(report, "\"asked\":") == 256);
    Built built = {number_after(report, "\"needed\":"), number_after(report, "\"built\":"), number_after(report, "\"voxels\":")};
    print_message("%s: needed %g, built %g, voxels %g\n", camera, built.needed, built.built, built.voxels);
    vts_session_destroy(session);
    return built;
}

static void a_lawn_from_a_kilometre_has_one_voxel_in_a_hundred(void **state) {
    Built near = seen_from(*state, "location <0, 1.2, -2> look_at <0, 0.2, 0> angle 8", "detail voxels");
    Built far = seen_from(*state, "location <0, 300, -950> look_at 0 angle 42", "detail voxels");
    Built telescope = seen_from(*state, "location <0, 300, -950> look_at 0 angle 0.05", "detail voxels");
    assert_true(near.built == 256); /* what is asked for, where it is seen, */
    assert_true(far.voxels > 0 && far.voxels < 0.01 * near.voxels); /* and not where it is not: */
    assert_true(telescope.voxels > 0.01 * near.voxels); /* a matter of pixels, not of metres */
    assert_true(far.built >= far.needed && far.needed <= 4);
}

/* Drawn as triangles to the last blade: there is no voxel that anything could see. */
static void what_is_drawn_as_triangles_has_no_voxels(void **state) {
    Built built = seen_from(*state, "location <0, 1.2, -2> look_at <0, 0.2, 0> angle 8", "detail exact");
    assert_true(built.voxels == 0 && built.built == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lawn_from_a_kilometre_has_one_voxel_in_a_hundred),
        cmocka_unit_test(what_is_drawn_as_triangles_has_no_voxels),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
