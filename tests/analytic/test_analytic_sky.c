/* `sky_light on` on explicit objects: white things under an even sky, against closed forms. */
#include "analytic.h"
#include "open_sky.h"

#define WHITE "texture { pigment { rgb 1 } finish { ambient 0.8 diffuse 0 } }"
/* From above; what is in the way of the sky is not seen itself. */
#define ABOVE \
    "global_settings { ambient_light 1 sky_light on assumed_gamma 1 %s }\n" \
    "camera { orthographic location <0, 40, 0> direction -y sky z right x*8 up z*8 look_at 0 }\n" \
    "plane { y, 0 " WHITE " }\n"

static Picture picture_of(const Bench *b, const char *setting, const char *objects, bool exact) {
    static char text[8192];
    VtsOptions o = options_of_size(32, 32);
    o.reference_samples = 32;
    int n = snprintf(text, sizeof text, ABOVE, setting);
    snprintf(text + n, sizeof text - (size_t)n, "%s", objects);
    return bench_see(b, &o, text, exact);
}

static double x_of(int px) { return (px + 0.5) / 4 - 4; }

static const SkyCase CASES[] = {OPEN_SKY_CASES(WHITE)};

static double rms_error(const Picture *p, OpenSky truth, double *bias) {
    double squares = 0, sum = 0;
    int count = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            double expected = 0.8 * truth(x_of(x), -x_of(y));
            if (isnan(expected)) continue;
            double off = (double)pixel_at(p, x, y)[1] - expected;
            squares += off * off, sum += off, count++;
        }
    assert_true(count > 0);
    *bias = sum / count;
    return sqrt(squares / count);
}

static void sky_is_hidden_by_closed_forms(void **state) {
    int bad = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(CASES); i++) {
        double bias;
        Picture p = picture_of(*state, "", CASES[i].objects, false);
        double rms = rms_error(&p, CASES[i].truth, &bias);
        printf("%-10s rmse %.4f mean off by %+.4f\n", CASES[i].name, rms, bias);
        bad += rms > 2.0 / 255 || fabs(bias) > 1.5 / 255;
        picture_free(&p);
    }
    assert_int_equal(bad, 0);
}

static void reference_sees_the_same_sky(void **state) {
    int bad = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(CASES); i++) {
        double bias;
        Picture p = picture_of(*state, "", CASES[i].objects, true);
        rms_error(&p, CASES[i].truth, &bias);
        bad += fabs(bias) > 0.004;
        picture_free(&p);
    }
    assert_int_equal(bad, 0);
}

static void open_plane_is_as_bright_as_without(void **state) {
    Picture p = picture_of(*state, "", "", false);
    for (int i = 0; i < p.width * p.height * 3; i++) assert_float_equal(p.pixels[i], 0.8f, 1e-6f);
    picture_free(&p);
}

/* What is clear lets the sky through in its colour; what casts no shadow leaves all of it. */
static void clear_and_shadowless_things_let_the_sky_through(void **state) {
    Picture p = picture_of(*state, "", "plane { y, 1 no_image texture { pigment { rgbf <1, 0.5, 0, 1> } finish { ambient 0 diffuse 0 } } }", false);
    const float *seen = pixel_at(&p, 16, 16);
    assert_float_equal(seen[0], 0.8f, 0.01f);
    assert_float_equal(seen[1], 0.4f, 0.01f);
    assert_float_equal(seen[2], 0.0f, 0.01f);
    picture_free(&p);
    p = picture_of(*state, "", "plane { y, 1 no_image no_shadow " WHITE " }", false);
    assert_float_equal(pixel_at(&p, 16, 16)[0], 0.8f, 1e-6f);
    picture_free(&p);
}

/* Grass on soil before a wall: voxels, triangles and the reference agree on the mean. */
static void grass_and_house_agree_with_the_reference(void **state) {
    static const char scene[] =
        "global_settings { ambient_light 1 sky_light on assumed_gamma 1 %s }\n"
        "camera { location <3, 3.5, -8> look_at <0, 0.8, 0> right x*image_width/image_height angle 40 }\n"
        "light_source { <-2000, 2600, -1800>, rgb 0.5 parallel point_at 0 }\n"
        "#default { finish { ambient 0.4 diffuse 0.6 } }\n"
        "#declare S = seed(11);\n"
        "#declare T = texel { cyclic x + z layer { particles { count 16 { position <rand(S), 0, rand(S)> velocity <0.4*rand(S) - 0.2, 0.9, 0.4*rand(S) - 0.2>\n"
        "  acceleration <0.6*rand(S) - 0.3, -0.3, 0.6*rand(S) - 0.3> life 1 width 0.06, 0.004 profile \"flat\" } }\n"
        "  texture { pigment { rgb <0.3, 0.6, 0.1> } finish { diffuse 0.55, 0.35 } } } }\n"
        "#declare G = surface { patch_grid 20, 20 function(u, v) { <10*u - 5, 0, 10*v - 5> } };\n"
        "object { G texture { pigment { rgb <0.6, 0.5, 0.4> } } }\n"
        "skin { surface { G } texel { T } mapping { repeat <20, 20> height 0.5 } }\n"
        "box { <-2, 0, -1>, <2, 2, 1> pigment { rgb 0.85 } }\n"
        "box { <-2.5, 2, -1.5>, <2.5, 2.2, 1.5> pigment { rgb <0.6, 0.3, 0.2> } }\n";
    static const char *const details[] = {"detail auto", "detail exact", "detail voxels"};
    static char text[8192];
    VtsOptions o = options_of_size(48, 32);
    o.reference_samples = 48;
    double means[4];
    for (int i = 0; i < 4; i++) {
        const Bench *b = *state;
        snprintf(text, sizeof text, scene, details[i % 3]);
        bench_write(b, text);
        VtsSession *session = vts_session_create(&o, NULL);
        assert_int_equal(i == 3 ? vts_reference(session, b->scene, b->output) : vts_render(session, b->scene, b->output), VTS_OK);
        vts_session_destroy(session);
        Picture p = picture_read(b->output);
        means[i] = picture_mean(&p);
        picture_free(&p);
    }
    for (int i = 0; i < 3; i++) printf("%-14s %.4f of the reference\n", details[i], means[i] / means[3]);
    for (int i = 0; i < 3; i++) assert_true(fabs(means[i] / means[3] - 1) < 0.02);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sky_is_hidden_by_closed_forms),
        cmocka_unit_test(reference_sees_the_same_sky),
        cmocka_unit_test(open_plane_is_as_bright_as_without),
        cmocka_unit_test(clear_and_shadowless_things_let_the_sky_through),
        cmocka_unit_test(grass_and_house_agree_with_the_reference),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
