/* Where media fail: many objects within each other. */
#include "stability.h"

/* What is seen through the middle of so many balls within each other that only absorb, and what was said of it. */
static double seen_through(const Bench *b, int balls, bool *told) {
    char text[512];
    VtsOptions o = options_of_size(4, 3);
    snprintf(text, sizeof text,
             "global_settings { assumed_gamma 1 }\nbackground { rgb 1 }\ncamera { orthographic location -5*z look_at 0 right 1e-4*x up 1e-4*y }\n"
             "#for (I, 1, %d) sphere { 0, I/%d pigment { rgbt 1 } hollow interior { media { absorption rgb 0.02 } } } #end\n", balls, balls);
    bench_write(b, text);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    *told = strstr(vts_diagnostics(session), "objects lie within each other") != NULL;
    vts_session_destroy(session);
    Picture p = picture_read(b->output);
    double mean = picture_mean(&p);
    picture_free(&p);
    return mean;
}

/* The sum of the balls' diameters is their number and one more; without the innermost, where there are more than 64, by so much less. */
static void balls_within_balls_are_all_seen_or_told(void **state) {
    static const int counts[] = {1, 24, 60, 100};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(counts); i++) {
        bool told;
        double seen = seen_through(*state, counts[i], &told), inner = fmax(counts[i] - 64, 0), exact = exp(-0.02 * (counts[i] + 1 - inner * (inner + 1) / counts[i]));
        printf("%d balls: %.5f (%.5f)%s\n", counts[i], seen, exact, told ? ", told" : "");
        assert_true(told == (inner > 0) && fabs(seen - exact) < 1e-4);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(balls_within_balls_are_all_seen_or_told)};
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
