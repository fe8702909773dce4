/* Where methods for volumes fail: sharp phase functions, albedos 0 and 1, hardly any and very much matter, grids of one cell or of none, rays along the walls of cells, lamps within. */
#include "stability.h"

#include <unistd.h>

#define CAMERA "camera { location <0, 0.4, -5> look_at 0 angle 40 right x*image_width/image_height }\nlight_source { <30, 50, -20>, rgb 1 parallel point_at 0 }\n"

/* Whatever it is: numbers, none negative, none beyond `most`. */
static Picture drawn(const Bench *b, const char *scene, double most) {
    static char text[4096];
    VtsOptions o = options_of_size(12, 9);
    snprintf(text, sizeof text, "global_settings { assumed_gamma 1 }\n%s", scene);
    Picture p = bench_render(b, &o, text);
    for (int i = 0; i < 3 * 12 * 9; i++)
        if (!(p.pixels[i] >= 0 && (double)p.pixels[i] <= most)) fail_msg("%g in %s", (double)p.pixels[i], scene);
    return p;
}

static void draw_with(const Bench *b, const char *format, const char *what, double most) {
    char scene[2048];
    snprintf(scene, sizeof scene, format, what);
    Picture p = drawn(b, scene, most);
    picture_free(&p);
}

static void sharp_phases_stay_finite(void **state) {
    static const char *const phases[] = {"henyey_greenstein 0.9999", "henyey_greenstein -0.9999", "schlick 0.9999", "schlick -0.9999",
                                         "sum { 1 phase { henyey_greenstein 0.99 } 1 phase { henyey_greenstein -0.99 } }", "henyey_greenstein 0.0000001"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(phases); i++)
        draw_with(*state, CAMERA "volume { box { -1, 1 } scattering rgb 2 rays 500 phase { %s } }", phases[i], 1e6);
}

/* With albedo 0 nothing is sent; from no matter to what nothing passes. */
static void depths_from_none_to_all(void **state) {
    static const char *const depths[] = {"1e-6", "1", "1e4"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(depths); i++) {
        draw_with(*state, CAMERA "background { rgb 0 }\nvolume { box { -1, 1 } scattering rgb %s rays 100 }", depths[i], 4);
        draw_with(*state, CAMERA "background { rgb 0 }\nvolume { box { -1, 1 } absorption rgb %s rays 300 }", depths[i], 0);
    }
}

static void grids_of_one_cell_and_of_none(void **state) {
    draw_with(*state, CAMERA "volume { box { -1, 1 } density { function { %s } } scattering rgb 2 step 9 rays 2000 }", "0.5", 2);
    draw_with(*state, CAMERA "background { rgb 0 }\nvolume { box { -1, 1 } density { function { %s } } scattering rgb 2 }", "0", 0);
    draw_with(*state, CAMERA "background { rgb 0 }\nvolume { box { -1, 1 } density { function { %s } } scattering rgb 2 }", "-1", 0);
    draw_with(*state, CAMERA "volume { box { -1, 1 } density { function { %s } } scattering rgb 2 rays 2000 step 0.5 }", "x > 0", 2);
}

/* A 64th of a grid of 512 x 512 numbers is filled: what the rest would take does not fit into memory, and its pattern is seen as it is. */
static void pieces_of_grids_cost_what_they_hold(void **state) {
    const Bench *b = *state;
    static unsigned char file[6 + 512 * 512] = {2, 0, 2, 0, 0, 1};
    char path[512], text[1024];
    for (int i = 0; i < 512 * 512; i++) file[6 + i] = (i / 4 + i / 512 / 4) % 2 ? 255 : 0;
    snprintf(path, sizeof path, "%s/waves.df3", b->folder);
    FILE *f = fopen(path, "wb");
    assert_true(f && fwrite(file, sizeof file, 1, f) == 1 && fclose(f) == 0);
    snprintf(text, sizeof text, CAMERA "volume { box { -1, 1 } density { df3 \"%s\" translate -0.5 scale 64 } scattering 2 rays 2000 }", path);
    VtsOptions o = options_of_size(12, 9);
    o.memory_limit = (size_t)96 << 20;
    Picture p = bench_render(b, &o, text);
    assert_true(picture_mean(&p) > 0.05);
    picture_free(&p);
    unlink(path);
}

