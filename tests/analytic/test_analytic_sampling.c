/* Samples of explicit scenes: whether errors are what is said of them, and whether patterns too fine to be seen are grey. */
#include "analytic.h"

static const char things[] = "camera { location <0, 2, -6> look_at <0, 0.8, 0> right x*image_width/image_height }\n"
                             "light_source { <-4, 7, -5> rgb 1 }\n"
                             "background { rgb <0.3, 0.5, 0.8> }\n"
                             "plane { y, 0 pigment { hexagon rgb 0.8 rgb <0.6, 0.3, 0.2> rgb 0.2 scale 0.6 } }\n"
                             "torus { 1.2, 0.05 rotate x*50 translate y pigment { rgb <1, 0.8, 0.2> } finish { phong 0.7 } }\n"
                             "#declare I = 0;\n"
                             "#while (I < 30)\n"
                             "  cone { <I/5 - 3, 0, 1 + sin(I)>, 0.06, <I/5 - 3, 1.5, 1>, 0 pigment { rgb <0.2, 0.7, I/40> } }\n"
                             "  #declare I = I + 1;\n"
                             "#end\n";

static const char lens[] = "camera { location <0, 2, -6> look_at <0, 0.8, 0> right x*image_width/image_height\n"
                           "  aperture 0.3 focal_point <0, 0.8, 0> blur_samples 20 }\n"
                           "light_source { <4, 7, -5> rgb 1 }\n"
                           "background { rgb <0.3, 0.5, 0.8> }\n"
                           "plane { y, 0 pigment { checker rgb 0.9 rgb 0.4 } }\n"
                           "#declare I = 0;\n"
                           "#while (I < 12)\n"
                           "  sphere { <mod(I, 4) - 1.5, 0.4, 2*floor(I/4) - 3>, 0.4 pigment { rgb <1, 0.1*I, 0.2> } finish { phong 0.5 } }\n"
                           "  #declare I = I + 1;\n"
                           "#end\n";

static double reported_error(const Bench *b, const VtsOptions *o) {
    VtsSession *session = vts_session_create(o, NULL);
    assert_non_null(session);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *at = strstr(vts_report(session), "\"error_estimate\":");
    assert_non_null(at);
    double error = strtod(at + strlen("\"error_estimate\":"), NULL);
    vts_session_destroy(session);
    return error;
}

static double clamped_rms(const Picture *a, const Picture *b) {
    double sum = 0;
    size_t n = 3 * (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < n; i++) {
        double e = fmin((double)a->pixels[i], 1) - fmin((double)b->pixels[i], 1);
        sum += e * e;
    }
    return sqrt(sum / (double)n);
}

static void check_error(const Bench *b, const char *text, double max_error) {
    VtsOptions o = options_of_size(64, 48);
    o.samples = 256;
    o.seed = 5;
    Picture truth = bench_render(b, &o, text);
    o.samples = 0;
    o.seed = 0;
    o.max_error = max_error;
    double said = reported_error(b, &o);
    Picture p = picture_read(b->output);
    double error = clamped_rms(&p, &truth);
    print_message("asked %.4f said %.4f found %.4f\n", max_error, said, error);
    assert_true(said <= max_error * 1.001);
    assert_true(error < 2 * said && error > said / 2);
    picture_free(&p);
    picture_free(&truth);
}

static void errors_are_what_is_said(void **state) {
    check_error(*state, things, 4.0 / 255);
    check_error(*state, things, 1.0 / 255);
    check_error(*state, lens, 4.0 / 255);
    check_error(*state, lens, 1.5 / 255);
}

/* Slats of a tenth of a pixel between the middles of rows, whose shares of pixels are known. */
static const char slats[] = "camera { orthographic location <0, 0, -6> look_at 0 right 48*x up 36*y }\n"
                            "background { rgb 0.9 }\n"
                            "#declare I = -17;\n"
                            "#while (I < 18)\n"
                            "  box { <-30, I - 0.05, 0>, <30, I + 0.05, 0.1> pigment { rgb 0 } }\n"
                            "  #declare I = I + 3;\n"
                            "#end\n";

static void what_middles_miss_is_found(void **state) {
    VtsOptions o = options_of_size(48, 36);
    bench_write(*state, slats);
    double said = reported_error(*state, &o), sum = 0;
    Picture p = picture_read(((const Bench *)*state)->output);
    for (int y = 0; y < 36; y++)
        for (int x = 0; x < 48; x++) {
            double off = (double)pixel_at(&p, x, y)[0] - (y % 3 == 0 ? 0.9 : 0.9 * 0.95);
            sum += off * off / (48 * 36);
        }
    picture_free(&p);
    print_message("found %.4f said %.4f\n", sqrt(sum), said);
    assert_true(sqrt(sum) < 2.0 / 255); /* 0.037 if none is seen */
    assert_true(said > sqrt(sum) / 2);
}

