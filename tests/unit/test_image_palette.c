/* Tables of colours in files, and pixels as their numbers. The files are written here, byte by byte. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "image/palette.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool read_bytes(const void *bytes, size_t size, Palette *out) {
    char path[] = "palette-XXXXXX";
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    assert_true(write(handle, bytes, size) == (ssize_t)size);
    close(handle);
    bool found = palette_read(path, out);
    unlink(path);
    return found;
}

#define PNG_HEAD "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08"
static const char png[] = PNG_HEAD "\3\0\0\0cccc\0\0\0\1gAMAxcccc\0\0\0\6PLTE\1\2\3\xFA\xFB\xFC" "cccc\0\0\0\0IDAT";
static const char png_of_colors[] = PNG_HEAD "\2\0\0\0cccc\0\0\0\6PLTE\1\2\3\xFA\xFB\xFC" "cccc";
static const char png_of_no_table[] = PNG_HEAD "\3\0\0\0cccc\0\0\0\1IDATxcccc\0\0\0\6PLTE\1\2\3\xFA\xFB\xFC";
static const char png_far[] = PNG_HEAD "\3\0\0\0cccc\xFF\xFF\xFF\xFFgAMAxcccc";
static const char gif[] = "GIF89a\1\0\1\0\x80\0\0\1\2\3\xFA\xFB\xFC";
static const char gif_of_no_table[] = "GIF89a\1\0\1\0\0\0\0\1\2\3\xFA\xFB\xFC";
static const char bmp[] = "BM\0\0\0\0\0\0\0\0\0\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0\3\2\1\0\xFC\xFB\xFA\0";

static void tables_are_found(void **state) {
    (void)state;
    const struct { const char *bytes; size_t size; } files[] = {{png, sizeof png - 1}, {gif, sizeof gif - 1}, {bmp, sizeof bmp - 1}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(files); i++) {
        Palette palette;
        memset(&palette, 0x55, sizeof palette);
        assert_true(read_bytes(files[i].bytes, files[i].size, &palette));
        assert_int_equal(palette.count, 2);
        assert_memory_equal(palette.colors, "\1\2\3\xFA\xFB\xFC", 6);
    }
}

static void what_has_none_or_is_cut_off_has_none(void **state) {
    (void)state;
    Palette palette;
    assert_false(read_bytes(png_of_colors, sizeof png_of_colors - 1, &palette));
    assert_false(read_bytes(png_of_no_table, sizeof png_of_no_table - 1, &palette));
    assert_false(read_bytes(png_far, sizeof png_far - 1, &palette));
    assert_false(read_bytes(gif_of_no_table, sizeof gif_of_no_table - 1, &palette));
    assert_false(read_bytes("P5\n1 1\n255\nx", 12, &palette));
    for (size_t size = 0; size < sizeof gif - 1; size++) assert_false(read_bytes(gif, size, &palette));
    for (size_t size = 0; size < sizeof bmp - 1; size++) assert_false(read_bytes(bmp, size, &palette));
    assert_false(palette_read("there is no such file", &palette));
}

static void pixels_become_numbers(void **state) {
    (void)state;
    const Palette palette = {4, {{9, 9, 9}, {200, 0, 0}, {0, 0, 200}, {200, 0, 0}}};
    const float pixels[][3] = {{0, 0, 200}, {200, 0, 0}, {9, 9, 9}, {190, 0, 5}};
    const float numbers[] = {2, 1, 0, 1};
    Image image;
    assert_true(image_init(&image, 4, 1, 3, NULL, NULL, NULL));
    memcpy(image.pixels, pixels, sizeof pixels);
    palette_index(&palette, &image);
    assert_true(image.pixels[0] == 0 && image.pixels[2] == 200); /* floats stay */
    image.stored_as = IMAGE_SAMPLE_U8;
    palette_index(&palette, &image);
    for (int x = 0; x < 4; x++)
        for (int c = 0; c < 3; c++) assert_true(image_pixel(&image, x, 0)[c] == numbers[x]);
    image_free(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_found),
        cmocka_unit_test(what_has_none_or_is_cut_off_has_none),
        cmocka_unit_test(pixels_become_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
