/* NanoVDB files of a writer of the test's own: what stands where in them is written down here a second time. */
#include "base/random.h"
#include "volume/nanovdb.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

enum { GRID = 672, ROOT = GRID + 64, UPPER = ROOT + 64 + 2 * 32, LOWER = UPPER + 270400, LEAF = LOWER + 33856, LEAF_FLOATS = 96 + 2048, MOST = LEAF + 3 * LEAF_FLOATS };

static Arena arena;
static unsigned char grid[MOST], file[2 * MOST + 4096];

static void put(unsigned char *at, uint64_t value, int width) {
    for (int k = 0; k < width; k++) at[k] = (unsigned char)(value >> 8 * k);
}

static void put_float(unsigned char *at, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(at, bits, 4);
}

static void put_double(unsigned char *at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(at, bits, 8);
}

static uint64_t key_of(int x, int y, int z) { return (uint64_t)((uint32_t)z >> 12) | (uint64_t)((uint32_t)y >> 12) << 21 | (uint64_t)((uint32_t)x >> 12) << 42; }

/* What the cell holds that is written below: a leaf at <8, 0, 16>, a tile of 8³ at <0, 0, 16>, nothing else near. */
static float value_of(int x, int y, int z) { return (float)(x % 8) + 0.125f * (float)(y % 8) + 8 * (float)(z % 8); }

/* A box from <2, 1, 17> to <13, 7, 22>, voxels of size 1/2, shifted by <10, 20, 30>. */
static void write_grid(void) {
    memset(grid, 0, sizeof grid);
    memcpy(grid, "NanoVDB0", 8);
    put(grid + 16, (uint64_t)32 << 21, 4);
    for (int k = 0; k < 3; k++) put_double(grid + 296 + 88 + 32 * k, 0.5);
    for (int k = 0; k < 3; k++) put_double(grid + 296 + 232 + 8 * k, 10 * (k + 1));
    put(grid + 636, 1, 4);
    put(grid + GRID + 24, 64, 8);
    const int box[6] = {2, 1, 17, 13, 7, 22};
    for (int k = 0; k < 6; k++) put(grid + ROOT + 4 * k, (uint64_t)box[k], 4);
    put(grid + ROOT + 24, 2, 4);
    put(grid + ROOT + 64, key_of(0, 0, 0), 8);
    put(grid + ROOT + 64 + 8, UPPER - ROOT, 8);
    put(grid + ROOT + 96, key_of(-4096, 0, 0), 8); /* nothing of the box lies there */
    put(grid + UPPER + 4128, 1, 1);
    put(grid + UPPER + 8256, LOWER - UPPER, 8);
    int tile = 2, leaf = 1 << 8 | 2;
    put_float(grid + LOWER + 1088 + 8 * tile, 0.25f);
    put(grid + LOWER + 544 + leaf / 8, 1u << leaf % 8, 1);
    put(grid + LOWER + 1088 + 8 * leaf, LEAF - LOWER, 8);
    for (int i = 0; i < 512; i++) put_float(grid + LEAF + 96 + 4 * i, value_of(i >> 6, i >> 3 & 7, i & 7));
}

/* A header and entries for two grids "smoke" and "fire", which are the same but for one number. */
static size_t write_file(bool zip) {
    unsigned char *at = file + 16;
    memset(file, 0, 512);
    memcpy(file, "NanoVDB0", 8);
    put(file + 12, 2, 2);
    unsigned char *entries[2];
    for (int i = 0; i < 2; i++) {
        entries[i] = at;
        put(at, sizeof grid, 8);
        put(at + 8, sizeof grid, 8);
        put(at + 136, 6, 4);
        put(at + 168, zip, 2);
        memcpy(at + 176, i ? "fire\0\0" : "smoke", 6);
        at += 176 + 6;
    }
    for (int i = 0; i < 2; i++) {
        if (i) put_float(grid + LOWER + 1088 + 16, 0.75f);
        uLongf size = (uLongf)(file + sizeof file - at);
        if (zip) {
            assert_int_equal(compress(at + 8, &size, grid, sizeof grid), Z_OK);
            put(at, size, 8);
            put(entries[i] + 8, size + 8, 8);
            at += size + 8;
        } else {
            memcpy(at, grid, sizeof grid);
            at += sizeof grid;
        }
    }
    return (size_t)(at - file);
}

static float found(const DensityGrid *g, int x, int y, int z) { return g->values[((z - 17) * g->size[1] + y - 1) * g->size[0] + x - 2]; }

static void assert_near(double a, double b) {
    if (!(fabs(a - b) <= 1e-12)) fail_msg("found %.17g, not %.17g", a, b);
}

