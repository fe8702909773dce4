/* Sessions: threads, reports, limits and interruption of real renders. */
#include "analytic.h"

#include "../comma_locale.h"

#include <pthread.h>
#include <time.h>

/* A bit of everything: skin with jitter, solids, two lights, sky, fog. */
#define MEADOW \
    "#declare S = seed(3);\n" \
    "#declare Tuft = texel { resolution 32 cyclic x + z layer { particles { count 14 {\n" \
    "  position <rand(S), 0, rand(S)> velocity <0.3*rand(S)-0.15, 0.9, 0.3*rand(S)-0.15> acceleration <0, -0.2, 0.1> life 1\n" \
    "  width 0.06, 0.01 profile \"flat\" } } texture { pigment { rgb <0.2, 0.5, 0.1> } finish { diffuse 0.6, 0.3 } } } }\n" \
    "#declare Ball = texel { resolution 16 layer { sphere { <0.5, 0.5, 0.5>, 0.3 } texture { pigment { rgb x } } } }\n" \
    "camera { location <0, 2, -5> look_at <0, 0.4, 0> right x*image_width/image_height up y angle 50 }\n" \
    "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 }\n" \
    "light_source { <5, 4, -3> rgb <0.3, 0.2, 0.1> }\n" \
    "background { rgb <0.4, 0.5, 0.8> }\n" \
    "fog { distance 40 rgb <0.4, 0.5, 0.8> }\n" \
    "#declare Ground = surface { patch_grid 8, 8 function(u, v) { <8*u - 4, 0.3*sin(7*u)*cos(5*v), 8*v - 4> } }\n" \
    "object { Ground }\n" \
    "sphere { <0.5, 0.8, -1>, 0.5 }\n" \
    "skin { surface { Ground } texel { Tuft } texel { Ball density 0.3 } mapping { repeat <12, 12> height 0.5 }\n" \
    "  jitter { direction 0.2 scale 0.8 height 0.3 scale 2 instance { rotate 360 displace 0.4 scale 0.3 mirror } seed 4 } }\n"
static const char meadow[] = MEADOW;
static const char voxel_meadow[] = "global_settings { detail voxels }\n" MEADOW;

static void threads_do_not_change(void **state, const char *scene) {
    VtsOptions o = options_of_size(70, 50);
    static const int threads[] = {1, 2, 5};
    Picture first = {0};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(threads); i++) {
        o.threads = threads[i];
        Picture p = bench_render(*state, &o, scene);
        if (i) {
            assert_memory_equal(p.pixels, first.pixels, 3 * sizeof(float) * 70 * 50);
            picture_free(&p);
        } else {
            first = p;
        }
    }
    for (size_t i = 0; i < 3 * 70 * 50; i++) assert_true(isfinite(first.pixels[i]) && first.pixels[i] >= 0 && first.pixels[i] < 20);
    const int region[4] = {17, 23, 60, 49};
    memcpy(o.region, region, sizeof region);
    Picture part = bench_render(*state, &o, scene);
    for (int y = 0; y < part.height; y++)
        assert_memory_equal(pixel_at(&part, 0, y), pixel_at(&first, 17, y + 23), 3 * sizeof(float) * 43);
    picture_free(&part);
    picture_free(&first);
}

static void threads_do_not_change_pixels(void **state) {
    threads_do_not_change(state, meadow);
    threads_do_not_change(state, voxel_meadow);
}

/* ---- the report ---- */

static double number_of(const char *text, const char *key) {
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    return number_after(text, quoted);
}

/* Within a session, texels are built once. */
static void texels_are_kept_from_call_to_call(void **state) {
    const Bench *b = *state;
    VtsOptions o = options_of_size(40, 30);
    bench_write(b, voxel_meadow);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    assert_null(strstr(vts_report(session), "\"cached\":true"));
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    assert_non_null(strstr(vts_report(session), "\"cached\":true"));
    assert_null(strstr(vts_report(session), "\"cached\":false"));
    assert_int_equal(vts_check(session, b->scene), VTS_OK); /* asks for none: they are let go */
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    assert_null(strstr(vts_report(session), "\"cached\":true"));
    vts_session_destroy(session);
}

static void the_report_counts_what_was_done(void **state) {
    const Bench *b = *state;
    VtsOptions o = options_of_size(70, 50);
    bench_write(b, voxel_meadow);
    VtsSession *session = vts_session_create(&o, NULL);
    assert_string_equal(vts_report(session), "");
    assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
    const char *r = vts_report(session);
    assert_true(number_of(r, "camera") >= 3500 && number_of(r, "camera") <= 3500 * 17);
    assert_true(number_of(r, "shadow") > 100 && number_of(r, "shadow") < 1e7);
    assert_true(number_of(r, "voxels_visited") > 1000);
    assert_true(number_of(r, "march_steps") > 1000);
    assert_true(number_of(r, "split_pixels") > 0 && number_of(r, "split_pixels") < 3500);
    double wall = number_of(r, "wall_s"), parts = number_of(r, "parse_s") + number_of(r, "build_s") + number_of(r, "render_s");
    assert_true(parts > 0 && parts <= wall * 1.001 + .001);
    assert_true(number_of(r, "peak_rss_bytes") > 1e6 && number_of(r, "peak_rss_bytes") < 1e11);
    assert_non_null(strstr(r, "\"name\":\"Tuft\""));
    assert_non_null(strstr(r, "\"name\":\"Ball\""));
    assert_true(number_of(r, "built") == 32 || number_of(r, "built") == 16 || number_of(r, "built") == 8);
    assert_true(number_of(r, "bytes") > 0);
    vts_session_destroy(session);
}

