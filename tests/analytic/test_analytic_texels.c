/* Texels on skins: pictures against the same matter as explicit geometry, at all distances, places and scales. */
#include "analytic.h"

/* ---- transmittance ---- */

/* Black leaves over a white ground: the mean of the picture is the share of the ground that is seen. */
#define LEAVES \
    "#declare S = seed(5);\n" \
    "#macro Corner(C) triangle { C + 0.1*<rand(S) - 0.5, rand(S) - 0.5, rand(S) - 0.5>, C + 0.1*<rand(S) - 0.5, rand(S) - 0.5, rand(S) - 0.5>," \
    " C + 0.1*<rand(S) - 0.5, rand(S) - 0.5, rand(S) - 0.5> } #end\n" \
    "#declare Leaves = mesh { #for (I, 1, 400) Corner(<0.1 + 0.8*rand(S), 0.1 + 0.8*rand(S), 0.1 + 0.8*rand(S)>) #end }\n" \
    "#declare Black = texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } }\n" \
    "plane { y, -0.01 texture { pigment { rgb 1 } finish { ambient 1 diffuse 0 } } }\n"

static const char explicit_leaves[] = LEAVES
    "camera { orthographic location <0, 5, 0> direction <%g, -1, %g> right 1*x up 1*z }\n"
    "#for (I, -4, 4) #for (J, -4, 4) object { Leaves translate <I, 0, J> texture { Black } } #end #end\n";
/* Voxels alone: of the exact geometry there is nothing to be proven here. */
#define VOXELS "global_settings { detail voxels }\n"

static const char leaves_on_a_skin[] = VOXELS LEAVES
    "camera { orthographic location <0, 5, 0> direction <%g, -1, %g> right %g*x up %g*z }\n"
    "#declare T = texel { resolution 64 %s layer { object { Leaves } texture { Black } } }\n"
    "skin { surface { surface { patch_grid 8, 8 function(u, v) { <128*(u - 0.5), 0, 128*(v - 0.5)> } } } texel { T }\n"
    "  mapping { repeat <128, 128> height 1 } }\n";

static void leaves_hide_as_much_at_all_distances(void **state) {
    static const struct { double side; int pixels; double tolerance; } views[] = {
        {1, 64, .035}, {4, 64, .035}, {8, 32, .04}, {8, 8, .07}, {64, 8, .03}}; /* tiles across, pixels */
    static const double slants[][2] = {{0, 0}, {.5, .25}};
    char scene[4096];
    for (size_t k = 0; k < VTS_ARRAY_COUNT(slants); k++) {
        VtsOptions o = options_of_size(96, 96);
        o.samples = 2;
        snprintf(scene, sizeof scene, explicit_leaves, slants[k][0], slants[k][1]);
        Picture p = bench_render(*state, &o, scene);
        double truth = picture_mean(&p);
        picture_free(&p);
        assert_true(truth > .2 && truth < .9);
        for (int cyclic = 0; cyclic < 2; cyclic++) {
            printf("slant %.2f %s: geometry %.3f, skins", slants[k][0], cyclic ? "cyclic" : "copies", truth);
            for (size_t v = 0; v < VTS_ARRAY_COUNT(views); v++) {
                o = options_of_size(views[v].pixels, views[v].pixels);
                snprintf(scene, sizeof scene, leaves_on_a_skin, slants[k][0], slants[k][1], views[v].side, views[v].side, cyclic ? "cyclic x + z" : "");
                p = bench_render(*state, &o, scene);
                double got = picture_mean(&p);
                printf("  %.3f", got);
                assert_true(fabs(got - truth) < views[v].tolerance);
                picture_free(&p);
            }
            printf("\n");
        }
    }
}

/* A solid ball in a texel, shining, is seen as its disc. */
static void a_ball_in_a_texel_covers_its_disc(void **state) {
    static const char text[] =
        VOXELS "camera { orthographic location <0, 5, 0> direction <0, -1, 0> right 4*x up 4*z }\n"
        "#declare T = texel { resolution 64 layer { sphere { <0.5, 0.5, 0.5>, 0.37 } texture { pigment { rgb 1 } finish { ambient 1 diffuse 0 } } } }\n"
        "skin { surface { surface { patch_grid 4, 4 function(u, v) { <8*(u - 0.5), 0, 8*(v - 0.5)> } } } texel { T } mapping { repeat <8, 8> height 1 } }\n";
    static const struct { int pixels; double tolerance; } views[] = {{256, .015}, {128, .015}, {64, .025}, {32, .025}};
    for (size_t v = 0; v < VTS_ARRAY_COUNT(views); v++) {
        VtsOptions o = options_of_size(views[v].pixels, views[v].pixels);
        Picture p = bench_render(*state, &o, text);
        double got = picture_mean(&p), exact = VTS_PI * .37 * .37;
        printf("%d pixels a tile: area %.4f, exact %.4f\n", views[v].pixels / 4, got, exact);
        assert_true(fabs(got / exact - 1) < views[v].tolerance);
        picture_free(&p);
    }
}

/* ---- place and scale ---- */

static const char hill[] =
    VOXELS "#declare T = transform { scale %g translate <%g, %g, %g> }\n"
    "#declare S = seed(3);\n"
    "#declare Tuft = texel { resolution 32 cyclic x + z layer { particles { count 14 {\n"
    "  position <rand(S), 0, rand(S)> velocity <0.3*rand(S)-0.15, 0.9, 0.3*rand(S)-0.15> acceleration <0, -0.2, 0.1> life 1\n"
    "  width 0.06, 0.01 profile \"flat\" } } texture { pigment { rgb <0.2, 0.5, 0.1> } finish { diffuse 0.6, 0.3 } } } }\n"
    "camera { location <0, 2, -5> look_at <0, 0.4, 0> right x up y angle 50 transform { T } }\n"
    "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 transform { T } }\n"
    "background { rgb <0.4, 0.5, 0.8> }\n"
    "#declare Ground = surface { patch_grid 6, 6 function(u, v) { <8*u - 4, 0.3*sin(7*u)*cos(5*v), 8*v - 4> } transform { T } }\n"
    "object { Ground }\n"
    "skin { surface { Ground } texel { Tuft } mapping { repeat <12, 12> height %g } }\n";

static void place_and_scale_do_not_matter(void **state) {
    static const struct { double scale, x, y, z, rms; } cases[] = {{1, 1e5, -2e5, 1e5, .01}, {1e3, 0, 0, 0, .01}, {1e-3, 0, 0, 0, .03}};
    VtsOptions o = options_of_size(64, 64);
    char scene[4096];
    snprintf(scene, sizeof scene, hill, 1.0, 0.0, 0.0, 0.0, .5);
    Picture plain = bench_render(*state, &o, scene);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        snprintf(scene, sizeof scene, hill, cases[i].scale, cases[i].x, cases[i].y, cases[i].z, .5 * cases[i].scale);
        Picture other = bench_render(*state, &o, scene);
        Difference d = picture_difference(&plain, &other);
        printf("scale %g at <%g, %g, %g>: mean %+.1e rms %.1e most %.1e\n", cases[i].scale, cases[i].x, cases[i].y, cases[i].z, d.mean, d.rms, d.most);
        assert_true(d.rms < cases[i].rms && fabs(d.mean) < .005);
        picture_free(&other);
    }
    picture_free(&plain);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaves_hide_as_much_at_all_distances),
        cmocka_unit_test(a_ball_in_a_texel_covers_its_disc),
        cmocka_unit_test(place_and_scale_do_not_matter),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
