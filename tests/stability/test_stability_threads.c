/* The same pixels for any number of threads, for one scene of each kind of machinery. */
#include "maps.h"

enum { WIDTH = 72, HEIGHT = 40, VALUES = 3 * WIDTH * HEIGHT };

#define SUN "light_source { <300, 500, -200>, rgb 1 parallel point_at 0 }\nbackground { rgb <0.3, 0.4, 0.6> }\n"
#define LOOK "camera { location <0.6, 2.4, -4.2> look_at <0, 0.2, 0> angle 46 right x*image_width/image_height }\n"
#define GRASS \
    "#declare S = seed(7);\n" \
    "#declare Tuft = texel { layer { mesh { #for (I, 1, 14) #local P = <0.5, 0, 0.5> + 0.2*<rand(S) - 0.5, 0, rand(S) - 0.5>;\n" \
    " triangle { P - 0.03*x, P + 0.03*x, P + <0.5*rand(S) - 0.25, 0.9, 0.5*rand(S) - 0.25> } #end } texture { pigment { rgb <0.5, 0.8, 0.3> } } } }\n"
#define LAWN(MORE) \
    "skin { surface { patch_grid 6, 5 function(u, v) { <4*u - 2, 0.9*sin(3*u)*sin(2.6*v) + 0.2*u, 4*v - 2> } } texel { Tuft }\n" \
    " mapping { repeat <12, 12> height 0.5 } jitter { instance { displace 0.6 rotate 360 } } " MORE " }\n"
#define CLOUD "volume { density { fractal { size <12, 8, 12> dimension 2.4 threshold 0.45 seed 3 } } box { <-1.2, 0, -1>, <1.2, 0.8, 1.4> } scattering rgb 4 no_shadow phase { henyey_greenstein 0.4 } }\n"
#define MAP "map.asc"

typedef struct Kind {
    const char *name, *scene, *detail; /* NULL: as the program chooses */
    double shutter;
} Kind;

static const Kind kinds[] = {
    {"explicit", SUN LOOK "plane { y, -0.3 pigment { checker rgb 0.3, rgb 0.8 } finish { reflection 0.2 } }\n"
                 "difference { sphere { 0, 1 } box { 0, 2 } pigment { bozo color_map { [0 rgb x] [1 rgb y] } } normal { bumps 0.4 scale 0.2 } }\n"
                 "sphere { <1.4, 0.4, -1>, 0.5 pigment { rgbf 0.9 } interior { ior 1.4 } finish { reflection 0.1 specular 0.6 } }\n"
                 "light_source { <-4, 5, -3>, rgb 0.6 area_light x, z, 3, 3 }\n", NULL, 0},
    {"skin as triangles", SUN LOOK GRASS "plane { y, -0.3 pigment { rgb 0.5 } }\n" LAWN(""), "exact", 0},
    {"skin as voxels", SUN LOOK GRASS "plane { y, -0.3 pigment { rgb 0.5 } }\n" LAWN(""), "voxels", 0},
    {"skin, sky light", SUN LOOK GRASS "global_settings { sky_light on }\nplane { y, -0.3 pigment { rgb 0.5 } }\n" LAWN(""), NULL, 0},
    {"skin in the wind", SUN LOOK GRASS LAWN("wind_field { direction x speed 4 strength 0.5 gust { wavelength 2 amplitude 0.6 sharpness 2 } }"), NULL, 0},
    {"volume", SUN LOOK "plane { y, -1 pigment { rgb 0.5 } }\n" CLOUD, NULL, 0},
    {"media", SUN LOOK "plane { y, -1 pigment { rgb 0.6 } }\n"
              "sphere { 0, 0.7 hollow pigment { rgbt 1 } interior { media { scattering { 1, rgb 2 } absorption rgb <0, 0.3, 0.6>\n"
              " density { spherical turbulence 0.4 scale 0.7 color_map { [0 rgb 0] [0.3 rgb 0.2] [1 rgb 1] } } } } }\n"
              "light_source { <-3, 4, -2>, rgb 1 spotlight radius 10 falloff 20 point_at 0 media_attenuation on }\nmedia { absorption rgb 0.03 }\n", NULL, 0},
    {"isosurface", SUN LOOK "isosurface { function { y - 0.4*fbm(perlin, x, y, z, 4, 2, 0.5) } contained_by { sphere { 0, 1 } } pigment { rgb <0.7, 0.6, 0.5> } }\n"
                   "isosurface { function { x*x + pow(y - 1, 2) + z*z - 0.3 + 0.05*sin(20*x) } contained_by { box { <-0.7, 0.3, -0.7>, <0.7, 1.7, 0.7> } } max_gradient 5 pigment { rgb y } }\n", NULL, 0},
    {"terrain", SUN "#declare Land = terrain { heightmap \"" MAP "\" }\nobject { Land pigment { rgb <0.5, 0.6, 0.3> } }\n"
                "camera { location <-2000, 900, -2500> look_at <0, 200, 0> angle 50 right x*image_width/image_height }\n", NULL, 0},
    {"forest on terrain", SUN GRASS "#declare Land = terrain { heightmap \"" MAP "\" }\nobject { Land pigment { rgb <0.5, 0.6, 0.3> } }\n"
                          "skin { surface { terrain { Land } } texel { Tuft } mapping { tile 60 height 50 } }\n"
                          "camera { location <-1500, 700, -1900> look_at <0, 200, 0> angle 50 right x*image_width/image_height }\n", NULL, 0},
    {"motion blur", SUN LOOK GRASS "plane { y, -0.3 pigment { checker rgb 0.3, rgb 0.8 } }\nsphere { <clock - 0.5, 1, -1>, 0.4 pigment { rgb x } }\n" LAWN(""), NULL, 0.15},
    {"cloth", SUN LOOK "cloth { size <2, 1.5> grid 12, 9 pin top wind_field { direction <1, 0, 0.4> speed 6 strength 2 } pigment { rgb z } }\n", NULL, 0},
};

