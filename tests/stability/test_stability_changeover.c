/* Where voxels take the place of exact geometry: pixels are far wider than the layer is high, and a pixel's samples are some of them one,
 * some the other. */
#include "stability.h"

#define FLIGHT(GRASS, SOIL) \
    "#declare S = seed(5);\n" \
    "camera { location <0, D, -D> look_at 0 angle 40 right x*image_width/image_height }\n" \
    "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 }\n" \
    "#declare Grass = texel { cyclic x + z layer { particles { count 16 { position <rand(S), 0, rand(S)>" \
    " velocity <0.3*rand(S) - 0.15, 1, 0.3*rand(S) - 0.15> life 0.9 width 0.05, 0.01 profile \"flat\" } } texture { " GRASS " } } }\n" \
    "#declare Land = surface { patch_grid 1, 1 function(u, v) { <9000*(u - 0.5), 0, 9000*(v - 0.5)> } texture { " SOIL " } };\n" \
    "object { Land } skin { surface { Land } texel { Grass } mapping { repeat <9000, 9000> height 0.5 } }\n"

typedef struct Flight {
    const char *name, *scene;
    double rms, bias;
} Flight;

/* From where nearly all of it is exact geometry to where it is voxels. */
static const char *const distances[] = {"40", "60", "90", "130"};

static void flights(void **state) {
    (void)state;
    /* What is seen of the grass before the soil; both in the sun, with their shadows. */
    static const Flight all[] = {
        {"coverage", FLIGHT("pigment { rgb <0, 1, 0> } finish { emission 1 diffuse 0 ambient 0 }", "pigment { rgb 0 }"), 0.03, 0.004},
        {"soil", FLIGHT("pigment { rgb 0 }", "pigment { rgb 1 } finish { diffuse 1 }"), 0.046, 0.006},
        {"both", FLIGHT("pigment { rgb <0.2, 0.5, 0.1> }", "pigment { rgb <0.2, 0.15, 0.1> }"), 0.006, 0.0025},
    };
    const VtsPair exact = {"detail", "exact"};
    int failed = 0;
    Bench b;
    bench_begin(&b);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(all); i++)
        for (size_t k = 0; k < VTS_ARRAY_COUNT(distances); k++) {
            const VtsPair distance = {"D", distances[k]};
            VtsOptions options = options_of_size(48, 36);
            options.declares = &distance, options.declare_count = 1;
            options.samples = 64;
            Picture drawn = bench_render(&b, &options, all[i].scene);
            options.settings = &exact, options.setting_count = 1;
            Picture truth = bench_render(&b, &options, all[i].scene);
            Difference d = picture_difference(&drawn, &truth);
            bool good = d.rms <= all[i].rms && fabs(d.mean) <= all[i].bias && deviation(&truth) > 0.01;
            failed += !good;
            printf("%-10s %4s rms %.4f (%.4f), mean %+.4f (%.4f) of %.4f%s\n", all[i].name, distances[k], d.rms, all[i].rms, d.mean, all[i].bias,
                   picture_mean(&truth), good ? "" : "  <-- beyond its bound");
            picture_free(&drawn);
            picture_free(&truth);
        }
    bench_end(&b);
    assert_int_equal(failed, 0);
}

/* Light and shade of a periodic field do not depend on how far away it is: exact geometry of pixels of 0.6 m, and of 10 m, on a cell of 40 km. */
static void far_shadows(void **state) {
    (void)state;
#define FIELD(GRASS, SOIL) \
    "#declare S = seed(5);\n" \
    "camera { location <0, D, -D> look_at 0 angle 3.47 right x*image_width/image_height }\n" \
    "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 }\n" \
    "#declare Grass = texel { cyclic x + z layer { particles { count 16 { position <rand(S), 0, rand(S)>" \
    " velocity <0.3*rand(S) - 0.15, 1, 0.3*rand(S) - 0.15> life 0.9 width 0.05, 0.01 profile \"flat\" } } texture { " GRASS " } } }\n" \
    "#declare Land = surface { patch_grid 1, 1 function(u, v) { <40000*(u - 0.5), 0, 40000*(v - 0.5)> } texture { " SOIL " } };\n" \
    "object { Land } skin { surface { Land } texel { Grass } mapping { repeat <40000, 40000> height 0.5 } }\n"
    static const char *const scenes[] = {FIELD("pigment { rgb 1 } finish { diffuse 1 ambient 0 }", "pigment { rgb 0 } finish { ambient 0 }"),
                                         FIELD("pigment { rgb 0 } finish { ambient 0 }", "pigment { rgb 1 } finish { diffuse 1 ambient 0 }")};
    static const double within[] = {0.006, 0.012}; /* three times the deviation of means of so few samples */
    const VtsPair exact = {"detail", "exact"}, near = {"D", "60"}, far = {"D", "1000"};
    Bench b;
    bench_begin(&b);
    for (int i = 0; i < 2; i++) {
        VtsOptions options = options_of_size(48, 36);
        options.declares = &near, options.declare_count = 1;
        options.reference_samples = 64;
        Picture truth = reference_of(&b, &options, scenes[i]);
        options = options_of_size(5, 4);
        options.declares = &far, options.declare_count = 1;
        options.settings = &exact, options.setting_count = 1;
        options.samples = 128;
        Picture drawn = bench_render(&b, &options, scenes[i]);
        double error = picture_mean(&drawn) - picture_mean(&truth);
        printf("%s from far %+.4f of %.4f\n", i ? "soil" : "grass", error, picture_mean(&truth));
        assert_true(fabs(error) <= within[i]);
        picture_free(&drawn);
        picture_free(&truth);
    }
    bench_end(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(flights), cmocka_unit_test(far_shadows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
