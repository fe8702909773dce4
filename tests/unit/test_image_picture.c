/* Pyramids of pictures: means are kept, and what is seen from far is the mean. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "image/picture.h"

typedef struct Made {
    Arena arena;
    Image image;
    Picture picture;
} Made;

static void make(Made *m, int width, int height, int channels, uint64_t seed) {
    RandomStream random = {seed};
    arena_init(&m->arena, NULL, 0);
    assert_true(image_init(&m->image, width, height, channels, NULL, NULL, NULL));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *pixel = image_pixel(&m->image, x, y);
            float alpha = channels == 4 ? (float)random_next_unit(&random) : 1;
            for (int c = 0; c < channels; c++) pixel[c] = c == 3 ? alpha : alpha * (float)random_next_unit(&random);
        }
    picture_make(&m->image, &m->arena, &m->picture);
}

static void unmake(Made *m) {
    image_free(&m->image);
    arena_destroy(&m->arena);
}

static void mean_of_level(const PictureLevel *level, double mean[4]) {
    size_t count = (size_t)level->width * (size_t)level->height;
    for (int c = 0; c < 4; c++) mean[c] = 0;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++) mean[c] += (double)level->pixels[i][c] / (double)count;
}

static void every_level_has_the_same_mean(void **state) {
    (void)state;
    static const int sizes[][2] = {{1, 1}, {2, 2}, {3, 5}, {7, 1}, {64, 64}, {100, 37}, {1, 31}};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(sizes); k++) {
        Made m;
        double all[4], mean[4];
        make(&m, sizes[k][0], sizes[k][1], 4, k);
        mean_of_level(&m.picture.levels[0], all);
        for (int l = 1; l < m.picture.level_count; l++) {
            mean_of_level(&m.picture.levels[l], mean);
            for (int c = 0; c < 4; c++) assert_true(fabs(mean[c] - all[c]) < 1e-6);
        }
        assert_int_equal(m.picture.levels[m.picture.level_count - 1].width, 1);
        assert_int_equal(m.picture.levels[m.picture.level_count - 1].height, 1);
        unmake(&m);
    }
}

static PictureColor seen(const Picture *p, double u, double v, double du, double dv, PictureFilter filter) {
    PictureSpot spot = {u, v, {{du, 0}, {0, dv}}};
    return picture_color(p, &spot, filter, false);
}

static void from_far_the_mean_is_seen(void **state) {
    (void)state;
    Made m;
    double mean[4];
    make(&m, 48, 32, 3, 3);
    mean_of_level(&m.picture.levels[0], mean);
    for (int i = 0; i < 50; i++) {
        PictureColor c = seen(&m.picture, 0.37 * i, 0.61 * i, 8, 8, PICTURE_NEAREST);
        assert_true(fabs(c.red - mean[0]) < 1e-5 && fabs(c.green - mean[1]) < 1e-5 && fabs(c.blue - mean[2]) < 1e-5);
    }
    unmake(&m);
}

/* Whatever the footprint, what is seen all over the picture adds up to the same. */
static void the_mean_does_not_depend_on_the_footprint(void **state) {
    (void)state;
    static const double widths[][2] = {{0, 0}, {0.01, 0.01}, {0.03, 0.03}, {0.1, 0.1}, {0.3, 0.02}, {0.02, 0.2}, {0.5, 0.5}};
    Made m;
    double mean[4];
    make(&m, 32, 32, 3, 4);
    mean_of_level(&m.picture.levels[0], mean);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(widths); k++) {
        double red = 0;
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 128; i++)
                red += seen(&m.picture, (i + 0.5) / 128, (j + 0.5) / 128, widths[k][0], widths[k][1], PICTURE_NEAREST).red / (128 * 128);
        assert_true(fabs(red - mean[0]) < 1e-4);
    }
    unmake(&m);
}

/* What passes for nothing has no say in the colour of what is left. */
static void transparent_pixels_do_not_colour(void **state) {
    (void)state;
    Made m;
    make(&m, 8, 8, 4, 5);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++) {
            float *pixel = image_pixel(&m.image, x, y);
            bool there = (x + y) % 2;
            pixel[0] = pixel[3] = there ? 1 : 0;
            pixel[1] = pixel[2] = 0;
        }
    picture_make(&m.image, &m.arena, &m.picture);
    PictureColor c = seen(&m.picture, 0.3, 0.4, 0.5, 0.5, PICTURE_BILINEAR);
    assert_true(fabs(c.red - 1) < 1e-6 && c.green == 0 && fabs(c.alpha - 0.5) < 1e-6);
    unmake(&m);
}

/* A footprint of less than a pixel on the nearest one's colour: a box's mean, exactly. */
static void seams_are_as_wide_as_the_footprint(void **state) {
    (void)state;
    Made m;
    make(&m, 2, 1, 3, 6);
    double left = (double)image_pixel(&m.image, 0, 0)[0], right = (double)image_pixel(&m.image, 1, 0)[0];
    for (int i = -4; i <= 4; i++) {
        double t = i / 4.0; /* across a seam one tenth of a turn wide */
        PictureColor c = seen(&m.picture, 0.5 + t * 0.05, 0.5, 0.1, 0, PICTURE_NEAREST);
        assert_true(fabs(c.red - (left + (right - left) * (t + 1) / 2)) < 1e-6);
    }
    unmake(&m);
}

static void absurd_spots_do_no_harm(void **state) {
    (void)state;
    static const double odd[] = {0, 1e300, -1e300, 1e18, -5, 0.5, (double)INFINITY, (double)NAN};
    Made m;
    make(&m, 5, 3, 4, 7);
    size_t n = VTS_ARRAY_COUNT(odd);
    for (size_t i = 0; i < n * n * n; i++)
        for (int filter = 0; filter < 5; filter++)
            for (int once = 0; once < 2; once++) {
                PictureSpot spot = {odd[i % n], odd[i / n % n], {{odd[i / n / n], 0}, {0, odd[i % n]}}};
                picture_color(&m.picture, &spot, (PictureFilter)filter, once);
            }
    unmake(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_has_the_same_mean),
        cmocka_unit_test(from_far_the_mean_is_seen),
        cmocka_unit_test(the_mean_does_not_depend_on_the_footprint),
        cmocka_unit_test(transparent_pixels_do_not_colour),
        cmocka_unit_test(seams_are_as_wide_as_the_footprint),
        cmocka_unit_test(absurd_spots_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
