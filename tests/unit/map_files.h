/* Maps written by tests: a folder, and writers of the formats that terrain reads. */
#ifndef VTS_TESTS_MAP_FILES_H
#define VTS_TESTS_MAP_FILES_H

#include "terrain/heightmap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MADE_MOST = 64 };

typedef struct Made {
    char folder[64], paths[MADE_MOST][128];
    int count; /* files of the folder */
    Arena arena;
    SourceSet sources;
    DiagList diags;
} Made;

static inline void made_begin(Made *m) {
    memset(m, 0, sizeof *m);
    strcpy(m->folder, "/tmp/vts_maps_XXXXXX");
    assert_non_null(mkdtemp(m->folder));
    arena_init(&m->arena, NULL, 0);
    source_set_init(&m->sources, &m->arena);
    diag_init(&m->diags, &m->arena, &m->sources);
}

static inline void made_end(Made *m) {
    for (int i = 0; i < m->count; i++) unlink(m->paths[i]);
    rmdir(m->folder);
    arena_destroy(&m->arena);
}

/* The path of a new file. */
static inline const char *made_file(Made *m, const char *name, const void *bytes, size_t size) {
    assert_true(m->count < MADE_MOST);
    char *path = m->paths[m->count++];
    strcpy(path, m->folder);
    strcat(path, "/");
    assert_true(strlen(path) + strlen(name) < sizeof m->paths[0]);
    strcat(path, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    fclose(f);
    return path;
}

static inline const char *made_text(Made *m, const char *name, const char *text) { return made_file(m, name, text, strlen(text)); }

/* Heights by column and row. */
typedef double MadeHeight(int column, int row);

static inline const char *made_hgt(Made *m, const char *name, int columns, int rows, MadeHeight *height) {
    unsigned char *bytes = malloc(2 * (size_t)columns * (size_t)rows), *at = bytes;
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            int h = (int)height(c, r);
            *at++ = (unsigned char)(h >> 8 & 255);
            *at++ = (unsigned char)(h & 255);
        }
    const char *path = made_file(m, name, bytes, (size_t)(at - bytes));
    free(bytes);
    return path;
}

/* `header` is all lines before the heights. */
static inline const char *made_grid(Made *m, const char *name, const char *header, int columns, int rows, MadeHeight *height) {
    StrBuf text = {0};
    strbuf_adds(&text, header);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) strbuf_addf(&text, "%.9g%c", height(c, r), c + 1 < columns ? ' ' : '\n');
    const char *path = made_file(m, name, text.data, text.size);
    strbuf_free(&text);
    return path;
}

typedef enum MadeSample { MADE_U16, MADE_I16, MADE_F32, MADE_F64 } MadeSample;

/* A GeoTIFF, little-endian; one strip, or square tiles. */
typedef struct MadeTiff {
    MadeSample sample;
    int columns, rows;
    MadeHeight *height;
    const double *scale, *tie, *affine; /* 3, 6 and 16 numbers, or NULL */
    uint16_t keys[16][4];               /* GeoKeys, without their header */
    int key_count;
    const char *nodata, *metadata; /* or NULL */
    int height_told;               /* 0: rows */
    int tile;                      /* side of its tiles, 0: none */
} MadeTiff;

typedef struct MadeTag {
    uint16_t tag, type;
    uint32_t count;
    const void *data;
    size_t size;
} MadeTag;

static inline size_t made_sample(const MadeTiff *t, double h, unsigned char out[8]) {
    uint16_t u = t->sample > MADE_I16 ? 0 : t->sample == MADE_I16 ? (uint16_t)(int16_t)h : (uint16_t)h;
    float f = (float)h;
    if (t->sample == MADE_F32) return (size_t)(memcpy(out, &f, 4), 4);
    if (t->sample == MADE_F64) return (size_t)(memcpy(out, &h, 8), 8);
    return (size_t)(memcpy(out, &u, 2), 2);
}

