/* Mirrors, glass and layers, in scenes where every pixel is known. */
#include "analytic.h"

#define LOOK_AT_THE_ORIGIN "camera { orthographic location <0, 0, -1> direction z right x up y }\n#default { finish { ambient 0 diffuse 0 } }\n"

static VtsOptions small(void) {
    VtsOptions o = options_of_size(4, 4);
    o.threads = 1;
    return o;
}

static void check(Bench *bench, const char *scene, double red, double green, double blue, double within) {
    VtsOptions o = small();
    char text[2048];
    snprintf(text, sizeof text, LOOK_AT_THE_ORIGIN "%s", scene);
    Picture p = bench_render(bench, &o, text);
    const float *seen = pixel_at(&p, 1, 1);
    const double want[3] = {red, green, blue};
    for (int k = 0; k < 3; k++) {
        if (fabs((double)seen[k] - want[k]) > within) printf("channel %d is %g, not %g: %s\n", k, (double)seen[k], want[k], scene);
        assert_true(fabs((double)seen[k] - want[k]) <= within);
    }
    picture_free(&p);
}

/* Two mirrors that glow a little: e (1 + r + r² + …), as many terms as there are legs. */
static void mirrors_see_each_other(void **state) {
    static const int levels[] = {1, 2, 5, 20};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(levels); i++) {
        char scene[512];
        double r = 0.8, e = 0.1, sum = e * (1 - pow(r, levels[i])) / (1 - r);
        snprintf(scene, sizeof scene,
                 "global_settings { max_trace_level %d adc_bailout 0 }\n"
                 "plane { z, 0 pigment { rgb 1 } finish { emission 0.1 reflection 0.8 } }\n"
                 "plane { z, -2 pigment { rgb 1 } finish { emission 0.1 reflection 0.8 } }\n", levels[i]);
        check(*state, scene, sum, sum, sum, 1e-5);
    }
}

#define LAMP "plane { z, 3 inverse pigment { rgb <0.2, 0.4, 0.6> } finish { emission 1 } }\n"

/* A clear leg counts as none: through a hundred panes something is still seen. */
static void panes_multiply(void **state) {
    double left = pow(0.99, 100);
    check(*state, LAMP "#for (K, 1, 100) disc { z*K/100, z, 2 pigment { rgbt <1, 1, 1, 0.99> } } #end\n", 0.2 * left, 0.4 * left, 0.6 * left, 1e-4);
}

/* Filter is tinted, transmit is not; a layer hides by what it does not let through. */
static void layers_let_through(void **state) {
    check(*state, LAMP "disc { 0, z, 2 pigment { rgbf <1, 0.5, 0, 0.5> } }", 0.1, 0.1, 0, 1e-5);
    check(*state, LAMP "disc { 0, z, 2 pigment { rgbft <1, 0.5, 0, 0.5, 0.2> } finish { emission 1 } }",
          0.2 * 0.7 + 0.3, 0.4 * 0.45 + 0.15, 0.6 * 0.2, 1e-5);
    check(*state, "disc { 0, z, 2 texture { pigment { rgb 1 } finish { emission 1 } } texture { pigment { rgbf <1, 0.5, 0.2, 0.5> } finish { emission 1 } } }",
          1, 0.5, 0.2, 1e-5);
}

/* Straight on, glass of index 1.5 mirrors 4 % at each side; fresnel goes from black to the one colour that is given. */
static void glass_mirrors_four_percent(void **state) {
    check(*state, "plane { -z, 2 pigment { rgb 1 } finish { emission 1 } }\n"
                  "plane { z, 0 inverse pigment { rgb 0 } finish { reflection { 1 fresnel } } interior { ior 1.5 } }", 0.04, 0.04, 0.04, 1e-5);
}

/* A box of depth 2 whose light halves every fade_distance 2, and by Beer's law. */
static void interiors_fade(void **state) {
    check(*state, LAMP "box { <-2, -2, 0>, <2, 2, 2> pigment { rgbt 1 } interior { ior 1.4 fade_distance 2 fade_power 1 } }", 0.1, 0.2, 0.3, 1e-5);
    check(*state, LAMP "box { <-2, -2, 0>, <2, 2, 2> pigment { rgbt 1 } interior { fade_distance 2 fade_power 1000 fade_color rgb <1, 0.5, 0> } }",
          0.2, 0.4 * exp(-0.5), 0.6 * exp(-1), 1e-5);
}

/* Shadows of coloured glass are coloured. */
static void shadows_have_colours(void **state) {
    check(*state, "light_source { <0, 0, -100> rgb 1 parallel point_at 0 }\n"
                  "disc { -2*z, z, 1 pigment { rgbft <1, 0.5, 0, 0.5, 0.25> } no_image }\n"
                  "plane { z, 0 inverse pigment { rgb 1 } finish { diffuse 1 } }", 0.75, 0.5, 0.25, 1e-5);
}

/* What is hidden from mirrors is not in them, what is hidden from the eye is. */
static void objects_hide_from_rays(void **state) {
    static const char mirror[] = "plane { z, 0 inverse pigment { rgb 0 } finish { reflection 1 } }\nbackground { rgb 0.25 }\n";
    char scene[512];
    snprintf(scene, sizeof scene, "%sdisc { -2*z, z, 1 pigment { rgb <1, 0, 0> } finish { emission 1 } no_image }", mirror);
    check(*state, scene, 1, 0, 0, 1e-5);
    snprintf(scene, sizeof scene, "%sdisc { -2*z, z, 1 pigment { rgb <1, 0, 0> } finish { emission 1 } no_reflection }", mirror);
    check(*state, scene, 0.25, 0.25, 0.25, 1e-5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_see_each_other), cmocka_unit_test(panes_multiply),       cmocka_unit_test(layers_let_through),
        cmocka_unit_test(glass_mirrors_four_percent), cmocka_unit_test(interiors_fade),   cmocka_unit_test(shadows_have_colours),
        cmocka_unit_test(objects_hide_from_rays),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