static void check(const DensityGrid *g, float tile) {
    assert_int_equal(g->size[0], 12);
    assert_int_equal(g->size[1], 7);
    assert_int_equal(g->size[2], 6);
    assert_int_equal(g->bad, 0);
    for (int z = 17; z <= 22; z++)
        for (int y = 1; y <= 7; y++)
            for (int x = 2; x <= 13; x++) assert_float_equal(found(g, x, y, z), x < 8 ? tile : value_of(x, y, z), 0);
    /* Middles of voxels lie at whole numbers: the box begins half a voxel before. */
    Transform place = transform_of(&g->place);
    Vec3 low = transform_point(&place, vec3_splat(0)), high = transform_point(&place, vec3_splat(1));
    assert_near(low.x, 10 + 0.5 * 1.5);
    assert_near(low.y, 20 + 0.5 * 0.5);
    assert_near(high.z, 30 + 0.5 * 22.5);
}

static void grids_are_read_by_their_names(void **state) {
    (void)state;
    for (int zip = 0; zip < 2; zip++) {
        DensityGrid g;
        write_grid();
        size_t size = write_file(zip);
        assert_true(nanovdb_decode(file, size, NULL, &arena, &g, NULL));
        assert_true(g.placed);
        check(&g, 0.25f);
        assert_true(nanovdb_decode(file, size, "fire", &arena, &g, NULL));
        check(&g, 0.75f);
        StrBuf error = {0};
        assert_false(nanovdb_decode(file, size, "fir", &arena, &g, &error));
        assert_string_equal(error.data, "no grid in it has this name");
        strbuf_free(&error);
    }
}

/* Codes of 4, 8, 16 and as many bits as the leaf says. */
static void packed_numbers_are_read(void **state) {
    (void)state;
    static const struct {
        int type, width, flags;
    } kinds[] = {{13, 4, 0}, {14, 8, 0}, {15, 16, 0}, {16, 1, 0}, {16, 2, 1 << 5}, {16, 8, 3 << 5}, {16, 16, 4 << 5}};
    for (size_t n = 0; n < VTS_ARRAY_COUNT(kinds); n++) {
        DensityGrid g;
        int width = kinds[n].width;
        write_grid();
        put(grid + 636, (uint64_t)kinds[n].type, 4);
        memset(grid + LEAF + 80, 0, LEAF_FLOATS - 80);
        grid[LEAF + 15] = (unsigned char)kinds[n].flags;
        put_float(grid + LEAF + 80, 0.5f), put_float(grid + LEAF + 84, 0.25f);
        for (int i = 0; i < 512; i++) {
            unsigned code = (unsigned)(i * 7) & ((1u << width) - 1);
            if (width == 16) put(grid + LEAF + 96 + 2 * i, code, 2);
            else grid[LEAF + 96 + i * width / 8] |= (unsigned char)(code << i * width % 8);
        }
        assert_true(nanovdb_decode(file, write_file(false), NULL, &arena, &g, NULL));
        for (int x = 8; x <= 13; x++) {
            int i = (x - 8) << 6 | 3 << 3 | 4;
            assert_float_equal(found(&g, x, 3, 20), 0.5f + 0.25f * (float)((unsigned)(i * 7) & ((1u << width) - 1)), 0);
        }
    }
}

static void bad_numbers_are_told(void **state) {
    (void)state;
    DensityGrid g;
    write_grid();
    put_float(grid + LEAF + 96 + 4 * (2 << 6 | 3 << 3 | 4), NAN);
    assert_true(nanovdb_decode(file, write_file(false), NULL, &arena, &g, NULL));
    assert_int_equal(g.bad, 1 + (20 - 17) * 7 * 12 + (3 - 1) * 12 + (10 - 2));
}

/* Cut anywhere, or with any byte of its heads and tables changed: refused or read, and nothing outside is touched (the file ends where its memory does). */
static void damage_does_no_harm(void **state) {
    (void)state;
    RandomStream random = {5};
    write_grid();
    size_t size = write_file(false);
    for (int i = 0; i < 400; i++) {
        DensityGrid g;
        size_t cut = i < 40 ? (size_t)i * 10 : i < 120 ? random_next(&random) % size : size;
        unsigned char *copy = malloc(cut + 1);
        memcpy(copy, file, cut);
        static const int places[] = {0, 380, 380 + GRID, 380 + ROOT, 380 + UPPER + 4128, 380 + UPPER + 8256, 380 + LOWER + 544, 380 + LOWER + 1088};
        for (int k = 0; i >= 120 && k < 1 + i % 4; k++) {
            size_t at = (size_t)places[random_next(&random) % VTS_ARRAY_COUNT(places)] + random_next(&random) % 96;
            if (at < cut) copy[at] = (unsigned char)random_next(&random);
        }
        ArenaMark mark = arena_mark(&arena);
        bool read = nanovdb_decode(copy, cut, NULL, &arena, &g, NULL);
        if (i < 120 && cut < size / 2) assert_false(read);
        arena_reset_to(&arena, mark);
        free(copy);
    }
}

static int set_up(void **state) {
    (void)state;
    arena_init(&arena, NULL, 0);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    arena_destroy(&arena);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grids_are_read_by_their_names),
        cmocka_unit_test(packed_numbers_are_read),
        cmocka_unit_test(bad_numbers_are_told),
        cmocka_unit_test(damage_does_no_harm),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
