/* Explicit surfaces, lights and fog: pictures with closed forms. */
#include "analytic.h"

/* ---- areas ---- */

/* A white ball on black: the sum of all pixels is the disc's area. */
static void a_ball_covers_its_disc(void **state) {
    VtsOptions o = options_of_size(64, 64);
    Picture p = bench_render(*state, &o,
        "camera { orthographic location <0,0,-5> direction z right 2*x up 2*y }\n"
        "sphere { <0.137, -0.071, 0>, 0.7 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }\n");
    double area = picture_mean(&p) * 4, exact = VTS_PI * .49;
    printf("orthographic: area %.5f, exact %.5f\n", area, exact);
    assert_true(fabs(area / exact - 1) < .005);
    picture_free(&p);
    /* In perspective, on the axis: tan of the silhouette's angle is r / sqrt(d² - r²). */
    p = bench_render(*state, &o,
        "camera { location <0,0,-3> direction z right x up y }\n"
        "sphere { 0, 0.9 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }\n");
    area = picture_mean(&p), exact = VTS_PI * .81 / (9 - .81);
    printf("perspective: area %.5f, exact %.5f\n", area, exact);
    assert_true(fabs(area / exact - 1) < .005);
    picture_free(&p);
}

/* The shadow of a ball under slanted parallel light is an ellipse. */
static void a_ball_casts_an_ellipse(void **state) {
    VtsOptions o = options_of_size(96, 96);
    Picture p = bench_render(*state, &o, LOOK_DOWN(20, 6)
        "light_source { <-300, 500, 0> rgb 1 parallel point_at 0 }\n"
        "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n"
        "sphere { <-0.6, 3, 0>, 1 pigment { rgb 0 } no_image }\n");
    double cosine = 5 / sqrt(34), lit = cosine, dark = 0;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) dark += 1 - (double)pixel_at(&p, x, y)[0] / lit;
    dark *= 36.0 / (96 * 96);
    double exact = VTS_PI / cosine;
    printf("shadow: area %.4f, exact %.4f\n", dark, exact);
    assert_true(fabs(dark / exact - 1) < .02);
    /* Its middle is where the light through the ball's middle meets the ground. */
    int cx = (int)(96 * ((-.6 + 3 * .6) / 6 + .5));
    assert_true(pixel_at(&p, cx, 48)[0] == 0);
    assert_true(fabs((double)pixel_at(&p, 2, 48)[0] - lit) < 1e-5);
    picture_free(&p);
}

/* A wavy mesh with smooth normals under a high sun: no face hides another, so every place has the light of its normal. */
static void smooth_meshes_do_not_shade_themselves(void **state) {
    VtsOptions o = options_of_size(160, 120);
    Picture p = bench_render(*state, &o,
        "camera { location <0, 1.2, -4> look_at 0 right x*4/3 angle 50 }\n"
        "light_source { <-300, 210, -40> rgb 1 parallel point_at 0 }\n"
        "#declare H = function(x, z) { 0.15*sin(2*x)*cos(2*z) }\n"
        "#macro At(X, Z) <X, H(X, Z), Z> #end\n"
        "#macro Up(X, Z) vnormalize(<-0.3*cos(2*X)*cos(2*Z), 1, 0.3*sin(2*X)*sin(2*Z)>) #end\n"
        "mesh { #for (I, -30, 29) #for (J, -20, 39) #local A = I*0.2; #local B = A + 0.2; #local C = J*0.2; #local D = C + 0.2;\n"
        "  smooth_triangle { At(A, C), Up(A, C), At(B, C), Up(B, C), At(B, D), Up(B, D) }\n"
        "  smooth_triangle { At(A, C), Up(A, C), At(B, D), Up(B, D), At(A, D), Up(A, D) }\n"
        "#end #end pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n");
    int hit = 0, dark = 0;
    for (int y = 50; y < 120; y++)
        for (int x = 1; x < 159; x++) {
            float neighbours = (pixel_at(&p, x - 1, y)[0] + pixel_at(&p, x + 1, y)[0]) / 2;
            hit++;
            dark += pixel_at(&p, x, y)[0] < neighbours - .03f; /* the light is smooth */
        }
    printf("smooth mesh: %d of %d pixels dark\n", dark, hit);
    assert_true(dark < 10); /* crests before what lies behind them */
    picture_free(&p);
}

/* ---- light ---- */

