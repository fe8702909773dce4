/* What neighbours tell of pixels of few samples. */
#include "base/random.h"
#include "render/beam_settle.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = FILM_TILE, PIXELS = SIDE * SIDE, SAMPLES = 16 };

/* Evenly distributed within ±1. */
static double random_of(int pixel, int what) { return 2 * random_unit(random_hash((uint64_t)pixel, (uint64_t)what, 0, 5)) - 1; }

typedef float Truth(int x, int y);
static float even(int x, int y) { return (void)x, (void)y, 0.5f; }
static float wall(int x, int y) { return (void)y, x < SIDE / 2 ? 0.1f : 0.9f; }
static float slope(int x, int y) { return 0.2f + 0.004f * (float)(x + y); }

/* A tile that noise of a mean square `error` lies on, which the allotment knows. */
static void draw(Truth *truth, double error, Allotment *a, Radiance *pixels) {
    *a = (Allotment){.columns = SIDE, .rows = SIDE};
    for (int i = 0; i < PIXELS; i++) {
        float noise = (float)(sqrt(3 * error) * random_of(i, 1)), value = truth(i % SIDE, i / SIDE) + noise;
        pixels[i] = (Radiance){vec3f(value, 2 * value, value / 2), value};
        a->taken[i] = SAMPLES;
        a->noise[i] = (float)allot_noise(error * (1 + 4 + 0.25) / 3, SAMPLES);
    }
}

static double wrong(Truth *truth, const Radiance *pixels) {
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        float value = truth(i % SIDE, i / SIDE);
        double r = (double)(pixels[i].color.x - value), g = (double)(pixels[i].color.y - 2 * value), b = (double)(pixels[i].color.z - value / 2);
        sum += (r * r + g * g + b * b) / 3;
    }
    return sum / PIXELS;
}

static void test_noise_goes_where_nothing_differs(void **state) {
    (void)state;
    Allotment a;
    static Radiance pixels[PIXELS];
    draw(even, 1e-3, &a, pixels);
    double before = wrong(even, pixels), told = beam_settle(&a, pixels), after = wrong(even, pixels);
    assert_true(after < 0.2 * before);
    assert_true(told > 0.6 * after && told < 2.5 * after); /* noise counts as if it were random, which is 1.4 times this one */
    draw(slope, 1e-3, &a, pixels);
    before = wrong(slope, pixels);
    beam_settle(&a, pixels);
    assert_true(wrong(slope, pixels) < 0.25 * before);
}

static void test_edges_stay(void **state) {
    (void)state;
    Allotment a;
    static Radiance pixels[PIXELS];
    draw(wall, 1e-4, &a, pixels);
    double before = wrong(wall, pixels);
    beam_settle(&a, pixels);
    assert_true(wrong(wall, pixels) < before);
    for (int y = 0; y < SIDE; y++) {
        assert_true(fabsf(pixels[y * SIDE + SIDE / 2 - 1].color.x - 0.1f) < 0.05f);
        assert_true(fabsf(pixels[y * SIDE + SIDE / 2].color.x - 0.9f) < 0.05f);
    }
}

/* Opacity belongs to a colour: both are linear in what samples see, and stay so. */
static void test_opacity_goes_with_colour(void **state) {
    (void)state;
    Allotment a;
    static Radiance pixels[PIXELS];
    draw(slope, 1e-3, &a, pixels);
    beam_settle(&a, pixels);
    for (int i = 0; i < PIXELS; i++) assert_true(fabsf(pixels[i].color.x - pixels[i].alpha) < 1e-5f && fabsf(pixels[i].color.y - 2 * pixels[i].alpha) < 1e-5f);
}

static void test_what_has_no_noise_stays(void **state) {
    (void)state;
    Allotment a;
    static Radiance pixels[PIXELS];
    draw(wall, 0, &a, pixels);
    assert_true(beam_settle(&a, pixels) == 0);
    assert_true(wrong(wall, pixels) == 0);
}

/* What is no number stays alone, and so do those beside it. */
static void test_no_number_does_not_spread(void **state) {
    (void)state;
    static Radiance pixels[PIXELS], before[PIXELS];
    const float none[] = {NAN, INFINITY};
    for (int k = 0; k < 2; k++) {
        Allotment a;
        const int bad = SIDE * SIDE / 2 + SIDE / 2;
        draw(even, 1e-3, &a, pixels);
        pixels[bad].color.y = none[k];
        memcpy(before, pixels, sizeof before);
        assert_true(isfinite(beam_settle(&a, pixels)));
        for (int i = 0; i < PIXELS; i++) assert_int_equal(isfinite(pixels[i].color.x + pixels[i].color.y + pixels[i].color.z), i != bad);
        assert_memory_equal(&pixels[bad + 1], &before[bad + 1], sizeof *pixels);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_noise_goes_where_nothing_differs), cmocka_unit_test(test_edges_stay),
                                       cmocka_unit_test(test_opacity_goes_with_colour), cmocka_unit_test(test_what_has_no_noise_stays),
                                       cmocka_unit_test(test_no_number_does_not_spread)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