/* What the report expects of the error is what it is, to a factor of two, and max_error is kept: against pictures of many samples and
 * another seed, of scenes that the estimate was not tuned with. */
static void the_error_is_as_expected(void **state) {
    static const char hair[] =
        "camera { location <0, 0.7, -3> look_at <0, 0, 0> right x up y angle 45 }\n"
        "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 }\n"
        "#declare S = seed(8);\n"
        "#declare Hair = texel { cyclic x + z layer { particles { count 20 { position <rand(S), 0, rand(S)>\n"
        "  velocity <0.4*rand(S)-0.2, 1, 0.4*rand(S)-0.2> acceleration <0.3, -0.3, 0> life 0.9 width 0.05, 0.01 } }\n"
        "  texture { pigment { rgb <0.6, 0.4, 0.2> } finish { diffuse 0.8 specular 0.3 } } } }\n"
        "skin { surface { sphere { 0, 1 } } texel { Hair } mapping { repeat <30, 15> height 0.3 } jitter { direction 0.4 scale 0.3 seed 2 } }\n"
        "sphere { 0, 1 }\n";
    static const char *const scenes[] = {meadow, hair};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(scenes); k++) {
        VtsOptions o = options_of_size(64, 64);
        o.samples = 256;
        o.seed = 77;
        Picture truth = bench_render(*state, &o, scenes[k]);
        static const struct { int samples; double max_error; } cases[] = {{4, 0}, {12, 0}, {0, .03}, {0, .01}};
        for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
            o = options_of_size(64, 64);
            o.samples = cases[i].samples;
            o.max_error = cases[i].max_error;
            const Bench *b = *state;
            bench_write(b, scenes[k]);
            VtsSession *session = vts_session_create(&o, NULL);
            assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
            double expected = number_of(vts_report(session), "error_estimate");
            vts_session_destroy(session);
            Picture p = picture_read(b->output);
            double rms = picture_difference(&truth, &p).rms;
            picture_free(&p);
            printf("%d samples, max_error %g: RMSE %.4f, expected %.4f\n", cases[i].samples, cases[i].max_error, rms, expected);
            assert_true(expected > rms / 2 && expected < rms * 2);
            assert_true(cases[i].samples || rms < 1.3 * cases[i].max_error);
        }
        picture_free(&truth);
    }
}

/* Tiles of sky are the sky's, in however many passes the others are drawn. */
static void sky_is_sky_with_many_samples(void **state) {
    static const char hair[] =
        "camera { location <0, 0, -9> look_at <0, 0, 0> right x up y angle 60 }\nlight_source { <-20, 30, -25> rgb 1 }\nbackground { rgb <0.25, 0.5, 0.75> }\n"
        "skin { surface { sphere { 0, 1 } } texel { texel { layer { cone { <0.5, 0, 0.5>, 0.3, <0.5, 1, 0.5>, 0 } } } } mapping { repeat <12, 6> height 0.3 } }\n";
    VtsOptions o = options_of_size(128, 128);
    o.samples = 70;
    Picture p = bench_render(*state, &o, hair);
    for (int y = 0; y < 128; y++)
        for (int x = 0; x < 128; x++) {
            const float *c = pixel_at(&p, x, y);
            if (hypot(x - 63.5, y - 63.5) > 40) assert_true(fabsf(c[0] - .25f) + fabsf(c[1] - .5f) + fabsf(c[2] - .75f) < 1e-5f);
        }
    picture_free(&p);
}

/* ---- limits ---- */

/* Whatever the limit cuts short, the session ends well and another one works. */
static void memory_runs_out_anywhere_without_harm(void **state) {
    VtsOptions o = options_of_size(40, 30);
    int refused = 0, done = 0;
    remove(((const Bench *)*state)->output);
    for (size_t limit = 1 << 16; limit < (size_t)1 << 29; limit += limit / 2) {
        o.memory_limit = limit;
        bench_write(*state, meadow);
        const Bench *b = *state;
        VtsSession *session = vts_session_create(&o, NULL);
        if (!session) {
            refused++;
            continue;
        }
        VtsStatus status = vts_render(session, b->scene, b->output);
        if (status != VTS_OK) {
            assert_int_equal(status, VTS_ERROR_MEMORY);
            assert_non_null(strstr(vts_diagnostics(session), "memory limit"));
            assert_true(access(b->output, F_OK) != 0);
            refused++;
            assert_int_equal(vts_check(session, b->scene) == VTS_OK || limit < 1 << 22, true); /* the session is still of use */
        } else {
            done++;
            remove(b->output);
        }
        vts_session_destroy(session);
    }
    printf("%d limits too small, %d sufficient\n", refused, done);
    assert_true(refused > 5 && done > 2);
}

