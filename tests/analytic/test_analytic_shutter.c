/* Pictures of what moves while they are exposed, against closed forms and brute force. */
#include "analytic.h"

#define BRIGHT "pigment { rgb 1 } finish { ambient 1 diffuse 0 }"

static VtsOptions exposed(double shutter) {
    VtsOptions o = options_of_size(48, 48);
    o.shutter_clock = o.shutter_time = shutter;
    return o;
}

/* The part of [0, 1] that [from, to] covers. */
static double covered(double from, double to) { return fmax(fmin(to, 1) - fmax(from, 0), 0); }

enum { PLACES = 64 };

/* A square of side 0.8 goes from x = -1 to x = 1: the time that it covers each pixel. */
static void moving_square(void **state) {
    VtsOptions o = exposed(1);
    Picture p = bench_render(*state, &o, LOOK_DOWN(5, 4) "box { <-0.4, 0, -0.4>, <0.4, 0.1, 0.4> translate (2*clock - 1)*x " BRIGHT " }");
    double squares = 0;
    for (int px = 0; px < 48; px++) {
        double mean = 0;
        for (int i = 0; i < PLACES; i++) {
            double x = (px + (i + 0.5) / PLACES) / 12 - 2;
            mean += covered((x - 0.4 + 1) / 2, (x + 0.4 + 1) / 2) / PLACES;
        }
        double error = (double)pixel_at(&p, px, 24)[0] - mean;
        squares += error * error;
        assert_true(fabs(error) < 0.02);
    }
    assert_true(sqrt(squares / 48) < 2.0 / 255);
    assert_true(pixel_at(&p, 24, 8)[0] == 0.0f);
    picture_free(&p);
}

/* A half plane turns by 90°: nothing is blended that a rotation does not pass. */
static void turning_half_plane(void **state) {
    enum { TIMES = 720 };
    VtsOptions o = exposed(1);
    Picture p = bench_render(*state, &o, LOOK_DOWN(5, 4) "box { <0, 0, -9>, <9, 0.1, 9> rotate 90*clock*y " BRIGHT " }");
    for (int py = 1; py < 48; py += 3)
        for (int px = 1; px < 48; px += 3) {
            double x = (px + 0.5) / 12 - 2, z = 2 - (py + 0.5) / 12, share = 0;
            if (hypot(x, z) < 0.3) continue;
            for (int i = 0; i < TIMES; i++) {
                Transform turn = transform_rotate(vec3(0, 90 * (i + 0.5) / TIMES, 0));
                share += transform_point(&turn, vec3(1, 0, 0)).x * x + transform_point(&turn, vec3(1, 0, 0)).z * z > 0;
            }
            assert_true(fabs((double)pixel_at(&p, px, py)[0] - share / TIMES) < 0.03);
        }
    picture_free(&p);
}

/* Light beyond all numbers is that, and not none. */
static void endless_light(void **state) {
    VtsOptions o = exposed(1);
    Picture p = bench_render(*state, &o, LOOK_DOWN(5, 4) "box { <-1, 0, -1>, <1, 0.1, 1> pigment { rgb 1e30 } finish { ambient 1e30 diffuse 0 } } sphere { <3*clock, 0, 3>, 0.1 pigment { rgb 0.5 } }");
    assert_true(isinf(pixel_at(&p, 24, 24)[0]));
    picture_free(&p);
}

/* What grows evenly has its mean. */
static void growing_light(void **state) {
    VtsOptions o = exposed(0.5);
    o.clock = 0.25;
    Picture p = bench_render(*state, &o, LOOK_DOWN(5, 4) "background { rgb <clock, 1 - clock, 0.5> }");
    assert_true(fabsf(pixel_at(&p, 7, 7)[0] - 0.5f) < 1e-6f);
    assert_true(fabsf(pixel_at(&p, 40, 7)[1] - 0.5f) < 1e-6f);
    picture_free(&p);
}

#define STILL                                                                                                  \
    LOOK_DOWN(5, 4) "light_source { <3, 9, 4>, rgb 1 }\n#declare R = seed(3);\n"                               \
    "#for (I, 1, 9) sphere { <2*rand(R) - 1, 0, 2*rand(R) - 1>, 0.4 pigment { rgb <rand(R), rand(R), 0.5> } } #end\n" \
    "#declare Blades = texel { cyclic x + z layer { object { cone { <0.5, 0, 0.5>, 0.2, <0.6, 1, 0.5>, 0 } } texture { pigment { rgb 0.7 } } } }\n" \
    "skin { surface { patch_grid 1, 1 function(u, v) { <4*u - 2, -1, 4*v - 2> } } texel { Blades } mapping { repeat <6, 6> height 0.3 } }\n"

/* What does not move is the same picture, bit for bit. */
static void still_scenes(void **state) {
    VtsOptions without = exposed(0), with = exposed(0.7);
    Picture a = bench_render(*state, &without, STILL), b = bench_render(*state, &with, STILL);
    assert_memory_equal(a.pixels, b.pixels, 3 * 48 * 48 * sizeof *a.pixels);
    picture_free(&a);
    picture_free(&b);
}

