/* PNG as other programs write it: the files were made by hand, with Python's zlib. */
#include "image/image.h"
#include "image/png_file.h"
#include "image/whole_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Two bits a pixel, by a palette: red, green with alpha 128, blue with alpha 0, white. */
static const unsigned char PALETTE[] = {
    137, 80,  78,  71,  13,  10,  26,  10,  0,   0,   0,  13, 73,  72, 68,  82,  0,  0,   0,  4,   0,  0,
    0,   1,   2,   3,   0,   0,   0,   132, 82,  231, 94, 0,  0,   0,  12,  80,  76, 84,  69, 255, 0,  0,
    0,   255, 0,   0,   0,   255, 255, 255, 255, 251, 0,  96, 246, 0,  0,   0,   3,  116, 82, 78,  83, 255,
    128, 0,   127, 109, 104, 120, 0,   0,   0,   10,  73, 68, 65,  84, 120, 218, 99, 144, 6,  0,   0,  29,
    0,   28,  35,  124, 143, 172, 0,   0,   0,   0,   73, 69, 78,  68, 174, 66,  96, 130,
};

/* 3 × 3, 16 bits, in Adam7's seven passes: 20000 y + 100 x. */
static const unsigned char INTERLACED[] = {
    137, 80, 78,  71,  13, 10,  26, 10,  0,   0,   0,   13,  73, 72,  68, 82,  0,   0,   0,   3,   0,   0,
    0,   3,  16,  0,   0,  0,   1,  84,  212, 6,   182, 0,   0,  0,   31, 73,  68,  65,  84,  120, 218, 99,
    96,  0,  130, 19,  12, 115, 28, 230, 114, 48,  48,  164, 48, 204, 89, 194, 224, 167, 224, 215, 226, 247,
    2,   0,  60,  147, 6,  100, 13, 32,  97,  191, 0,   0,   0,  0,   73, 69,  78,  68,  174, 66,  96,  130,
};

/* One pixel, 51 102 255, whose gAMA chunk says that it is light; and a title. */
static const unsigned char LINEAR[] = {
    137, 80,  78,  71,  13,  10, 26,  10,  0,   0,   0,   13, 73,  72, 68,  82,  0,   0,   0,  1,  0,   0,
    0,   1,   8,   2,   0,   0,  0,   144, 119, 83,  222, 0,  0,   0,  4,   103, 65,  77,  65, 0,  1,   134,
    160, 49,  232, 150, 95,  0,  0,   0,   12,  116, 69,  88, 116, 84, 105, 116, 108, 101, 0,  97, 32,  108,
    105, 110, 101, 75,  172, 26, 214, 0,   0,   0,   12,  73, 68,  65, 84,  120, 218, 99,  48, 78, 251, 15,
    0,   2,   104, 1,   153, 70, 214, 154, 0,   0,   0,   0,  0,   73, 69,  78,  68,  174, 66, 96, 130,
};

typedef struct File {
    const unsigned char *data;
    size_t size;
} File;

static const File FILES[] = {
    {PALETTE, sizeof PALETTE}, {INTERLACED, sizeof INTERLACED}, {LINEAR, sizeof LINEAR}};

static Image decode(File file, OiioHeader *header) {
    Image image;
    StrBuf error = {0};
    assert_true(png_file_recognizes(file.data, file.size));
    assert_true(png_file_decode(&image, file.data, file.size, "a.png", NULL, header, &error));
    assert_null(error.data);
    return image;
}

static void test_palettes_are_widened(void **state) {
    (void)state;
    static const float codes[4][4] = {
        {255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 0}, {255, 255, 255, 255}};
    OiioHeader header;
    Image image = decode(FILES[0], &header);
    assert_int_equal(image.width, 4);
    assert_int_equal(image.channels, 4);
    assert_int_equal(header.sample, IMAGE_SAMPLE_U8);
    assert_int_equal(header.alpha, 3);
    assert_true(header.alpha_unassociated && !header.linear);
    assert_memory_equal(image.pixels, codes, sizeof codes);
    image_free(&image);
}

static void test_interlaced_rows_are_put_together(void **state) {
    (void)state;
    OiioHeader header;
    Image image = decode(FILES[1], &header);
    assert_int_equal(header.sample, IMAGE_SAMPLE_U16);
    assert_int_equal(header.alpha, -1);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++) assert_true(*image_pixel(&image, x, y) == (float)(20000 * y + 100 * x));
    image_free(&image);
}

