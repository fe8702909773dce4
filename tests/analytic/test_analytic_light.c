/* Light in layers of texels seen from afar: its mean against the exact geometry's, sun and sky. */
#include "analytic.h"

#define GRASS \
    "#declare S = seed(11);\n" \
    "#declare T = texel { cyclic x + z layer { particles { count 16 { position <rand(S), 0, rand(S)> velocity <0.4*rand(S) - 0.2, 0.9, 0.4*rand(S) - 0.2>\n" \
    "  acceleration <0.6*rand(S) - 0.3, -0.3, 0.6*rand(S) - 0.3> life 1 width 0.06, 0.004 profile \"flat\" } }\n" \
    "  texture { pigment { rgb <0.3, 0.6, 0.1> } finish { ambient 0.1 diffuse 0.55, 0.35 } } } }\n"
#define LEAVES \
    "#declare S = seed(5);\n" \
    "#macro P() <rand(S) - 0.5, rand(S) - 0.5, rand(S) - 0.5> #end\n" \
    "#declare T = texel { layer { mesh { #for (I, 1, 300) #local C = <0.5, 0.5, 0.5> + 0.8*P(); triangle { C + 0.1*P(), C + 0.1*P(), C + 0.1*P() } #end }\n" \
    "  texture { pigment { rgb <0.3, 0.6, 0.1> } finish { ambient 0.1 diffuse 0.6, 0.3 } } } }\n"
/* Closed and thin: the side away from the eye is in the dark, whatever the finish lets through. */
#define STEMS \
    "#declare S = seed(8);\n" \
    "#declare T = texel { cyclic x + z layer { particles { count 60 { position <rand(S), 0, rand(S)> velocity <0.12*rand(S) - 0.06, 0.9, 0.12*rand(S) - 0.06>\n" \
    "  acceleration <0.2*rand(S) - 0.1, -0.1, 0.2*rand(S) - 0.1> life 0.95 width 0.012, 0.006 profile \"round\" } }\n" \
    "  texture { pigment { rgb <0.3, 0.6, 0.1> } finish { ambient 0 diffuse 0.55, 0.35 } } } }\n"
/* The camera sees nothing but the layer. */
#define FIELD \
    "global_settings { ambient_light %g %s }\n" \
    "camera { location <0, 4, -40> look_at <0, %g, 0> right x*image_width/image_height angle %g translate <0, %g, %g> }\n" \
    "light_source { <-2000, 2600, %g>, rgb %g parallel point_at 0 }\n" \
    "#declare G = surface { patch_grid 20, 20 function(u, v) { <80*u - 40, 0, 80*v - 40> } texture { pigment { rgb <0.11, 0.09, 0.05> } finish { diffuse 0.7 } } }\n" \
    "object { G }\n" \
    "skin { surface { G } texel { T } mapping { repeat <%g, %g> height %g } jitter { direction 0.2 height 0.2 instance { rotate 360 displace 0.3 } } }\n"

typedef struct LightCase {
    const char *name, *contents;
    double ambient;
    const char *setting;
    double look, angle, lift, back, sun_z, sun, repeat, height;
    double tolerance; /* of the mean */
} LightCase;

static double mean_of(const Bench *b, const char *text, bool exact) {
    VtsOptions o = options_of_size(32, 24);
    o.reference_samples = 24;
    return bench_mean(b, &o, text, exact);
}

static void mean_light_is_that_of_the_geometry(void **state) {
    static const LightCase cases[] = {
        {"grass, sun behind the viewer", GRASS, 1, "detail voxels", 0.5, 5, 0, 0, -1800, 1.5, 160, 0.9, .05},
        {"grass, sun before the viewer", GRASS, 1, "detail voxels", 0.5, 5, 0, 0, 2200, 1.5, 160, 0.9, .05},
        {"grass from above", GRASS, 1, "detail voxels", 0.5, 10, 36, 35, -1800, 1.5, 160, 0.9, .05},
        {"leaves, sun behind the viewer", LEAVES, 1, "detail voxels", 0.5, 5, 0, 0, -1800, 1.5, 40, 2, .05},
        {"leaves, sun before the viewer", LEAVES, 1, "detail voxels", 0.5, 5, 0, 0, 2200, 1.5, 40, 2, .05},
        {"leaves from above", LEAVES, 1, "detail voxels", 0.5, 10, 36, 35, -1800, 1.5, 40, 2, .05},
        {"stems, sun behind the viewer", STEMS, 1, "detail voxels", 0.5, 5, 0, 0, -1800, 1.5, 160, 0.9, .08},
        {"stems from above, sun before the viewer", STEMS, 1, "detail voxels", 0.5, 10, 36, 35, 2200, 1.5, 160, 0.9, .17},
        {"sky on grass from above", GRASS, 6, "detail voxels sky_light on", 0.5, 10, 36, 35, -1800, 0, 160, 0.9, .06},
        {"sky on leaves from above", LEAVES, 6, "detail voxels sky_light on", 0.5, 10, 36, 35, -1800, 0, 40, 2, .06},
        {"sky on grass seen flatly", GRASS, 6, "detail voxels sky_light on", 0.5, 5, 0, 0, -1800, 0, 160, 0.9, .12},
        {"sky on leaves seen flatly", LEAVES, 6, "detail voxels sky_light on", 0.5, 5, 0, 0, -1800, 0, 40, 2, .06},
    };
    static char text[8192];
    int bad = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        const LightCase *c = &cases[i];
        int n = snprintf(text, sizeof text, "%s", c->contents);
        snprintf(text + n, sizeof text - (size_t)n, FIELD, c->ambient, c->setting, c->look - c->lift, c->angle, c->lift, c->back, c->sun_z, c->sun,
                 c->repeat, c->repeat, c->height);
        double truth = mean_of(*state, text, true), got = mean_of(*state, text, false);
        printf("%-40s %.4f geometry %.4f ratio %.3f\n", c->name, got, truth, got / truth);
        assert_true(truth > 0.01);
        bad += fabs(got / truth - 1) > c->tolerance;
    }
    assert_int_equal(bad, 0);
}

