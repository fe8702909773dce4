/* Lamps that shine unevenly, against closed forms: on surfaces, from discs, and in volumes and media. */
#include "analytic.h"

#define WITHIN "camera { spherical location 0 look_at z angle 360 180 }\nsphere { 0, 1 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n"
enum { ROWS = 64 };

static Picture look_around(const Bench *b, const char *lamp) {
    char text[2048];
    VtsOptions o = options_of_size(2 * ROWS, ROWS);
    o.samples = 1;
    snprintf(text, sizeof text, WITHIN "light_source { 0 rgb 1 %s }\n", lamp);
    return bench_render(b, &o, text);
}

/* Of the picture all around: light times solid angle. */
static double flux_of(const Picture *p) {
    double sum = 0;
    for (int y = 0; y < ROWS; y++) {
        double solid = (sin(VTS_PI * (.5 - (double)y / ROWS)) - sin(VTS_PI * (.5 - (y + 1.) / ROWS))) * VTS_PI / ROWS;
        for (int x = 0; x < 2 * ROWS; x++) sum += solid * (double)pixel_at(p, x, y)[1];
    }
    return sum;
}

/* The integral of cos^n over half a sphere is 2 pi / (n + 1), wherever the lamp points. */
static void lobes_have_their_flux(void **state) {
    static const char *const aims[] = {"point_at z", "point_at <1, -2, 0.5>", ""};
    const int exponents[] = {1, 4, 15};
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++) {
            char lamp[256];
            snprintf(lamp, sizeof lamp, "%s goniometric function(theta) { pow(max(0, cos(theta)), %d) }", aims[i], exponents[k]);
            Picture p = look_around(*state, lamp);
            double got = flux_of(&p), want = 2 * VTS_PI / (exponents[k] + 1);
            printf("cos^%d, '%s': %.5f of %.5f\n", exponents[k], aims[i], got, want);
            if (fabs(got / want - 1) > 2e-3) fail_msg("flux");
            picture_free(&p);
        }
}

static Vec3 towards(int x, int y) {
    double up = VTS_PI * (.5 - (y + .5) / ROWS), turn = 2 * VTS_PI * ((x + .5) / (2 * ROWS) - .5);
    return vec3(cos(up) * sin(turn), sin(up), cos(up) * cos(turn));
}

static double table_at(double angle) {
    static const double at[] = {0, 0.4, 0.9, 1.5, 2.5}, value[] = {1, 0.7, 0.9, 0.1, 0};
    for (int i = 0; i < 4; i++)
        if (angle < at[i + 1]) return value[i] + (value[i + 1] - value[i]) * (angle - at[i]) / (at[i + 1] - at[i]);
    return 0;
}

/* Down, where nothing is said; the rest is a table. */
static void tables_are_read_by_angle(void **state) {
    Picture p = look_around(*state, "goniometric function { spline { linear_spline 0, 1  0.4, 0.7  0.9, 0.9  1.5, 0.1  2.5, 0 } }");
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < 2 * ROWS; x++) {
            double want = table_at(acos(double_clamp(-towards(x, y).y, -1, 1)));
            if (fabs((double)pixel_at(&p, x, y)[0] - want) > 1e-4) fail_msg("at %d, %d: %g, not %g", x, y, (double)pixel_at(&p, x, y)[0], want);
        }
    picture_free(&p);
}

/* What is too bright for the numbers of a picture is very bright, and dark where a colour of the light is 0. */
static void blinding_lamps_stay_numbers(void **state) {
    static const char *const lamps[] = {"goniometric function(theta) { 1e300 }", "goniometric function { spline { linear_spline 0, 1  1, 1e39 } }", "color <1e300, 0, 1>",
                                        "color <1e30, 0, 1> goniometric function(theta) { 1e30 }"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(lamps); i++) {
        char lamp[256];
        snprintf(lamp, sizeof lamp, "}\nlight_source { 0 %s %s", i < 2 ? "color <1, 0, 0>" : "", lamps[i]);
        Picture p = look_around(*state, lamp);
        for (int y = 0; y < ROWS; y++)
            for (int x = 0; x < 2 * ROWS; x++)
                for (int c = 0; c < 3; c++) assert_true(isfinite((double)pixel_at(&p, x, y)[c]));
        assert_true((double)pixel_at(&p, ROWS, ROWS - 2)[0] > 1.5);
        assert_true(fabs((double)pixel_at(&p, ROWS, ROWS - 2)[1] - 1) < 1e-4);
        picture_free(&p);
    }
}

