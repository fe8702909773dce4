/* The sRGB curve against its closed form, and error metrics against sums by hand. */
#include "image/metrics.h"
#include "image/srgb.h"

#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static long double encode_exactly(long double x) {
    return x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
}

static void test_curve_is_the_closed_form(void **state) {
    (void)state;
    for (int i = 0; i <= 100000; i++) {
        double x = i / 100000.0;
        assert_true(fabsl((long double)srgb_encode(x) - encode_exactly((long double)x)) < 1e-15L);
        assert_true(fabs(srgb_decode(srgb_encode(x)) - x) <
                    3e-8 + 1e-14); /* the standard's two pieces nearly meet */
    }
}

static void test_curve_at_its_ends(void **state) {
    (void)state;
    assert_true(srgb_encode(0) == 0 && srgb_encode(1) == 1 && srgb_decode(0) == 0);
    assert_true(fabs(srgb_decode(1) - 1) < 1e-15);
    assert_true(srgb_encode(-1) == 0 && srgb_encode(2) == 1 && srgb_encode((double)NAN) == 0 &&
                srgb_decode((double)NAN) == 0);
    assert_true(srgb_encode((double)INFINITY) == 1);
    for (int code = 0; code < 256; code++) /* every 8-bit code survives */
        assert_int_equal(lrint(srgb_encode(srgb_decode(code / 255.0)) * 255), code);
}

static void test_difference_by_hand(void **state) {
    (void)state;
    Image a, b;
    assert_true(image_init(&a, 5, 3, 3, NULL, NULL, NULL));
    assert_true(image_init(&b, 5, 3, 3, NULL, NULL, NULL));
    ImageDifference d;
    assert_true(image_compare(&a, &b, &d, NULL));
    assert_true(d.rmse == 0 && isinf(d.psnr) && d.largest == 0);
    image_pixel(&b, 4, 1)[1] = 0.5f;
    assert_true(image_compare(&a, &b, &d, NULL));
    double coded = 1.055 * pow(0.5, 1 / 2.4) - 0.055;
    assert_true(fabs(d.rmse - sqrt(0.25 / 45)) < 1e-12);
    assert_true(fabs(d.psnr - 10 * log10(45 / (coded * coded))) < 1e-9);
    assert_true(d.x == 4 && d.y == 1 && d.largest == 0.5);
    /* Past white there is no difference; nor below black. */
    image_pixel(&a, 0, 0)[0] = 1;
    image_pixel(&b, 0, 0)[0] = 7;
    image_pixel(&b, 1, 0)[0] = -3;
    assert_true(image_compare(&a, &b, &d, NULL));
    assert_true(fabs(d.rmse - sqrt(0.25 / 45)) < 1e-12);
    image_pixel(&b, 2, 2)[2] = NAN;
    assert_true(image_compare(&a, &b, &d, NULL));
    assert_true(d.not_finite == 1 && isfinite(d.rmse));
    image_free(&a);
    image_free(&b);
}

static void test_channels_are_matched_by_name(void **state) {
    (void)state;
    const char *const names[] = {"Z", "B", "A", "G", "R"};
    Image a, b, grey;
    assert_true(image_init(&a, 8, 8, 3, NULL, NULL, NULL));
    assert_true(image_init(&b, 8, 8, 5, names, NULL, NULL));
    assert_true(image_init(&grey, 8, 8, 1, NULL, NULL, NULL));
    RandomStream random = {3};
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            for (int c = 0; c < 3; c++) {
                float value = (float)random_next_unit(&random);
                image_pixel(&a, x, y)[c] = value;
                image_pixel(&b, x, y)[c == 0 ? 4 : c == 1 ? 3 : 1] = value;
                image_pixel(&b, x, y)[0] = 9;
            }
    ImageDifference d;
    assert_true(image_compare(&a, &b, &d, NULL));
    assert_true(d.rmse == 0);
    for (int i = 0; i < 64; i++) {
        grey.pixels[i] = 0.25f;
        for (int c = 0; c < 3; c++) a.pixels[3 * i + c] = 0.25f;
    }
    assert_true(image_compare(&a, &grey, &d, NULL));
    assert_true(d.rmse == 0);
    image_free(&grey);
    image_free(&b);
    image_free(&a);
}

static void test_sizes_must_agree(void **state) {
    (void)state;
    Image a, b;
    assert_true(image_init(&a, 2, 3, 1, NULL, NULL, NULL));
    assert_true(image_init(&b, 3, 2, 1, NULL, NULL, NULL));
    StrBuf error = {0};
    ImageDifference d;
    assert_false(image_compare(&a, &b, &d, &error));
    assert_non_null(strstr(error.data, "2 x 3"));
    strbuf_free(&error);
    image_free(&a);
    image_free(&b);
}

static void test_sizes_out_of_range(void **state) {
    (void)state;
    Image image;
    const int sizes[][3] = {
        {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {-1, 1, 1}, {1 << 21, 1, 1}, {1 << 20, 1 << 20, 4}, {1, 1, 5000}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sizes); i++) {
        StrBuf error = {0};
        assert_false(image_init(&image, sizes[i][0], sizes[i][1], sizes[i][2], NULL, NULL, &error));
        assert_true(error.size > 0);
        strbuf_free(&error);
        image_free(&image);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curve_is_the_closed_form), cmocka_unit_test(test_curve_at_its_ends),
        cmocka_unit_test(test_difference_by_hand),       cmocka_unit_test(test_channels_are_matched_by_name),
        cmocka_unit_test(test_sizes_must_agree),         cmocka_unit_test(test_sizes_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