static double post(int column, int row) { return 300 * sin(0.4 * column) * cos(0.31 * row) + 7 * ((column * 37 + row * 91) % 11); }

static int set_up(void **state) {
    int failed = bench_set_up(state);
    if (!failed) map_write(*state, MAP, 60, 60, 10, 46, 0.001, post);
    return failed;
}

static int tear_down(void **state) {
    map_remove(*state, MAP);
    return bench_tear_down(state);
}

static VtsOptions options_of(const Kind *kind, const VtsPair *detail) {
    VtsOptions o = options_of_size(WIDTH, HEIGHT);
    if (kind->detail) o.settings = detail, o.setting_count = 1;
    o.shutter_clock = o.shutter_time = kind->shutter;
    o.time = 0.5, o.time_set = true;
    return o;
}

/* How many values differ, and none may be without a number. */
static size_t differing(const Picture *a, const Picture *b) {
    size_t n = 0;
    for (size_t i = 0; i < VALUES; i++) {
        assert_true(isfinite(a->pixels[i]) && a->pixels[i] >= 0);
        n += memcmp(&a->pixels[i], &b->pixels[i], sizeof *a->pixels) != 0;
    }
    return n;
}

static void pictures(void **state) {
    size_t failed = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++) {
        const VtsPair detail = {"detail", kinds[i].detail};
        VtsOptions o = options_of(&kinds[i], &detail);
        o.threads = 1;
        Picture one = bench_render(*state, &o, kinds[i].scene);
        for (o.threads = 2; o.threads <= 3; o.threads++) {
            Picture more = bench_render(*state, &o, kinds[i].scene);
            size_t differ = differing(&more, &one);
            if (differ) printf("%s: %zu values differ with %d threads\n", kinds[i].name, differ, o.threads);
            failed += differ != 0;
            picture_free(&more);
        }
        picture_free(&one);
    }
    assert_int_equal(failed, 0);
}

/* The frames of a film, drawn by one session; each also alone. */
enum { FRAMES = 3 };
static const char film[] = SUN LOOK GRASS "plane { y, -0.3 pigment { rgb 0.5 } }\n" CLOUD
    LAWN("wind_field { direction x speed 4 strength 0.5 gust { wavelength 2 amplitude 0.6 sharpness 2 } }") "sphere { <2*clock - 1, 1.6, -1>, 0.3 pigment { rgb x } }\n";

static VtsOptions frame_options(int threads, int frame) {
    VtsOptions o = options_of_size(WIDTH, HEIGHT);
    o.threads = threads;
    o.first_frame = 1, o.last_frame = FRAMES, o.frame = frame;
    o.first_clock = 0, o.last_clock = 1, o.clock_delta = 1.0 / (FRAMES - 1);
    o.clock = (frame - 1) * o.clock_delta, o.clock_set = true;
    o.fps = 24;
    return o;
}

static void films(void **state) {
    const Bench *b = *state;
    Picture alone[FRAMES];
    for (int f = 0; f < FRAMES; f++) {
        VtsOptions o = frame_options(1, f + 1);
        alone[f] = bench_render(b, &o, film);
    }
    assert_true(differing(&alone[0], &alone[1]) > VALUES / 50);
    for (int threads = 2; threads <= 3; threads++) {
        VtsOptions o = frame_options(threads, 1);
        VtsSession *session = vts_session_create(&o, NULL);
        for (int f = 0; f < FRAMES; f++) {
            o = frame_options(threads, f + 1);
            vts_set_frame(session, &o);
            assert_int_equal(vts_render(session, b->scene, b->output), VTS_OK);
            Picture p = picture_read(b->output);
            size_t differ = differing(&p, &alone[f]);
            if (differ) fail_msg("frame %d with %d threads: %zu values differ from those of the frame alone", f + 1, threads, differ);
            picture_free(&p);
        }
        vts_session_destroy(session);
    }
    for (int f = 0; f < FRAMES; f++) picture_free(&alone[f]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(pictures, set_up, tear_down), cmocka_unit_test_setup_teardown(films, set_up, tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