/* The camera in the middle of cells' walls, looking along them: as bright as a little beside. */
static void rays_along_walls_are_as_others(void **state) {
    static const char scene[] = "camera { orthographic location <%s, -5> look_at <%s, 0> right 0.001*x up 0.001*y }\nlight_source { -100*z, rgb 1 parallel point_at 0 }\n"
                                "volume { box { -1, 1 } density { function { 1 + x*0.1 } } step 0.25 scattering rgb 1 rays 4000 }";
    static const char *const places[] = {"0, 0", "0.0131, 0.0077"};
    double seen[2];
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text, scene, places[i], places[i]);
        Picture p = drawn(*state, text, 2);
        seen[i] = picture_mean(&p);
        picture_free(&p);
    }
    assert_true(seen[0] > 0.1 && fabs(seen[0] / seen[1] - 1) < 0.01);
}

/* A lamp within, in the middle of a node, and one on the rim. */
static void lamps_within_stay_finite(void **state) {
    static const char *const lamps[] = {"<0, 0, 0>", "<1, 0, 0>", "<0.025, 0.025, 0.025>"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(lamps); i++)
        draw_with(*state, "camera { location -4*z look_at 0 }\nlight_source { %s, rgb 1 fade_distance 0.5 fade_power 2 }\nvolume { box { -1, 1 } scattering rgb 1 rays 2000 }", lamps[i], 1e3);
}

/* Both ways, where the two passes had been wrong: peaks seen from the side and from behind, colours, overlaps, matter around something solid. */
static const Trial AGREE[] = {
    {"murky cloud from the side", CAMERA "volume { sphere { 0, 1 } scattering rgb 4 phase { murky } rays 20000 }", 0.03, 0.004, 0.02},
    {"murky cloud before the sun", "camera { location -5*z look_at 0 angle 40 }\nlight_source { <4, 6, 30>, rgb 1 parallel point_at 0 }\n"
                                   "volume { sphere { 0, 1 } scattering rgb 4 phase { murky } rays 20000 }", 0.06, 0.01, 0.02},
    {"coloured, overlapping", CAMERA "volume { sphere { -0.4*x, 0.8 } scattering rgb <3, 2, 1> rays 20000 } volume { sphere { 0.4*x, 0.8 } scattering rgb <1, 2, 3> absorption rgb 0.2 }", 0.03, 0.004, 0.02},
    {"peaked backwards", CAMERA "volume { sphere { 0, 1 } scattering rgb 4 phase { henyey_greenstein -0.9 } rays 20000 }", 0.03, 0.003, 0.01},
    {"peaked, turns counted", CAMERA "volume { sphere { 0, 1 } scattering rgb 4 phase { murky } orders 3 rays 20000 }", 0.03, 0.003, 0.01},
    {"around something solid", CAMERA "sphere { 0, 0.6 pigment { rgb 0.4 } } volume { box { -1, 1 } scattering rgb 1.2 rays 20000 }", 0.04, 0.006, 0.02},
};

static void two_passes_agree_with_paths(void **state) {
    (void)state;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(AGREE); i++) {
        Bench b;
        char text[4096];
        VtsOptions o = options_of_size(16, 12);
        o.reference_samples = 256;
        snprintf(text, sizeof text, "global_settings { assumed_gamma 1 }\n%s", AGREE[i].scene);
        bench_begin(&b);
        Picture exact = reference_of(&b, &o, text), drawn_so = bench_render(&b, &o, text);
        Difference d = picture_difference(&drawn_so, &exact);
        printf("%-30s rms %.4f (%.3f), mean %+.4f (%.3f)\n", AGREE[i].name, d.rms, AGREE[i].rms, d.mean, AGREE[i].bias);
        if (d.rms > AGREE[i].rms || fabs(d.mean) > AGREE[i].bias || deviation(&exact) < AGREE[i].least) fail_msg("%s", AGREE[i].name);
        picture_free(&exact);
        picture_free(&drawn_so);
        bench_end(&b);
    }
}

