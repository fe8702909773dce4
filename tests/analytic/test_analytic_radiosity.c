/* `radiosity` against closed forms: what stands before an even sky, and balls whose walls light each other. */
#include "analytic.h"
#include "open_sky.h"

#define MATT "texture { pigment { rgb 1 } finish { ambient 0 diffuse 0.8 } }"
#define BLACK "texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } }"
/* From above; what is in the way of the sky is black, and not seen itself. */
#define ABOVE \
    "#version 3.7;\nglobal_settings { assumed_gamma 1 radiosity { recursion_limit 1 } }\n" \
    "background { rgb 1 } camera { orthographic location <0, 40, 0> direction -y sky z right x*8 up z*8 look_at 0 }\n" \
    "plane { y, 0 " MATT " }\n"

static double x_of(int px) { return (px + 0.5) / 8 - 4; }

static const SkyCase CASES[] = {OPEN_SKY_CASES(BLACK), {"unseen", "sphere { y, 1 no_image no_radiosity " BLACK " }", open_plain}};
/* What is gathered at places apart is not as fine as the foot of a wall. */
static const double NEAR_WALLS = 0.85;

static void sky_is_hidden_by_closed_forms(void **state) {
    int bad = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(CASES); i++) {
        static char text[4096];
        VtsOptions o = options_of_size(64, 64);
        snprintf(text, sizeof text, ABOVE "%s", CASES[i].objects);
        Picture p = bench_see(*state, &o, text, false);
        double squares = 0, sum = 0;
        int count = 0;
        for (int y = 0; y < p.height; y++)
            for (int x = 0; x < p.width; x++) {
                double expected = 0.8 * CASES[i].truth(x_of(x), -x_of(y));
                if (isnan(expected) || (CASES[i].truth == open_in_groove && fabs(x_of(y)) > NEAR_WALLS)) continue;
                double off = (double)pixel_at(&p, x, y)[1] - expected;
                squares += off * off, sum += off, count++;
            }
        printf("%-10s rmse %.4f mean off by %+.4f\n", CASES[i].name, sqrt(squares / count), sum / count);
        bad += sqrt(squares / count) > 0.025 || fabs(sum / count) > 0.006;
        picture_free(&p);
    }
    assert_int_equal(bad, 0);
}

/* The share of a level place's hemisphere, by the cosine, of a level rectangle two above it with one corner over the place. */
static double corner_share(double a, double b) {
    double p = hypot(a, 2), q = hypot(b, 2);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * VTS_PI);
}

/* Light of a small bright panel, one wide, which few of a place's directions meet. */
static void small_lights_are_even(void **state) {
    static const char text[] = "#version 3.7;\nglobal_settings { assumed_gamma 1 radiosity { recursion_limit 1 } }\n"
        "camera { orthographic location <0, 40, 0> direction -y sky z right x*8 up z*8 look_at 0 }\n"
        "plane { y, 0 " MATT " } box { <-0.5, 2, -0.5>, <0.5, 2.001, 0.5> no_image texture { pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 10 } } }\n";
    VtsOptions o = options_of_size(64, 64);
    Picture p = bench_see(*state, &o, text, false);
    double squares = 0, sum = 0;
    for (int y = 0; y < p.height; y++)
        for (int x = 0; x < p.width; x++) {
            double a = x_of(x), b = x_of(y);
            double share = corner_share(0.5 - a, 0.5 - b) + corner_share(0.5 + a, 0.5 - b) + corner_share(0.5 - a, 0.5 + b) + corner_share(0.5 + a, 0.5 + b);
            double off = (double)pixel_at(&p, x, y)[1] - 8 * share;
            squares += off * off, sum += off;
        }
    printf("small light rmse %.4f mean off by %+.4f\n", sqrt(squares / 4096), sum / 4096);
    assert_true(sqrt(squares / 4096) < 0.02);
    assert_true(fabs(sum / 4096) < 0.004);
    picture_free(&p);
}

/* Within a ball of emission e and share a each bounce brings a times the one before. */
static float in_ball(Bench *bench, const char *settings, const char *finish, const char *version) {
    static char text[2048];
    VtsOptions o = options_of_size(16, 16);
    snprintf(text, sizeof text, "#version %s;\nglobal_settings { assumed_gamma 1 radiosity { %s } }\ncamera { location <0, 0.3, -0.5> look_at <0.2, 0, 1> }\n"
             "sphere { 0, 1 pigment { rgb 1 } finish { %s } }\n", version, settings, finish);
    Picture p = bench_see(bench, &o, text, false);
    float mean = 0;
    for (int i = 0; i < p.width * p.height; i++) mean += p.pixels[3 * i + 1] / (float)(p.width * p.height);
    picture_free(&p);
    return mean;
}

static void bounces_add_up(void **state) {
    const char *glow = "ambient 0 emission 0.2 diffuse 0.5";
    assert_float_equal(in_ball(*state, "recursion_limit 1", glow, "3.7"), 0.3f, 0.002f);
    assert_float_equal(in_ball(*state, "", glow, "3.7"), 0.35f, 0.003f);
    assert_float_equal(in_ball(*state, "recursion_limit 3", glow, "3.7"), 0.375f, 0.005f);
    assert_float_equal(in_ball(*state, "brightness 1.5", "ambient 0 emission 0.2 diffuse 0.4", "3.7"), 0.392f, 0.003f);
    assert_float_equal(in_ball(*state, "max_sample 0.1 recursion_limit 1", glow, "3.7"), 0.25f, 0.002f);
    /* leaves take from both sides: behind this ball all is dark */
    assert_float_equal(in_ball(*state, "recursion_limit 1", "ambient 0 emission 0.2 diffuse 0.5, 0.4", "3.7"), 0.3f, 0.002f);
}

/* POV-Ray's: with radiosity there is no ambient light, but in the scenes of before 3.7. */
static void ambient_light_was_of_before(void **state) {
    assert_float_equal(in_ball(*state, "recursion_limit 1", "ambient 0.2 diffuse 0.5", "3.7"), 0, 1e-6f);
    assert_float_equal(in_ball(*state, "recursion_limit 1", "ambient 0.2 diffuse 0.5", "3.6"), 0.3f, 0.002f);
}

static void pixels_do_not_depend_on_threads(void **state) {
    static const char text[] =
        "#version 3.7;\nglobal_settings { assumed_gamma 1 radiosity { } } background { rgb 0.7 }\ncamera { location <0, 2, -5> look_at <0, 0.5, 0> }\n"
        "plane { y, 0 pigment { rgb 0.8 } } box { -1, 1 rotate 30*y pigment { rgb <0.9, 0.2, 0.1> } } sphere { <1.8, 0.7, -0.5>, 0.7 pigment { rgb 0.6 } finish { reflection 0.4 } }\n";
    Picture p[2];
    for (int i = 0; i < 2; i++) {
        VtsOptions o = options_of_size(40, 30);
        o.threads = i ? 3 : 1;
        p[i] = bench_see(*state, &o, text, false);
    }
    assert_memory_equal(p[0].pixels, p[1].pixels, sizeof(float) * 3 * 40 * 30);
    picture_free(&p[0]);
    picture_free(&p[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sky_is_hidden_by_closed_forms),
        cmocka_unit_test(small_lights_are_even),
        cmocka_unit_test(bounces_add_up),
        cmocka_unit_test(ambient_light_was_of_before),
        cmocka_unit_test(pixels_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
