/* TIFFs made byte by byte, with whatever tags a test wants, right and wrong. */
#ifndef VTS_TESTS_TIFF_BYTES_H
#define VTS_TESTS_TIFF_BYTES_H

#include "base/common.h"

#include <stdio.h>
#include <string.h>

enum { TIFF_ASCII_TYPE = 2, TIFF_SHORT_TYPE = 3, TIFF_LONG_TYPE = 4, TIFF_DOUBLE_TYPE = 12, TIFF_TAGS_MOST = 40, TIFF_BYTES_MOST = 65536 };

typedef struct TiffTag {
    uint16_t tag, type;
    uint32_t count;
    const void *data; /* uint16_t, uint32_t, char, double as the type says */
} TiffTag;

typedef struct TiffBytes {
    uint8_t bytes[TIFF_BYTES_MOST];
    size_t size;
    bool big; /* endian */
    TiffTag tags[TIFF_TAGS_MOST];
    size_t tag_count;
    uint32_t width, height; /* of 16-bit samples, which are their own index */
} TiffBytes;

static inline void tiff_put(TiffBytes *t, size_t at, uint64_t value, int bytes) {
    for (int i = 0; i < bytes; i++) t->bytes[at + (size_t)i] = (uint8_t)(value >> 8 * (t->big ? bytes - 1 - i : i));
}

static inline void tiff_add(TiffBytes *t, uint16_t tag, uint16_t type, uint32_t count, const void *data) {
    t->tags[t->tag_count++] = (TiffTag){tag, type, count, data};
}

static inline uint64_t tiff_value(const TiffTag *tag, uint32_t i) {
    uint64_t bits;
    switch (tag->type) {
    case TIFF_SHORT_TYPE: return ((const uint16_t *)tag->data)[i];
    case TIFF_LONG_TYPE: return ((const uint32_t *)tag->data)[i];
    case TIFF_DOUBLE_TYPE: memcpy(&bits, (const double *)tag->data + i, sizeof bits); return bits;
    default: return ((const uint8_t *)tag->data)[i];
    }
}

static inline void tiff_put_tag(TiffBytes *t, size_t at, const TiffTag *tag) {
    int size = tag->type == TIFF_SHORT_TYPE ? 2 : tag->type == TIFF_LONG_TYPE ? 4 : tag->type == TIFF_DOUBLE_TYPE ? 8 : 1;
    bool inside = tag->count * (uint32_t)size <= 4;
    tiff_put(t, at, tag->tag, 2);
    tiff_put(t, at + 2, tag->type, 2);
    tiff_put(t, at + 4, tag->count, 4);
    size_t to = inside ? at + 8 : t->size;
    if (!inside) {
        tiff_put(t, at + 8, t->size, 4);
        t->size += tag->count * (uint32_t)size + (tag->count & 1);
    }
    for (uint32_t i = 0; i < tag->count; i++) tiff_put(t, to + i * (uint32_t)size, tiff_value(tag, i), size);
}

/* Lays out the file: header, samples, directory, what the tags point at. Tags beyond the picture's own are to be added in rising order. */
static inline void tiff_finish(TiffBytes *t) {
    uint32_t pixels = t->width * t->height, samples = pixels * 2, at = 8;
    uint16_t sixteen = 16, one = 1;
    const TiffTag own[] = {{256, TIFF_LONG_TYPE, 1, &t->width}, {257, TIFF_LONG_TYPE, 1, &t->height}, {258, TIFF_SHORT_TYPE, 1, &sixteen},
                           {259, TIFF_SHORT_TYPE, 1, &one},     {262, TIFF_SHORT_TYPE, 1, &one},      {273, TIFF_LONG_TYPE, 1, &at},
                           {277, TIFF_SHORT_TYPE, 1, &one},     {278, TIFF_LONG_TYPE, 1, &t->height}, {279, TIFF_LONG_TYPE, 1, &samples}};
    size_t count = VTS_ARRAY_COUNT(own) + t->tag_count, directory = at + samples;
    memset(t->bytes, 0, sizeof t->bytes);
    memcpy(t->bytes, t->big ? "MM" : "II", 2);
    tiff_put(t, 2, 42, 2);
    tiff_put(t, 4, directory, 4);
    for (uint32_t i = 0; i < pixels; i++) tiff_put(t, at + 2 * i, i, 2);
    tiff_put(t, directory, count, 2);
    t->size = directory + 2 + 12 * count + 4;
    for (size_t i = 0; i < count; i++)
        tiff_put_tag(t, directory + 2 + 12 * i, i < VTS_ARRAY_COUNT(own) ? &own[i] : &t->tags[i - VTS_ARRAY_COUNT(own)]);
}

static inline bool tiff_write(const char *path, const uint8_t *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    bool ok = file && fwrite(bytes, 1, size, file) == size;
    return file && fclose(file) == 0 && ok;
}

#endif