static void parallel_light_on_a_plane(void **state) {
    VtsOptions o = options_of_size(8, 8);
    Picture p = bench_render(*state, &o, LOOK_DOWN(5, 2)
        "light_source { <100, 200, 50> rgb <0.5, 1, 2> parallel point_at 0 }\n"
        "plane { y, 0 pigment { rgb <0.8, 0.4, 0.2> } finish { ambient rgb <0.1, 0.2, 0.3> diffuse 0.7 } }\n");
    double cosine = 200 / sqrt(100.0 * 100 + 200 * 200 + 50 * 50), light[3] = {.5, 1, 2}, pigment[3] = {.8, .4, .2}, ambient[3] = {.1, .2, .3};
    for (int k = 0; k < 3; k++) {
        double want = pigment[k] * (ambient[k] + .7 * cosine * light[k]);
        for (int i = 0; i < 64; i++) assert_true(fabs((double)pixel_at(&p, i % 8, i / 8)[k] - want) < 1e-5);
    }
    picture_free(&p);
}

/* Point light with POV-Ray's fade, 2 / (1 + (d / f)^p); each pixel at its middle. */
static void point_light_fades(void **state) {
    VtsOptions o = options_of_size(24, 24);
    o.samples = 1;
    Picture p = bench_render(*state, &o, LOOK_DOWN(9, 12)
        "light_source { <1, 2, -0.5> rgb 1 fade_distance 3 fade_power 2 }\n"
        "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n");
    for (int y = 0; y < 24; y++)
        for (int x = 0; x < 24; x++) {
            Vec3 at = vec3(12 * ((x + .5) / 24 - .5), 0, 12 * (.5 - (y + .5) / 24)), to = vec3_sub(vec3(1, 2, -.5), at);
            double d = vec3_length(to), want = to.y / d * 2 / (1 + d * d / 9);
            assert_true(fabs((double)pixel_at(&p, x, y)[0] - want) < 2e-4);
        }
    picture_free(&p);
}

static void spotlights_have_cones(void **state) {
    VtsOptions o = options_of_size(48, 48);
    o.samples = 1;
    Picture p = bench_render(*state, &o, LOOK_DOWN(9, 12)
        "light_source { <0, 4, 0> rgb 1 spotlight point_at 0 radius 20 falloff 40 tightness 0 }\n"
        "plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }\n");
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 48; x++) {
            Vec3 at = vec3(12 * ((x + .5) / 48 - .5), 0, 12 * (.5 - (y + .5) / 48));
            double c = 4 / vec3_length(vec3_sub(vec3(0, 4, 0), at)), angle = acos(c) / VTS_RADIANS, got = (double)pixel_at(&p, x, y)[0];
            if (angle < 19.9) assert_true(fabs(got - c) < 2e-4);
            if (angle > 40.1) assert_true(got == 0);
            if (angle > 21 && angle < 39) { /* falls between, smoothly in the cosine */
                double s = (c - cos(40 * VTS_RADIANS)) / (cos(20 * VTS_RADIANS) - cos(40 * VTS_RADIANS));
                assert_true(fabs(got - c * s * s * (3 - 2 * s)) < 2e-3);
            }
        }
    picture_free(&p);
}

static void fog_takes_exponentially(void **state) {
    VtsOptions o = options_of_size(16, 16);
    o.max_error = 0.25 / 255;
    Picture p = bench_render(*state, &o,
        "camera { location <0,2,0> direction z right x up y }\n"
        "background { rgb <0, 1, 0> }\n"
        "fog { distance 7 rgb <0.2, 0.3, 0.9> }\n"
        "plane { y, 0 pigment { rgb <1, 0, 0> } finish { ambient 1 diffuse 0 } }\n");
    double fog[3] = {.2, .3, .9}, red[3] = {1, 0, 0};
    for (int y = 0; y < 16; y++) {
        double want[3] = {0};
        for (int i = 0; i < 64; i++) { /* over the pixel's height */
            Vec3 d = vec3(.5 / 16, .5 - (y + (i + .5) / 64) / 16, 1); /* pixel 8 is the first right of the middle */
            double keep = y < 8 ? 0 : exp(2 / d.y * vec3_length(d) / 7);
            for (int k = 0; k < 3; k++) want[k] += (red[k] * keep + fog[k] * (1 - keep)) / 64;
        }
        for (int k = 0; k < 3; k++) assert_true(fabs((double)pixel_at(&p, 8, y)[k] - want[k]) < 4e-3);
    }
    picture_free(&p);
}

/* ---- frames ---- */