/* One shadow and one thing move, and the camera. */
#define MOVING                                                                                                                       \
    "camera { location <0, 2 + clock, -5> look_at 0 } light_source { <3*clock, 6, -3>, rgb 1 }\nplane { y, 0 pigment { rgb 0.6 } }\n" \
    "sphere { <1.2*clock, 0.7, 0>, 0.6 pigment { rgb <0.8, 0.3, 0.1> } }\n"

static void as_the_reference_has_it(void **state) {
    Bench *bench = *state;
    VtsOptions o = exposed(1);
    Picture drawn = bench_render(bench, &o, MOVING);
    o.reference_samples = 64;
    VtsSession *session = vts_session_create(&o, NULL);
    assert_int_equal(vts_reference(session, bench->scene, bench->output), VTS_OK);
    vts_session_destroy(session);
    Picture reference = picture_read(bench->output);
    Difference apart = picture_difference(&drawn, &reference);
    assert_true(apart.rms < 0.012); /* of which 64 random rays a pixel make 0.01 */
    assert_true(fabs(apart.mean) < 0.001);
    o.shutter_clock = o.shutter_time = 0;
    Picture sharp = bench_render(bench, &o, MOVING);
    assert_true(picture_difference(&sharp, &reference).rms > 3 * apart.rms);
    picture_free(&drawn);
    picture_free(&reference);
    picture_free(&sharp);
}

/* The same for any number of threads. */
static void threads_do_not_matter(void **state) {
    VtsOptions one = exposed(0.5), two = exposed(0.5);
    one.threads = 1;
    Picture a = bench_render(*state, &one, MOVING), b = bench_render(*state, &two, MOVING);
    assert_memory_equal(a.pixels, b.pixels, 3 * 48 * 48 * sizeof *a.pixels);
    picture_free(&a);
    picture_free(&b);
}

/* Blades that go by a pixel: what differs from moment to moment is mostly noise, and asks for no more of them. */
#define SWAYING                                                                                                                           \
    LOOK_DOWN(5, 4) "light_source { <3, 9, 4>, rgb 1 }\nglobal_settings { max_error 0.01 }\n#declare R = seed(3);\n"                      \
    "#declare Blades = texel { layer { mesh { #for (I, 1, 40) #local P = <rand(R), 0, rand(R)>;"                                           \
    " triangle { P, P + 0.2*x, P + <0.3*rand(R), 1, 0.3*rand(R)> } #end } texture { pigment { rgb <0.6, 0.7, 0.4> } finish { ambient 1 diffuse 0 } } } }\n"              \
    "skin { surface { patch_grid 4, 4 function(u, v) { <3*u - 1.5 + 0.1*clock, -1, 3*v - 1.5> } } texel { Blades } mapping { repeat <9, 9> height 0.3 } }\n"

static int moments_in(const char *report) {
    const char *at = strstr(report, "\"moments\":");
    return at ? atoi(at + strlen("\"moments\":")) : -1;
}

static void as_many_moments_as_tell_something(void **state) {
    enum { TIMES = 8 };
    Bench *bench = *state;
    VtsOptions o = exposed(1);
    bench_write(bench, SWAYING);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_int_equal(vts_render(session, bench->scene, bench->output), VTS_OK);
    int moments = moments_in(vts_report(session));
    assert_true(moments >= 3 && moments <= 9);
    vts_session_destroy(session);
    Picture blurred = picture_read(bench->output);
    double squares = 0, apart = 0;
    float mean[3 * 48 * 48] = {0};
    for (int i = 0; i < TIMES; i++) {
        VtsOptions sharp = exposed(0);
        sharp.clock = (i + 0.5) / TIMES;
        sharp.seed = (unsigned long long)i + 5;
        Picture p = bench_render(bench, &sharp, SWAYING);
        for (int k = 0; k < 3 * 48 * 48; k++) mean[k] += p.pixels[k] / TIMES;
        if (i == 0)
            for (int k = 0; k < 3 * 48 * 48; k++) apart += pow((double)(p.pixels[k] - blurred.pixels[k]), 2);
        picture_free(&p);
    }
    for (int k = 0; k < 3 * 48 * 48; k++) squares += pow((double)(mean[k] - blurred.pixels[k]), 2);
    assert_true(sqrt(squares / (3 * 48 * 48)) < 0.012);
    assert_true(squares < 0.25 * apart);
    picture_free(&blurred);
}

/* What is wrong at some moment alone is told, and there is no picture. */
static void wrong_later(void **state) {
    Bench *bench = *state;
    VtsOptions o = exposed(1);
    remove(bench->output);
    bench_write(bench, LOOK_DOWN(5, 4) "sphere { 0, 1 }\n#if (clock > 0.4) #error \"too late\" #end");
    VtsSession *session = vts_session_create(&o, NULL);
    assert_int_equal(vts_render(session, bench->scene, bench->output), VTS_ERROR_SCENE);
    assert_non_null(strstr(vts_diagnostics(session), "too late"));
    vts_session_destroy(session);
    assert_int_not_equal(access(bench->output, F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moving_square), cmocka_unit_test(turning_half_plane), cmocka_unit_test(growing_light), cmocka_unit_test(endless_light), cmocka_unit_test(still_scenes),
        cmocka_unit_test(as_the_reference_has_it), cmocka_unit_test(threads_do_not_matter), cmocka_unit_test(wrong_later),
        cmocka_unit_test(as_many_moments_as_tell_something),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