static void test_light_and_texts(void **state) {
    (void)state;
    OiioHeader header;
    Image image = decode(FILES[2], &header);
    assert_true(header.linear);
    const ImageAttribute *title = image_attribute(&image, "Title");
    assert_true(title && title->text);
    assert_string_equal(title->text, "a line");
    image_free(&image);
}

/* Through a file and the sRGB curve: only the colours of what does not say that it is light. */
static void test_loading_says_what_numbers_mean(void **state) {
    (void)state;
    char path[] = "/tmp/vts-png-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    Image image;
    assert_true(whole_file_replace(path, LINEAR, sizeof LINEAR, NULL));
    assert_true(image_load(&image, path, IMAGE_AS_COLOUR, NULL, NULL));
    assert_true(fabsf(image.pixels[0] - 0.2f) < 1e-6f && fabsf(image.pixels[1] - 0.4f) < 1e-6f);
    assert_true(image.stored_linear && image.stored_as == IMAGE_SAMPLE_U8);
    image_free(&image);
    assert_true(whole_file_replace(path, PALETTE, sizeof PALETTE, NULL));
    assert_true(image_load(&image, path, IMAGE_AS_COLOUR, NULL, NULL));
    assert_true(fabsf(image.pixels[5] - 128.0f / 255) < 1e-6f && image.pixels[10] == 0);
    image_free(&image);
    remove(path);
}

static void test_cut_files_are_refused(void **state) {
    (void)state;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(FILES); k++)
        for (size_t size = 4; size < FILES[k].size; size++) {
            Image image;
            OiioHeader header;
            StrBuf error = {0};
            unsigned char *data = malloc(size); /* of its own: reading past it would be seen */
            assert_non_null(data);
            memcpy(data, FILES[k].data, size);
            assert_false(png_file_decode(&image, data, size, "cut.png", NULL, &header, &error));
            assert_true(error.data && strstr(error.data, "cannot read 'cut.png': ") == error.data);
            strbuf_free(&error);
            free(data);
        }
}

/* Whatever comes out, nothing breaks. */
static void test_damage_is_borne(void **state) {
    (void)state;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(FILES); k++)
        for (size_t at = 8; at < FILES[k].size; at++) {
            unsigned char data[256];
            Image image;
            OiioHeader header;
            MemoryBudget budget = {.limit = 1 << 24};
            assert_true(FILES[k].size <= sizeof data);
            memcpy(data, FILES[k].data, FILES[k].size);
            data[at] ^= 0x41;
            if (png_file_decode(&image, data, FILES[k].size, "bad.png", &budget, &header, NULL))
                image_free(&image);
        }
}

static void test_what_is_written_is_read(void **state) {
    (void)state;
    static const uint16_t codes[2][2] = {{1, 65535}, {258, 0}};
    static const ImageAttribute notes[] = {
        {"vts:a", "plain", 0}, {"vts:b", "d\xc3\xa9j\xc3\xa0", 0}, {"vts:c", NULL, 0.1}};
    const OiioPicture picture = {.format = "png",
                                 .width = 1,
                                 .height = 2,
                                 .channels = 2,
                                 .sample = IMAGE_SAMPLE_U16,
                                 .data = codes,
                                 .alpha = 1,
                                 .srgb = true,
                                 .attributes = notes,
                                 .attribute_count = 3};
    StrBuf file = {0};
    char why[OIIO_ERROR_SIZE];
    assert_true(png_file_encode(&picture, &file, why));
    OiioHeader header;
    Image image = decode((File){(const unsigned char *)file.data, file.size}, &header);
    assert_true(image.width == 1 && image.height == 2 && image.channels == 2 && header.alpha == 1 &&
                !header.linear);
    for (int y = 0; y < 2; y++)
        for (int c = 0; c < 2; c++) assert_true(image_pixel(&image, 0, y)[c] == (float)codes[y][c]);
    assert_string_equal(image_attribute(&image, "vts:b")->text, notes[1].text);
    assert_true(strtod(image_attribute(&image, "vts:c")->text, NULL) == 0.1);
    image_free(&image);
    strbuf_free(&file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_palettes_are_widened),
        cmocka_unit_test(test_interlaced_rows_are_put_together),
        cmocka_unit_test(test_light_and_texts),
        cmocka_unit_test(test_loading_says_what_numbers_mean),
        cmocka_unit_test(test_cut_files_are_refused),
        cmocka_unit_test(test_damage_is_borne),
        cmocka_unit_test(test_what_is_written_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