/* ---- interruption ---- */

typedef struct Interrupter {
    VtsSession *session;
    long nanoseconds;
} Interrupter;

static void *interrupt_later(void *argument) {
    Interrupter *i = argument;
    struct timespec wait = {0, i->nanoseconds};
    nanosleep(&wait, NULL);
    vts_interrupt(i->session);
    return NULL;
}

static void interrupt_renders(const Bench *b, VtsOptions o, const char *scene) {
    bench_write(b, scene);
    remove(b->output);
    static const long after[] = {100000, 20000000, 150000000};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(after); i++) {
        Interrupter other = {vts_session_create(&o, NULL), after[i]};
        pthread_t thread;
        assert_int_equal(pthread_create(&thread, NULL, interrupt_later, &other), 0);
        assert_int_equal(vts_render(other.session, b->scene, b->output), VTS_INTERRUPTED);
        pthread_join(thread, NULL);
        assert_int_not_equal(access(b->output, F_OK), 0);
        vts_session_destroy(other.session);
    }
}

static void interruption_from_another_thread(void **state) {
    interrupt_renders(*state, options_of_size(4000, 4000), meadow); /* minutes, if it went on */
}

/* Each tile of the picture is minutes of work by itself. */
static void interruption_within_a_tile(void **state) {
    const VtsPair exact = {"detail", "exact"};
    VtsOptions o = options_of_size(40, 30);
    o.settings = &exact, o.setting_count = 1;
    interrupt_renders(*state, o,
                      "camera { location <0, 300, -9000> look_at 0 angle 60 right x*image_width/image_height }\n"
                      "#declare Blades = texel { cyclic x + z layer { triangle { <0.2, 0, 0.3>, <0.3, 0, 0.3>, <0.2, 1, 0.4> } } }\n"
                      "#declare Land = surface { patch_grid 1, 1 function(u, v) { <90000*(u - 0.5), 0, 90000*(v - 0.5)> } }\n"
                      "skin { surface { Land } texel { Blades } mapping { repeat <90000, 90000> height 0.5 } }\n");
}

/* ---- alpha ---- */

static void alpha_is_coverage(void **state) {
    const Bench *b = *state;
    char path[128];
    snprintf(path, sizeof path, "%s/picture.tif", b->folder);
    VtsOptions o = options_of_size(32, 32);
    o.alpha = true;
    bench_write(b,
        "camera { orthographic location <0,0,-5> direction z right 2*x up 2*y }\n"
        "background { rgb <0.3, 0.6, 0.9> }\n"
        "sphere { 0, 0.7 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }\n");
    VtsSession *session = vts_session_create(&o, NULL);
    assert_int_equal(vts_render(session, b->scene, path), VTS_OK);
    vts_session_destroy(session);
    assert_int_equal(access(path, F_OK), 0);
    remove(path);
}

/* Long numbers, with exponents, of strings, of options, of settings and formulas, and those that are written. */
static void a_locale_with_commas_changes_nothing(void **state) {
    static const char scene[] =
        "#macro Same(A, B) #if (abs(A/B - 1) > 1e-12) #error concat(\"not \", str(B, 0, 6)) #end #end\n"
        "Same(3.14159265358979323846, pi) Same(1.5e-1, 3/20) Same(val(\"2.5\"), 5/2) Same(val(str(0.125, 0, 3)), 1/8) Same(Given, 9/4)\n"
        "#if (strcmp(str(2.25, 0, 3), \"2.250\") != 0) #error str(2.25, 0, 3) #end\n"
        "camera { location 0 look_at z }\n"
        "background { rgb <0.2500000000000000000001, 0.5, 0.75> }\n"
        "#declare L = lsystem { axiom \"F(0.500000000000000000001)\" iterations 0 }\n"
        "object { L translate <-0.1, 5, 9> }\n";
    VtsOptions o = options_of_size(4, 3);
    o.declares = &(VtsPair){"Given", "2.25"}, o.declare_count = 1;
    CommaLocale locale;
    comma_locale_begin(&locale);
    VtsStatus status = bench_try(*state, &o, scene);
    comma_locale_end(&locale);
    assert_int_equal(status, VTS_OK);
    Picture p = picture_read(((const Bench *)*state)->output);
    const float *pixel = pixel_at(&p, 1, 1);
    assert_true(pixel[0] == 0.25f && pixel[1] == 0.5f && pixel[2] == 0.75f);
    picture_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_do_not_change_pixels),
        cmocka_unit_test(texels_are_kept_from_call_to_call),
        cmocka_unit_test(the_report_counts_what_was_done),
        cmocka_unit_test(the_error_is_as_expected),
        cmocka_unit_test(sky_is_sky_with_many_samples),
        cmocka_unit_test(memory_runs_out_anywhere_without_harm),
        cmocka_unit_test(interruption_from_another_thread),
        cmocka_unit_test(interruption_within_a_tile),
        cmocka_unit_test(alpha_is_coverage),
        cmocka_unit_test(a_locale_with_commas_changes_nothing),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