static inline const char *made_tiff(Made *m, const char *name, const MadeTiff *t) {
    enum { SHORT = 3, LONG = 4, DOUBLE = 12, ASCII = 2 };
    static const uint16_t bits[] = {16, 16, 32, 64}, formats[] = {1, 2, 3, 3};
    StrBuf file = {0}, extra = {0};
    uint16_t keys[17][4] = {{1, 1, 0, (uint16_t)t->key_count}}, one = 1, black = 1;
    memcpy(keys[1], t->keys, sizeof t->keys);
    uint32_t columns = (uint32_t)t->columns, rows = (uint32_t)(t->height_told ? t->height_told : t->rows), at = 8;
    uint32_t across = t->tile ? (columns + (uint32_t)t->tile - 1) / (uint32_t)t->tile : 1, down = t->tile ? (uint32_t)((t->rows + t->tile - 1) / t->tile) : 1;
    uint32_t tile_columns = t->tile ? (uint32_t)t->tile : columns, tile_rows = (uint32_t)(t->tile ? t->tile : t->rows);
    uint32_t bytes = tile_columns * tile_rows * bits[t->sample] / 8, parts = across * down, begins[64], sizes[64];
    assert_true(parts <= 64);
    for (uint32_t i = 0; i < parts; i++) begins[i] = 8 + i * bytes, sizes[i] = bytes;
    MadeTag tags[] = {{256, LONG, 1, &columns, 4},
                      {257, LONG, 1, &rows, 4},
                      {258, SHORT, 1, &bits[t->sample], 2},
                      {259, SHORT, 1, &one, 2},
                      {262, SHORT, 1, &black, 2},
                      {273, LONG, t->tile ? 0 : 1, &at, 4},
                      {277, SHORT, 1, &one, 2},
                      {278, LONG, t->tile ? 0 : 1, &rows, 4},
                      {279, LONG, t->tile ? 0 : 1, &bytes, 4},
                      {322, LONG, t->tile ? 1 : 0, &tile_columns, 4},
                      {323, LONG, t->tile ? 1 : 0, &tile_rows, 4},
                      {324, LONG, t->tile ? parts : 0, begins, 4 * (size_t)parts},
                      {325, LONG, t->tile ? parts : 0, sizes, 4 * (size_t)parts},
                      {339, SHORT, 1, &formats[t->sample], 2},
                      {33550, DOUBLE, t->scale ? 3 : 0, t->scale, 24},
                      {33922, DOUBLE, t->tie ? 6 : 0, t->tie, 48},
                      {34264, DOUBLE, t->affine ? 16 : 0, t->affine, 128},
                      {34735, SHORT, t->key_count ? 4 * (uint32_t)(t->key_count + 1) : 0, keys, 8 * (size_t)(t->key_count + 1)},
                      {42112, ASCII, t->metadata ? (uint32_t)strlen(t->metadata) + 1 : 0, t->metadata, t->metadata ? strlen(t->metadata) + 1 : 0},
                      {42113, ASCII, t->nodata ? (uint32_t)strlen(t->nodata) + 1 : 0, t->nodata, t->nodata ? strlen(t->nodata) + 1 : 0}};
    uint16_t tag_count = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(tags); i++) tag_count = (uint16_t)(tag_count + (tags[i].count > 0));
    uint32_t directory = 8 + (parts * bytes + 1) / 2 * 2, behind = directory + 2 + 12u * tag_count + 4, none = 0;
    strbuf_add(&file, "II*\0", 4);
    strbuf_add(&file, (const char *)&directory, 4);
    for (uint32_t i = 0; i < parts * tile_columns * tile_rows; i++) {
        uint32_t part = i / (tile_columns * tile_rows), within = i % (tile_columns * tile_rows);
        int c = (int)(part % across * tile_columns + within % tile_columns), r = (int)(part / across * tile_rows + within / tile_columns);
        unsigned char sample[8];
        size_t size = made_sample(t, c < t->columns && r < t->rows ? t->height(c, r) : 0, sample);
        strbuf_add(&file, (const char *)sample, size);
    }
    if (parts * bytes % 2) strbuf_add(&file, "\0", 1);
    strbuf_add(&file, (const char *)&tag_count, 2);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(tags); i++) {
        if (!tags[i].count) continue;
        char value[4] = {0};
        uint32_t offset = behind + (uint32_t)extra.size;
        if (tags[i].size <= 4)
            memcpy(value, tags[i].data, tags[i].size);
        else
            memcpy(value, &offset, 4);
        if (tags[i].size > 4) strbuf_add(&extra, tags[i].data, tags[i].size);
        if (extra.size % 2) strbuf_add(&extra, "\0", 1);
        strbuf_add(&file, (const char *)&tags[i].tag, 2);
        strbuf_add(&file, (const char *)&tags[i].type, 2);
        strbuf_add(&file, (const char *)&tags[i].count, 4);
        strbuf_add(&file, value, 4);
    }
    strbuf_add(&file, (const char *)&none, 4);
    if (extra.size) strbuf_add(&file, extra.data, extra.size);
    const char *path = made_file(m, name, file.data, file.size);
    strbuf_free(&file);
    strbuf_free(&extra);
    return path;
}

static inline const Heightmap *made_open(Made *m, const HeightmapOptions *options, const char *const *paths, size_t count) {
    static const HeightmapOptions plain = {0};
    return heightmap_open(paths, count, options ? options : &plain, &m->arena, &m->diags, (Span){0, (uint32_t)m->diags.failures, 0});
}

static inline const Heightmap *made_open_one(Made *m, const HeightmapOptions *options, const char *path) {
    const Heightmap *map = made_open(m, options, &path, 1);
    if (!map) print_message("%s\n", m->diags.last ? m->diags.last->message : "no message");
    assert_non_null(map);
    return map;
}

/* The ground at a place, NaN where there is none. */
static inline double made_ground(const Heightmap *map, double latitude, double longitude) {
    double height;
    return heightmap_height(map, (GeoPlace){latitude, longitude, 0}, &height) ? height : (double)NAN;
}

#endif