/* No light where the function is negative or no number. */
static void lamps_do_not_swallow_light(void **state) {
    static const char *const functions[] = {"-1", "1/(theta - theta)", "ln(-1 - theta*0)*0", "pow(10, 400 + theta)"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(functions); i++) {
        char lamp[256];
        snprintf(lamp, sizeof lamp, "point_at x goniometric function(theta) { %s }", functions[i]);
        Picture p = look_around(*state, lamp);
        for (int k = 0; k < 2 * ROWS * ROWS * 3; k++) assert_true(p.pixels[k] == 0);
        picture_free(&p);
    }
}

/* A disc of radius R that shines as Lambert's law says, seen from h below its middle: its light falls with the square of the distance, so that h^2/(h^2 + r^2)^2 of each
 * place comes, which is 1/(h^2 + R^2) on the mean. The axis is that of the disc. */
static void discs_light_as_lambert_says(void **state) {
    const double heights[] = {0.5, 1, 3};
    for (size_t i = 0; i < 3; i++) {
        char text[1024];
        VtsOptions o = options_of_size(8, 8);
        double h = heights[i], fade = 0.01;
        snprintf(text, sizeof text,
                 LOOK_DOWN(0.1, 0.02) "light_source { <0, %g, 0> rgb 5000 area_light 2*x, 2*z, 65, 65 circular area_illumination on fade_distance %g fade_power 2\n"
                                      "goniometric function(theta) { max(0, cos(theta)) } }\n"
                                      "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n",
                 h, fade);
        Picture p = bench_render(*state, &o, text);
        double got = picture_mean(&p), want = 5000 * 2 * fade * fade / (h * h + 1);
        printf("disc at %g: %.5f of %.5f\n", h, got, want);
        if (fabs(got / want - 1) > 0.03) fail_msg("disc at %g", h);
        picture_free(&p);
    }
}

/* A lamp in the middle of thin matter sends a lobe to the right. Of what is scattered once the eye gets the integral of cos^2 along its line of sight: s^2/(s^2 + z^2), s being how
 * far to the right it passes. Volumes send a quarter of the lamp's colour for each length, media (whose phase functions are POV-Ray's) all of it. */
static void matter_is_lit_by_the_lobe(void **state) {
    static const struct { const char *matter; double share; } cases[] = {
        {"volume { box { -8, 8 } scattering rgb 0.0001 orders 1 }", 0.25},
        {"box { -8, 8 hollow pigment { rgbt 1 } interior { media { scattering { 1, rgb 0.0001 extinction 0 } } } }", 1},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        char text[1024];
        VtsOptions o = options_of_size(16, 2);
        snprintf(text, sizeof text,
                 "global_settings { max_error 1e-4 }\n"
                 "camera { orthographic location <0, 0, -20> look_at 0 right 8*x up y }\n"
                 "light_source { 0 rgb 10000 point_at x goniometric function(theta) { select(cos(theta), 0, pow(cos(theta), 2)) } }\n%s\n",
                 cases[i].matter);
        Picture p = bench_render(*state, &o, text);
        for (int x = 0; x < 16; x++) {
            double s = 8 * ((x + .5) / 16 - .5), far = hypot(s, 0.25), got = (double)pixel_at(&p, x, 0)[0];
            double want = s > 0 ? cases[i].share * 2 * s * s / far * atan(8 / far) : 0;
            if (fabs(got - want) > 0.015 * cases[i].share * 8.5) fail_msg("%s at %g: %g, not %g", cases[i].matter, s, got, want);
        }
        picture_free(&p);
    }
}