/* Of what is drawn anew in each frame, second differences have six times the variance. */
enum { MOST_FRAMES = 8, MOST_VALUES = 3 * 32 * 20 };
static double flicker_of(const Bench *b, int frames, int width, int height, const char *setting, const char *scene) {
    static float seen[MOST_FRAMES][MOST_VALUES];
    const int values = 3 * width * height;
    double sum = 0;
    for (int i = 0; i < frames; i++) {
        char text[2048];
        VtsOptions o = options_of_size(width, height);
        snprintf(text, sizeof text, "#declare Frame = %d; %s\n%s", i, setting, scene);
        Picture p = bench_render(b, &o, text);
        memcpy(seen[i], p.pixels, (size_t)values * sizeof **seen);
        picture_free(&p);
    }
    for (int i = 1; i + 1 < frames; i++)
        for (int v = 0; v < values; v++) sum += pow((double)seen[i - 1][v] - 2 * (double)seen[i][v] + (double)seen[i + 1][v], 2);
    return sqrt(sum / (frames - 2) / values / 6);
}

/* The sun moves by half a degree from frame to frame, or the camera: what is left of second differences is what would be seen to flicker. */
static void nothing_flickers(void **state) {
    static const char *const turns[] = {"#declare Sun = Frame*0.5*y; #declare Eye = 0*y;", "#declare Sun = 0*y; #declare Eye = Frame*0.5*y;"};
    for (int k = 0; k < 2; k++) {
        double flicker = flicker_of(*state, 5, 24, 18, turns[k],
                                    "global_settings { assumed_gamma 1 sky_light on }\ncamera { location vrotate(<0, 0.3, -5>, Eye) look_at 0 right x*image_width/image_height angle 40 }\n"
                                    "light_source { vrotate(1e4*<-0.8, 0.5, -0.3>, Sun) rgb 0.8 parallel point_at 0 }\nbackground { rgb <0.15, 0.25, 0.4> }\n"
                                    "volume { density { fractal { size <16, 10, 16> dimension 2.4 threshold 0.4 seed 3 } } box { <-1.5, -0.8, -1.5>, <1.5, 0.8, 1.5> } scattering rgb 5 phase { henyey_greenstein 0.5 } }");
        printf("%s moves: %.5f\n", k ? "the camera" : "the sun", flicker);
        assert_true(flicker < 0.2 / 255 && flicker > 0);
    }
}

/* A wide and dense cloud, of which each bin gets few paths, and a sun that moves by a degree: the places where paths begin must move as steadily as it does, and their number must not
 * jump. (With places by a search through all cells in turn, and rays doubled, it was 0.022.) */
static void a_sun_that_moves_makes_no_flicker(void **state) {
    double flicker = flicker_of(*state, 8, 32, 20, "#declare Sun = Frame*z;",
                                "global_settings { assumed_gamma 1 max_error 4/255 }\ncamera { location <0, 2.5, -9> look_at <0, 2.2, 0> right x*image_width/image_height angle 45 }\n"
                                "light_source { vrotate(<60, 90, -40>, Sun), rgb 1.6 parallel point_at 0 }\nbackground { rgb <0.15, 0.25, 0.4> }\n"
                                "volume { density { fractal { size <65, 10, 65> dimension 2.35 threshold 0.42 seed 8 } } box { <-4, 1.5, -4>, <4, 3.3, 4> } scattering rgb 9 absorption rgb 0.05 "
                                "phase { schlick 0.222, -0.337, 0.752 } }");
    printf("the sun of a wide cloud moves: %.5f\n", flicker);
    assert_true(flicker < 2.0 / 255 && flicker > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sharp_phases_stay_finite),       cmocka_unit_test(depths_from_none_to_all),  cmocka_unit_test(grids_of_one_cell_and_of_none),
        cmocka_unit_test(rays_along_walls_are_as_others), cmocka_unit_test(lamps_within_stay_finite), cmocka_unit_test(two_passes_agree_with_paths),
        cmocka_unit_test(pieces_of_grids_cost_what_they_hold), cmocka_unit_test(nothing_flickers), cmocka_unit_test(a_sun_that_moves_makes_no_flicker),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
