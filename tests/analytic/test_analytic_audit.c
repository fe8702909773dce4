/* The report knows how wrong pictures of voxels are, which samples do not tell. */
#include "analytic.h"

static const char hair[] =
    "camera { location <0, 0.7, -3> look_at <0, 0, 0> right x up y angle 45 }\n"
    "light_source { <-20, 30, -25> rgb 1 }\nbackground { rgb <0.2, 0.3, 0.4> }\n"
    "#declare S = seed(8);\n"
    "#declare Hair = texel { cyclic x + z layer { particles { count 12 { position <rand(S), 0, rand(S)>\n"
    "  velocity <0.4*rand(S)-0.2, 1, 0.4*rand(S)-0.2> acceleration <0.3, -0.3, 0> life 0.9 width 0.12, 0.02 } }\n"
    "  texture { pigment { rgb <0.6, 0.4, 0.2> } finish { diffuse 0.8 } } } }\n"
    "skin { surface { sphere { 0, 1 } } texel { Hair } mapping { repeat <20, 10> height 0.3 } }\n"
    "sphere { 0, 1 }\n";

static Picture draw(const Bench *b, const char *knobs, const VtsOptions *o, double *expected) {
    static char scene[2048];
    snprintf(scene, sizeof scene, "global_settings { assumed_gamma 1 %s }\n%s", knobs, hair);
    bench_write(b, scene);
    VtsSession *session = vts_session_create(o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *key = "\"error_estimate\":", *at = strstr(vts_report(session), key);
    assert_non_null(at);
    *expected = strncmp(at + strlen(key), "null", 4) ? strtod(at + strlen(key), NULL) : -1;
    vts_session_destroy(session);
    return picture_read(b->output);
}

static void voxels_are_audited(void **state) {
    double expected, unasked, unused;
    VtsOptions o = options_of_size(32, 32);
    Picture voxels = draw(*state, "detail voxels", &o, &expected);
    o.unreported = true;
    Picture again = draw(*state, "detail voxels", &o, &unasked);
    o.samples = 128;
    Picture truth = draw(*state, "detail exact", &o, &unused);
    double rms = picture_difference(&truth, &voxels).rms;
    print_message("RMSE %.4f, expected %.4f\n", rms, expected);
    assert_true(rms > 0.004);
    assert_true(expected > rms / 2 && expected < rms * 2);
    assert_true(unasked < 0); /* nothing is done for a report that nobody reads, */
    assert_true(picture_difference(&again, &voxels).rms == 0); /* and pictures do not hang on it */
    picture_free(&voxels);
    picture_free(&again);
    picture_free(&truth);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(voxels_are_audited)};
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
