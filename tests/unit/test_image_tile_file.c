/* Tiles of an unfinished picture: what is whole comes back, and nothing else. */
#include "image/tile_file.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

enum { TILES = 5, SAMPLES = 12, RECORD = 16 + SAMPLES * 4, HEADER = 48 };

typedef struct Bench {
    char folder[64], picture[80], file[96];
} Bench;

static const TileFileKey KEY = {.picture = 0x123456789abcdefu, .region = {0, 0, 64, 48}, .channels = 3, .tiles = TILES};

static void samples_of(uint32_t tile, float *out) {
    for (int i = 0; i < SAMPLES; i++) out[i] = (float)tile * 100 + (float)i / 7;
}

static void put(TileFile *t, uint32_t tile) {
    float samples[SAMPLES];
    samples_of(tile, samples);
    tile_file_write(t, tile, samples, SAMPLES);
}

/* -1: a tile came back that never was. */
static int count_whole(TileFile *t) {
    int count = 0;
    for (uint32_t tile = 0; tile < TILES; tile++) {
        float expected[SAMPLES], found[SAMPLES];
        samples_of(tile, expected);
        if (!tile_file_read(t, tile, found, SAMPLES)) continue;
        if (memcmp(expected, found, sizeof found) != 0) return -1;
        count++;
    }
    return count;
}

static size_t size_of(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 ? (size_t)info.st_size : 0;
}

static int set_up(void **state) {
    Bench *b = calloc(1, sizeof *b);
    strcpy(b->folder, "/tmp/vts-tiles-XXXXXX");
    if (!mkdtemp(b->folder)) return -1;
    snprintf(b->picture, sizeof b->picture, "%s/a.png", b->folder);
    snprintf(b->file, sizeof b->file, "%s.tiles-vts", b->picture);
    *state = b;
    return 0;
}

static int tear_down(void **state) {
    Bench *b = *state;
    remove(b->file);
    int left = rmdir(b->folder); /* nothing else may lie there */
    free(b);
    return left;
}

static void leave_three(const Bench *b) {
    TileFile *t = tile_file_open(b->picture, &KEY, false, 0);
    assert_non_null(t);
    put(t, 3), put(t, 0), put(t, 4);
    assert_int_equal(count_whole(t), 3);
    tile_file_close(t, false);
}

static void comes_back(void **state) {
    const Bench *b = *state;
    leave_three(b);
    assert_int_equal(size_of(b->file), HEADER + 3 * RECORD);
    TileFile *t = tile_file_open(b->picture, &KEY, true, 0);
    assert_int_equal(count_whole(t), 3);
    assert_int_equal(tile_file_taken(t), 3);
    float few[SAMPLES - 1];
    assert_false(tile_file_read(t, 0, few, SAMPLES - 1));
    assert_false(tile_file_read(t, TILES, few, SAMPLES - 1));
    put(t, 1), put(t, 0);
    assert_int_equal(count_whole(t), 4);
    tile_file_close(t, true);
    assert_int_equal(size_of(b->file), 0);
}

static void others_do_not(void **state) {
    const Bench *b = *state;
    TileFileKey keys[] = {KEY, KEY, KEY, KEY};
    keys[0].picture++, keys[1].region[2]++, keys[2].channels++, keys[3].tiles--;
    for (size_t i = 0; i < 4; i++) {
        leave_three(b);
        TileFile *t = tile_file_open(b->picture, &keys[i], true, 0);
        assert_int_equal(count_whole(t), 0);
        tile_file_close(t, false);
        assert_int_equal(size_of(b->file), 0); /* without tiles it goes */
    }
    leave_three(b);
    TileFile *t = tile_file_open(b->picture, &KEY, false, 0);
    assert_int_equal(count_whole(t), 0);
    tile_file_close(t, false);
}

/* Cut anywhere: all whole records before the cut. */
static void cut(void **state) {
    const Bench *b = *state;
    for (size_t size = 0; size <= HEADER + 3 * RECORD; size += 3) {
        leave_three(b);
        assert_int_equal(truncate(b->file, (off_t)size), 0);
        TileFile *t = tile_file_open(b->picture, &KEY, true, 0);
        assert_int_equal(count_whole(t), size < HEADER ? 0 : (size - HEADER) / RECORD);
        put(t, 2);
        assert_int_equal(count_whole(t), (size < HEADER ? 0 : (size - HEADER) / RECORD) + 1);
        tile_file_close(t, true);
    }
}

/* One bit wrong anywhere: its record and those behind it are gone. */
static void flipped(void **state) {
    const Bench *b = *state;
    for (size_t at = 0; at < HEADER + 3 * RECORD; at += 5) {
        leave_three(b);
        FILE *file = fopen(b->file, "r+b");
        assert_non_null(file);
        fseek(file, (long)at, SEEK_SET);
        int c = fgetc(file);
        fseek(file, (long)at, SEEK_SET);
        fputc(c ^ 0x10, file);
        fclose(file);
        TileFile *t = tile_file_open(b->picture, &KEY, true, 0);
        assert_int_equal(count_whole(t), at < HEADER ? 0 : (at - HEADER) / RECORD);
        tile_file_close(t, true);
    }
}

static void waits(void **state) {
    const Bench *b = *state;
    TileFile *t = tile_file_open(b->picture, &KEY, false, 1e6);
    put(t, 1);
    assert_int_equal(count_whole(t), 0);
    tile_file_close(t, false);
    assert_int_equal(size_of(b->file), 0);
}

static void full_disk(void **state) {
    const Bench *b = *state;
    struct rlimit before, small;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = HEADER + 2 * RECORD + 20;
    setrlimit(RLIMIT_FSIZE, &small);
    TileFile *t = tile_file_open(b->picture, &KEY, false, 0);
    put(t, 0), put(t, 1), put(t, 2), put(t, 3);
    assert_int_equal(count_whole(t), 2);
    tile_file_close(t, false);
    setrlimit(RLIMIT_FSIZE, &before);
    t = tile_file_open(b->picture, &KEY, true, 0);
    assert_int_equal(count_whole(t), 2);
    tile_file_close(t, true);
}

static void no_folder(void **state) {
    (void)state;
    assert_null(tile_file_open("/nowhere/at/all.png", &KEY, true, 0));
    tile_file_close(NULL, true);
    assert_int_equal(tile_file_taken(NULL), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comes_back), cmocka_unit_test(others_do_not), cmocka_unit_test(cut),       cmocka_unit_test(flipped),
        cmocka_unit_test(waits),      cmocka_unit_test(full_disk), cmocka_unit_test(no_folder),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