static const char solids[] =
    "camera { location <0, 2.4, -6> look_at <0, 0.7, 0> right x up y angle 45 }\n"
    "light_source { <-20, 30, -25> rgb 1 }\n"
    "background { rgb <0.2, 0.3, 0.5> }\n"
    "plane { y, 0 pigment { checker rgb 1, rgb 0.2 } }\n"
    "sphere { <-1, 1, 0>, 1 pigment { rgb <1, 0.4, 0.2> } finish { specular 0.5 roughness 0.02 } }\n"
    "torus { 0.7, 0.25 rotate 60*x translate <1.1, 0.8, -0.4> pigment { gradient y color_map { [0 rgb x] [1 rgb z] } } }\n"
    "box { <-0.3, 0, -1.6>, <0.3, 0.6, -1> rotate 20*y }\n";

static void a_region_is_a_crop(void **state) {
    VtsOptions o = options_of_size(60, 44);
    Picture whole = bench_render(*state, &o, solids);
    const int region[4] = {13, 7, 42, 40};
    memcpy(o.region, region, sizeof region);
    Picture part = bench_render(*state, &o, solids);
    assert_int_equal(part.width, 29);
    assert_int_equal(part.height, 33);
    for (int y = 0; y < part.height; y++)
        assert_memory_equal(pixel_at(&part, 0, y), pixel_at(&whole, 13, y + 7), 3 * sizeof(float) * 29);
    picture_free(&whole);
    picture_free(&part);
}

static void exposure_multiplies(void **state) {
    VtsOptions o = options_of_size(40, 30);
    Picture plain = bench_render(*state, &o, solids);
    o.exposure = -1.5;
    Picture dark = bench_render(*state, &o, solids);
    for (size_t i = 0; i < 3 * 40 * 30; i++)
        assert_true(fabs((double)dark.pixels[i] - (double)plain.pixels[i] * exp2(-1.5)) <= 1e-6 * (double)plain.pixels[i]);
    picture_free(&plain);
    picture_free(&dark);
}

/* Moved far away, or at another scale, the picture is the same but for pixels that rounding pushes over an edge. */
static void place_and_scale_do_not_matter(void **state) {
    static const char text[] =
        "#declare T = transform { scale %g translate <%g, %g, %g> }\n"
        "camera { location <0, 2.4, -6> look_at <0, 0.7, 0> right x up y angle 45 transform { T } }\n"
        "light_source { <-20, 30, -25> rgb 1 parallel point_at 0 transform { T } }\n"
        "background { rgb <0.2, 0.3, 0.5> }\n"
        "box { <-4, -1, -4>, <4, 0, 4> pigment { rgb 0.8 } transform { T } }\n"
        "sphere { <-1, 1, 0>, 1 pigment { rgb <1, 0.4, 0.2> } transform { T } }\n"
        "torus { 0.7, 0.25 rotate 60*x translate <1.1, 0.8, -0.4> pigment { rgb z } transform { T } }\n"
        "mesh { triangle { <-0.3, 0, -1.6>, <0.3, 0, -1.6>, <0, 0.8, -1> } pigment { rgb y } transform { T } }\n";
    static const struct { double scale, x, y, z, most; } cases[] = {{1, 1e5, -2e5, 1e5, 1e-3}, {1e-3, 0, 0, 0, .015}, {1e3, 0, 0, 0, 1e-3}, {1e3, 1e6, 0, 0, 1e-3}};
    VtsOptions o = options_of_size(64, 64);
    char scene[2048];
    snprintf(scene, sizeof scene, text, 1.0, 0.0, 0.0, 0.0);
    Picture plain = bench_render(*state, &o, scene);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        snprintf(scene, sizeof scene, text, cases[i].scale, cases[i].x, cases[i].y, cases[i].z);
        Picture other = bench_render(*state, &o, scene);
        Difference d = picture_difference(&plain, &other);
        printf("scale %g at <%g, %g, %g>: mean %+.1e rms %.1e most %.1e\n", cases[i].scale, cases[i].x, cases[i].y, cases[i].z, d.mean, d.rms, d.most);
        assert_true(d.rms < cases[i].most);
        picture_free(&other);
    }
    picture_free(&plain);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_covers_its_disc),    cmocka_unit_test(a_ball_casts_an_ellipse),
cmocka_unit_test(a_ball_covers_its_disc),    cmocka_unit_test(smooth_meshes_do_not_shade_themselves),
        cmocka_unit_test(parallel_light_on_a_plane), cmocka_unit_test(point_light_fades),
        cmocka_unit_test(spotlights_have_cones),     cmocka_unit_test(fog_takes_exponentially),
        cmocka_unit_test(a_region_is_a_crop),        cmocka_unit_test(exposure_multiplies),
        cmocka_unit_test(place_and_scale_do_not_matter),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
