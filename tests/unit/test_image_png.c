/* PNG files of our own, against the standard: chunks, their sums, and what is packed in them. */
#include "image/png.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"

/* Bit by bit, as the standard defines it. */
static uint32_t crc_of(const unsigned char *data, size_t size) {
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xEDB88320 ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static uint32_t u32(const char *at) {
    const unsigned char *b = (const unsigned char *)at;
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* The index-th chunk; its size, or -1 behind the last. */
static long chunk(const StrBuf *file, int index, char kind[5], const char **data) {
    size_t at = 8;
    for (int i = 0; at < file->size; i++) {
        uint32_t size = u32(file->data + at);
        assert_true(at + 12 + size <= file->size);
        if (i == index) {
            memcpy(kind, file->data + at + 4, 4);
            kind[4] = 0;
            *data = file->data + at + 8;
            assert_int_equal(u32(*data + size), crc_of((const unsigned char *)file->data + at + 4, size + 4));
            return (long)size;
        }
        at += 12 + size;
    }
    return -1;
}

static StrBuf encoded(int width, int height, int channels, bool wide, const ImageAttribute *attributes,
                      size_t attribute_count) {
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    uint16_t *codes = malloc(count * sizeof *codes);
    for (size_t i = 0; i < count; i++) codes[i] = (uint16_t)(random_mix(i) & (wide ? 0xFFFF : 0xFF));
    const PngPicture picture = {width, height, channels, wide, codes, attributes, attribute_count};
    StrBuf file = {0};
    assert_true(png_encode(&picture, &file));
    free(codes);
    return file;
}

static void test_header_tells_the_picture(void **state) {
    (void)state;
    static const unsigned char types[] = {0, 0, 4, 2, 6};
    for (int channels = 1; channels <= 4; channels++)
        for (int wide = 0; wide < 2; wide++) {
            StrBuf file = encoded(7, 3, channels, wide, NULL, 0);
            char kind[5];
            const char *data = NULL;
            assert_memory_equal(file.data, "\x89PNG\r\n\x1A\n", 8);
            assert_int_equal(chunk(&file, 0, kind, &data), 13);
            assert_string_equal(kind, "IHDR");
            assert_int_equal(u32(data), 7);
            assert_int_equal(u32(data + 4), 3);
            assert_int_equal(data[8], wide ? 16 : 8);
            assert_int_equal((unsigned char)data[9], types[channels]);
            strbuf_free(&file);
        }
}

/* Large enough for several chunks; the end is the end. */
static void test_chunks_are_whole(void **state) {
    (void)state;
    StrBuf file = encoded(1200, 900, 3, false, NULL, 0);
    char kind[5] = "";
    const char *data;
    int parts = 0, i = 0;
    for (; chunk(&file, i, kind, &data) >= 0; i++) parts += strcmp(kind, "IDAT") == 0;
    assert_true(parts > 1);
    assert_string_equal(kind, "IEND");
    strbuf_free(&file);
}

static void test_texts_are_kept(void **state) {
    (void)state;
    char name[100];
    memset(name, 'x', 99);
    name[99] = 0;
    const ImageAttribute attributes[] = {{"a:text", "hello", 0},
                                         {"b", NULL, 0.5},
                                         {"c",
                                          "Stra\xC3\x9F"
                                          "e",
                                          0},
                                         {name, "too long a name", 0}};
    StrBuf file = encoded(2, 2, 3, false, attributes, 4);
    char kind[5];
    const char *data;
    int texts = 0;
    for (int i = 0; chunk(&file, i, kind, &data) >= 0; i++) {
        if (strcmp(kind, "tEXt") == 0 && texts++ == 0)
            assert_memory_equal(data, "a:text\0hello", 12);
        else if (strcmp(kind, "tEXt") == 0)
            assert_memory_equal(data,
                                "b\0"
                                "0.5",
                                5);
        if (strcmp(kind, "iTXt") == 0)
            assert_memory_equal(data,
                                "c\0\0\0\0\0Stra\xC3\x9F"
                                "e",
                                13);
    }
    assert_int_equal(texts, 2);
    strbuf_free(&file);
}

static void test_equal_pictures_are_equal_files(void **state) {
    (void)state;
    StrBuf a = encoded(33, 21, 4, true, NULL, 0), b = encoded(33, 21, 4, true, NULL, 0);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    strbuf_free(&a);
    strbuf_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_header_tells_the_picture), cmocka_unit_test(test_chunks_are_whole),
        cmocka_unit_test(test_texts_are_kept), cmocka_unit_test(test_equal_pictures_are_equal_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
