/* Further channels of a picture: what pixels see of things whose places are known. */
#include "analytic.h"

#include "image/image.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static Image render_exr(const Bench *b, VtsOptions *o, const char *channels, const char *text, bool reference) {
    char path[128];
    Image image;
    StrBuf error = {0};
    o->aovs = channels;
    o->float_type = "float";
    snprintf(path, sizeof path, "%s/picture.exr", b->folder);
    bench_write(b, text);
    VtsSession *session = vts_session_create(o, NULL);
    assert_non_null(session);
    assert_int_equal((reference ? vts_reference : vts_render)(session, b->scene, path), VTS_OK);
    vts_session_destroy(session);
    assert_true(image_load(&image, path, IMAGE_AS_STORED, NULL, &error));
    remove(path);
    strbuf_free(&error);
    return image;
}

static double value(const Image *image, const char *channel, int x, int y) {
    int c = image_channel(image, channel);
    assert_true(c >= 0);
    return (double)image_pixel(image, x, y)[c];
}

/* Seen from above, at height 5: a plate at height 1 over x > 0, the ground at 0 elsewhere, and beyond z = 2 nothing. */
static const char plates[] = LOOK_DOWN(5, 8) "light_source { <0, 100, 0> rgb 1 }\n"
                                             "box { <0, 0, -9>, <9, 1, 2> pigment { rgb <0.25, 0.5, 0.75> } }\n"
                                             "box { <-9, -1, -9>, <0, 0, 2> pigment { rgb <1, 0.5, 0> } }\n";

static void check_plates(const Image *p, double tolerance) {
    /* 32 pixels over 8 units: the pixel (16 + i, 16 - k) is the middle of <i/4, k/4> and 1/4 more. */
    assert_near(value(p, "depth", 24, 20), 4, tolerance);
    assert_near(value(p, "depth", 4, 20), 5, tolerance);
    assert_true(isinf(value(p, "depth", 24, 2)));
    assert_near(value(p, "normal.Y", 24, 20), 1, tolerance);
    assert_near(value(p, "normal.Y", 24, 2), 0, tolerance);
    assert_near(value(p, "albedo.G", 24, 20), 0.5, tolerance);
    assert_near(value(p, "albedo.B", 24, 20), 0.75, tolerance);
    assert_near(value(p, "albedo.R", 4, 20), 1, tolerance);
    assert_near(value(p, "position.X", 24, 20), 2.125, 0.1);
    assert_near(value(p, "position.Y", 24, 20), 1, tolerance);
    assert_near(value(p, "position.Z", 24, 20), -1.125, 0.1);
    assert_near(value(p, "alpha", 24, 20), 1, tolerance);
    assert_near(value(p, "alpha", 24, 2), 0, tolerance);
    assert_near(value(p, "texel_level", 24, 20), -1, tolerance);
    assert_true(value(p, "object", 24, 20) >= 1 && value(p, "object", 4, 20) >= 1);
    assert_true(value(p, "object", 24, 20) != value(p, "object", 4, 20));
    assert_near(value(p, "object", 24, 2), 0, 0);
    assert_true(value(p, "samples", 4, 20) >= 1);
}

static const char all_channels[] = "depth,normal,albedo,alpha,position,object,uv,texel_level,samples";

static void channels_tell_what_is_seen(void **state) {
    VtsOptions o = options_of_size(32, 32);
    Image p = render_exr(*state, &o, all_channels, plates, false);
    check_plates(&p, 1e-5);
    image_free(&p);
    o.reference_samples = 4;
    p = render_exr(*state, &o, all_channels, plates, true);
    check_plates(&p, 1e-5);
    image_free(&p);
}

/* An edge at x = 1/16: it crosses pixels a quarter of the way in, and the plate lies to its right. */
static void channels_are_filtered_as_colours(void **state) {
    VtsOptions o = options_of_size(32, 32);
    o.samples = 64;
    static const char edge[] = LOOK_DOWN(5, 8) "light_source { <0, 100, 0> rgb 1 }\n"
                                               "box { <0.0625, 0, -9>, <9, 1, 9> pigment { rgb <0.25, 0.5, 0.75> } }\n";
    Image p = render_exr(*state, &o, "albedo,depth,alpha,samples", edge, false);
    assert_near(value(&p, "alpha", 16, 10), 0.75, 0.02);
    assert_near(value(&p, "albedo.G", 16, 10), 0.375, 0.01);
    assert_near(value(&p, "depth", 16, 10), 4, 1e-5);
    assert_near(value(&p, "samples", 16, 10), 64, 0);
    assert_int_equal(image_channel(&p, "normal.X"), -1);
    image_free(&p);
}

static const char turf[] = "#declare Slab = texel { resolution 16 cyclic x + z layer { box { <0, 0, 0>, <1, 0.5, 1> }\n"
                           "  texture { pigment { rgb <0.2, 0.6, 0.4> } } } }\n"
                           "light_source { <0, 100, 0> rgb 1 }\n"
                           "#declare Ground = surface { patch_grid 2, 2 function(u, v) { <20*u - 10, 0, 20*v - 10> } }\n"
                           "skin { surface { Ground } texel { Slab } mapping { repeat <20, 20> height 1 } }\n" LOOK_DOWN(5, 8);

static void check_turf(const Bench *b, const char *settings, double tolerance) {
    VtsOptions o = options_of_size(32, 32);
    char text[2048];
    snprintf(text, sizeof text, "%s%s", settings, turf);
    Image p = render_exr(b, &o, "depth,albedo,normal,alpha,texel_level", text, false);
    assert_near(value(&p, "depth", 20, 11), 4.5, tolerance);
    assert_near(value(&p, "albedo.G", 20, 11), 0.6, 0.6 * tolerance);
    assert_near(value(&p, "alpha", 20, 11), 1, 0.01);
    assert_true(value(&p, "normal.Y", 20, 11) > 0.9);
    image_free(&p);
}

static void channels_tell_of_skins(void **state) {
    check_turf(*state, "global_settings { detail exact }\n", 0.01);
    check_turf(*state, "global_settings { detail voxels }\n", 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_tell_what_is_seen),
        cmocka_unit_test(channels_are_filtered_as_colours),
        cmocka_unit_test(channels_tell_of_skins),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