/* A picture of a scene beside which a lamp's file stands; heights 0 60 90 and turns 0 to 90: (1 - height / 90) (1 + turn / 90) / 2. */
static Picture render_with_lamp(const Bench *b, const VtsOptions *o, const char *text) {
    char path[128];
    snprintf(path, sizeof path, "%s/lamp.ies", b->folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0 1 1 60\n0 60 90\n0 30 90\n90 30 0\n120 40 0\n180 60 0\n", f);
    fclose(f);
    Picture p = bench_render(b, o, text);
    remove(path);
    return p;
}

static double lamp_at(Vec3 away, Vec3 down, Vec3 across, Vec3 aside) {
    double height = acos(double_clamp(vec3_dot(away, down), -1, 1)) / VTS_RADIANS, turn = fabs(atan2(vec3_dot(away, aside), vec3_dot(away, across))) / VTS_RADIANS;
    if (turn > 90) turn = 180 - turn;
    return height < 90 ? (1 - height / 90) * (1 + turn / 90) / 2 : 0;
}

/* Hung, aimed, turned, and aimed straight up: all around by the frame that each should have. */
static void measured_lamps_shine_as_they_hang(void **state) {
    const double h = sqrt(0.5);
    const struct { const char *lamp; Vec3 down, across, aside; } cases[] = {
        {"", {0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
        {"rotate 90*y", {0, -1, 0}, {0, 0, -1}, {1, 0, 0}},
        {"point_at z", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
        {"point_at x", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {"point_at <3, -3, 0>", {h, -h, 0}, {h, h, 0}, {0, 0, 1}},
        {"point_at y", {0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
        {"scale <-2, 1, 1> rotate 90*x", {0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        char text[2048];
        VtsOptions o = options_of_size(2 * ROWS, ROWS);
        o.samples = 1;
        snprintf(text, sizeof text, WITHIN "light_source { 0 rgb 1 ies \"lamp.ies\" %s }\n", cases[i].lamp);
        Picture p = render_with_lamp(*state, &o, text);
        for (int y = 0; y < ROWS; y++)
            for (int x = 0; x < 2 * ROWS; x++) {
                double want = lamp_at(towards(x, y), cases[i].down, cases[i].across, cases[i].aside), got = (double)pixel_at(&p, x, y)[0];
                if (fabs(got - want) > 1e-4) fail_msg("'%s' at %d, %d: %g, not %g", cases[i].lamp, x, y, got, want);
            }
        picture_free(&p);
    }
}

/* On a plane below it: the table's light by Lambert's law, and by the distance where that is asked for. */
static void a_floor_is_lit_by_the_table(void **state) {
    enum { SIDE = 48 };
    VtsOptions o = options_of_size(SIDE, SIDE);
    o.samples = 1;
    Picture p = render_with_lamp(*state, &o,
                                 LOOK_DOWN(3, 6) "light_source { <0.5, 2, 0>, rgb 1 ies \"lamp.ies\" fade_distance 0.01 fade_power 2 }\n"
                                                 "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n");
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            Vec3 way = vec3(6 * ((x + .5) / SIDE - .5) - 0.5, -2, 6 * (.5 - (y + .5) / SIDE));
            double far = vec3_length(way), table = lamp_at(vec3_scale(way, 1 / far), vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 0, 1));
            double want = table * 2 / far * 2 / (1 + far * far / 1e-4), got = (double)pixel_at(&p, x, y)[0];
            if (fabs(got / want - 1) > 2e-3) fail_msg("at %d, %d: %g, not %g", x, y, got, want);
        }
    picture_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_have_their_flux),
        cmocka_unit_test(tables_are_read_by_angle),
        cmocka_unit_test(blinding_lamps_stay_numbers),
        cmocka_unit_test(lamps_do_not_swallow_light),
        cmocka_unit_test(discs_light_as_lambert_says),
        cmocka_unit_test(matter_is_lit_by_the_lobe),
        cmocka_unit_test(measured_lamps_shine_as_they_hang),
        cmocka_unit_test(a_floor_is_lit_by_the_table),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