/* Bumps far finer than a pixel that mirror a lamp. */
static const char ripples[] = "camera { location <0, 1.2, -6> look_at <0, 0.8, 4> right x*image_width/image_height angle 55 }\n"
                              "light_source { <100, 60, 300> rgb <1, 0.8, 0.6> }\n"
                              "sky_sphere { pigment { gradient y color_map { [0 rgb <1, 0.6, 0.3>] [0.3 rgb <0.4, 0.5, 0.8>] [1 rgb <0.1, 0.2, 0.5>] } } }\n"
                              "plane { y, 0 pigment { rgb <0.02, 0.05, 0.08> } normal { bumps 0.3 scale <0.3, 0.3, 0.15> }\n"
                              "  finish { reflection 0.6 specular 0.8 roughness 0.003 diffuse 0.2 } }\n";

static void bumps_are_not_smoothed_away(void **state) {
    VtsOptions o = options_of_size(48, 36);
    o.reference_samples = 100;
    Picture truth = bench_see(*state, &o, ripples, true);
    double said = reported_error(*state, &o);
    Picture p = picture_read(((const Bench *)*state)->output);
    double error = clamped_rms(&p, &truth);
    print_message("found %.4f said %.4f\n", error, said);
    assert_true(error < 2.5 / 255);
    picture_free(&p);
    picture_free(&truth);
}

static void threads_and_regions_do_not_change(void **state) {
    VtsOptions o = options_of_size(70, 50);
    o.threads = 1;
    Picture whole = bench_render(*state, &o, lens);
    o.threads = 3;
    Picture again = bench_render(*state, &o, lens);
    assert_memory_equal(again.pixels, whole.pixels, 3 * sizeof(float) * 70 * 50);
    const int region[4] = {17, 23, 60, 49};
    memcpy(o.region, region, sizeof region);
    Picture part = bench_render(*state, &o, lens);
    for (int y = 0; y < part.height; y++) assert_memory_equal(pixel_at(&part, 0, y), pixel_at(&whole, 17, y + 23), 3 * sizeof(float) * 43);
    picture_free(&part);
    picture_free(&again);
    picture_free(&whole);
}

/* The largest difference from grey of the middle rows [y0, y1), columns [x0, x1). */
static double ripple(const Picture *p, int x0, int y0, int x1, int y1) {
    double most = 0, mean = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) mean += (double)pixel_at(p, x, y)[0] / ((x1 - x0) * (y1 - y0));
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) most = fmax(most, fabs((double)pixel_at(p, x, y)[0] - mean));
    return most;
}

/* Squares of a hundredth: ten of them in a pixel, and more towards the horizon, in the middle of the picture. */
static void fine_checkers_are_grey(void **state) {
    VtsOptions o = options_of_size(64, 64);
    o.samples = 1;
    Picture p = bench_render(*state, &o,
                             "camera { location <0, 2, 0> direction z right x up y }\n"
                             "plane { y, 0 pigment { checker rgb 0 rgb 1 scale 0.003 } finish { ambient 1 diffuse 0 } }\n");
    assert_true(ripple(&p, 0, 33, 64, 60) < 0.03);
    picture_free(&p);
}

/* Seen in a mirroring ball a checkerboard shrinks by far more than the pixel's cone widens on the way. */
static void fine_checkers_in_mirrors_are_grey(void **state) {
    VtsOptions o = options_of_size(64, 64);
    static const char mirror[] = "camera { orthographic location <0, 0, -5> direction z right 0.9*x up 0.9*y }\n"
                                 "plane { -z, 30 pigment { checker rgb 0 rgb 1 scale 0.4 } finish { ambient 1 diffuse 0 } }\n"
                                 "sphere { 0, 1 pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection 1 } }\n";
    o.samples = 1;
    Picture p = bench_render(*state, &o, mirror);
    o.samples = 64;
    Picture truth = bench_render(*state, &o, mirror);
    /* One point a pixel would be black or white: 0.5 off. */
    assert_true(clamped_rms(&p, &truth) < 0.1);
    picture_free(&p);
    picture_free(&truth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_what_is_said),
        cmocka_unit_test(what_middles_miss_is_found),
        cmocka_unit_test(bumps_are_not_smoothed_away),
        cmocka_unit_test(threads_and_regions_do_not_change),
        cmocka_unit_test(fine_checkers_are_grey),
        cmocka_unit_test(fine_checkers_in_mirrors_are_grey),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