/* The foot of the grass lies in its own shade: without sky_light all of it is alike. */
static void sky_light_darkens_what_stands_under_others(void **state) {
    static char text[8192];
    double mean[2];
    for (int on = 0; on < 2; on++) {
        int n = snprintf(text, sizeof text, "%s", GRASS);
        snprintf(text + n, sizeof text - (size_t)n, FIELD, 6.0, on ? "detail voxels sky_light on" : "detail voxels sky_light off", -35.5, 10.0, 36.0, 35.0, -1800.0, 0.0, 160.0, 160.0, 0.9);
        mean[on] = mean_of(*state, text, false);
    }
    assert_true(mean[1] < 0.8 * mean[0] && mean[1] > 0.2 * mean[0]);
}

/* With `detail exact` triangles ask for the sky as the reference does, by few directions, seen flatly too; else the voxels tell them. */
static void exact_geometry_sees_the_sky(void **state) {
    static const struct {
        const char *setting;
        double angle, lift, back, tolerance;
    } views[] = {{"detail exact", 5, 0, 0, .03}, {"detail exact", 10, 36, 35, .03}, {"detail auto", 5, 0, 0, .14}, {"detail auto", 10, 36, 35, .08}};
    static char text[8192];
    for (size_t i = 0; i < VTS_ARRAY_COUNT(views); i++) {
        char setting[64];
        snprintf(setting, sizeof setting, "%s sky_light on", views[i].setting);
        int n = snprintf(text, sizeof text, "%s", GRASS);
        snprintf(text + n, sizeof text - (size_t)n, FIELD, 6.0, setting, 0.5 - views[i].lift, views[i].angle, views[i].lift, views[i].back, -1800.0, 0.0, 160.0, 160.0, 0.9);
        double drawn = mean_of(*state, text, false), truth = mean_of(*state, text, true);
        printf("sky on grass, %s: %.4f of the reference\n", setting, drawn / truth);
        assert_true(fabs(drawn / truth - 1) < views[i].tolerance);
    }
}

/* Within a ball nothing hides a lamp. Beside skins a pixel of it is a piece of its tangent plane, which lies behind it. */
static void hollows_do_not_shadow_themselves(void **state) {
    static const char *const casts[] = {"", "no_shadow"};
    Picture p[2];
    for (int i = 0; i < 2; i++) {
        char text[2048];
        VtsOptions o = options_of_size(12, 9);
        o.samples = 16;
        snprintf(text, sizeof text, "global_settings { ambient_light 0 detail exact }\n%s"
                 "camera { location <0, 0.3, -0.4> look_at <0, -0.2, 1> right x*image_width/image_height angle 90 }\n"
                 "light_source { <0, 0.4, 0> rgb 1 }\n"
                 "sphere { 0, 1 pigment { rgb 1 } finish { diffuse 1 } %s }\n"
                 "#declare G = surface { patch_grid 2, 2 function(u, v) { <0.2*u - 0.1, -0.7, 0.3 + 0.2*v> } };\n"
                 "skin { surface { G } texel { T } mapping { repeat <4, 4> height 0.05 } }\n", GRASS, casts[i]);
        p[i] = bench_render(*state, &o, text);
    }
    for (int y = 0; y < 9; y++)
        for (int x = 0; x < 12; x++)
            if (fabsf(pixel_at(&p[0], x, y)[0] - pixel_at(&p[1], x, y)[0]) > 1e-6f)
                fail_msg("at %d, %d: %g, without shadows %g", x, y, (double)pixel_at(&p[0], x, y)[0], (double)pixel_at(&p[1], x, y)[0]);
    for (int i = 0; i < 2; i++) picture_free(&p[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_light_is_that_of_the_geometry),
        cmocka_unit_test(sky_light_darkens_what_stands_under_others),
        cmocka_unit_test(exact_geometry_sees_the_sky),
        cmocka_unit_test(hollows_do_not_shadow_themselves),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
