/* Several maps as one, what is done about voids, bounds, the geoid; and files that are not what they say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "map_files.h"

#include <sys/stat.h>

#define WITHIN(a, b, error) assert_true(fabs((a) - (b)) <= (error))

static double bumps(int column, int row) { return 500 + floor(40 * sin(0.7 * column) * cos(0.4 * row)) + column; }
static double further_bumps(int column, int row) { return bumps(column + 10, row); }
static double bumps_below(int column, int row) { return bumps(column, row + 10); }
static double five(int column, int row) { return 5 + 0 * (column + row); }
static double nine(int column, int row) { return 9 + 0 * (column + row); }

/* ---- joined ---- */

static void tiles_with_common_edges_are_one_map(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *paths[] = {made_hgt(&m, "N10E020.hgt", 11, 11, bumps), made_hgt(&m, "N10E021.hgt", 11, 11, further_bumps),
                           made_hgt(&m, "N09E020.hgt", 11, 11, bumps_below)};
    const Heightmap *map = made_open(&m, NULL, paths, 3);
    assert_non_null(map);
    assert_int_equal(heightmap_extent(map)->columns, 21);
    assert_int_equal(heightmap_extent(map)->rows, 21);
    for (int r = 0; r < 21; r++)
        for (int c = 0; c < 21; c++) {
            float post = heightmap_post(map, c, r);
            if (c > 10 && r > 10)
                assert_true(isnan(post)); /* no tile there: nothing is invented */
            else
                assert_true(post == (float)bumps(c, r));
        }
    made_end(&m);
}

/* Areas do not share posts: between the last of one file and the first of the next the ground goes on. */
static void tiles_of_areas_have_no_seam(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *paths[] = {made_grid(&m, "a.asc", "ncols 10\nnrows 5\nxllcorner 0.5\nyllcorner 40\ncellsize 0.1\n", 10, 5, bumps),
                           made_grid(&m, "b.asc", "ncols 10\nnrows 5\nxllcorner 1.5000000004\nyllcorner 40\ncellsize 0.1\n", 10, 5, further_bumps)};
    const Heightmap *map = made_open(&m, NULL, paths, 2);
    assert_non_null(map);
    assert_int_equal(heightmap_extent(map)->columns, 20);
    for (double u = 8.0; u <= 11; u += 0.125) {
        int c = (int)u;
        double expected = bumps(c, 2) + (u - c) * (bumps(c + 1, 2) - bumps(c, 2));
        WITHIN(made_ground(map, 40.25, 0.55 + 0.1 * u), expected, 1e-3);
    }
    made_end(&m);
}

static void maps_cross_the_antimeridian(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *paths[] = {made_hgt(&m, "S17E179.hgt", 11, 11, bumps), made_hgt(&m, "S17W180.hgt", 11, 11, further_bumps)};
    for (int turned = 0; turned < 2; turned++) {
        const char *order[] = {paths[turned], paths[1 - turned]};
        const Heightmap *map = made_open(&m, NULL, order, 2);
        assert_non_null(map);
        const HeightmapExtent *e = heightmap_extent(map);
        assert_int_equal(e->columns, 21);
        WITHIN(e->west, 179, 1e-9);
        WITHIN(e->east, 181, 1e-9);
        for (int k = 0; k <= 40; k++) {
            double longitude = 179 + k / 20.0, expected = k % 2 ? (bumps(k / 2, 3) + bumps(k / 2 + 1, 3)) / 2 : bumps(k / 2, 3);
            WITHIN(made_ground(map, -16.3, longitude), expected, 1e-3);
            WITHIN(made_ground(map, -16.3, longitude - 360), expected, 1e-3);
        }
    }
    made_end(&m);
}

/* 36 columns of ten degrees, given by their edges. */
static void a_map_of_the_globe_closes(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *map = made_open_one(&m, NULL, made_grid(&m, "world.asc", "ncols 36\nnrows 18\nxllcorner -180\nyllcorner -90\ncellsize 10\n", 36, 18, bumps));
    assert_true(heightmap_extent(map)->around);
    assert_int_equal(heightmap_extent(map)->columns, 37);
    WITHIN(made_ground(map, 85, -175), bumps(0, 0), 1e-3);
    WITHIN(made_ground(map, 85, 175), bumps(35, 0), 1e-3);
    WITHIN(made_ground(map, 85, 180), (bumps(35, 0) + bumps(0, 0)) / 2, 1e-3);
    WITHIN(made_ground(map, 85, -180), (bumps(35, 0) + bumps(0, 0)) / 2, 1e-3);
    WITHIN(made_ground(map, 85, 538), 0.7 * bumps(35, 0) + 0.3 * bumps(0, 0), 1e-3);
    made_end(&m);
}

/* A fine map over a coarse one that is a hundred metres higher, of another system: inside it is the first, outside the second, and
 * nowhere is a step. */
static void maps_of_other_lattices_are_blended(void **state) {
    (void)state;
    static const double scale[] = {100, 100, 0}, tie[] = {0, 0, 0, 500000, 5320000, 0};
    Made m;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_I16, .columns = 101, .rows = 101, .height = five, .scale = scale, .tie = tie,
                  .keys = {{1024, 0, 1, 1}, {1025, 0, 1, 2}, {3072, 0, 1, 32633}}, .key_count = 3};
    const char *paths[] = {made_tiff(&m, "fine.tif", &t),
                           made_grid(&m, "coarse.asc", "ncols 100\nnrows 100\nxllcorner 14.5\nyllcorner 47.5\ncellsize 0.01\n", 100, 100, nine)};
    const Heightmap *map = made_open(&m, NULL, paths, 2);
    assert_non_null(map);
    GeoPlace middle, corner;
    double last = 9;
    assert_true(heightmap_to_geo(map, 0, 0, &corner));
    Projection utm;
    assert_true(projection_utm(&utm, 33, true));
    assert_true(projection_reverse(&utm, 505000, 5315000, &middle));
    WITHIN(made_ground(map, middle.latitude, middle.longitude), 5, 1e-6);
    for (int k = 0; k <= 4000; k++) { /* from far outside to the middle, in steps of 5 m */
        GeoPlace at;
        assert_true(projection_reverse(&utm, 485000 + 5 * k, 5315000, &at));
        double h = made_ground(map, at.latitude, at.longitude);
        assert_true(fabs(h - last) < 0.05 && h >= 5 - 1e-6 && h <= 9 + 1e-6);
        last = h;
    }
    WITHIN(last, 5, 1e-6);
    made_end(&m);
}

static double plane_coarse(int column, int row) { return 1000 + 20 * column - 30 * row; }
static double plane_fine(int column, int row) { return 1000 + 20 * 10 + 10 * column - 15 * row; }

/* Tiles of two resolutions with a common edge, of one slope: the slope goes on. */
static void slopes_go_on_from_map_to_map(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *paths[] = {made_hgt(&m, "N10E020.hgt", 11, 11, plane_coarse), made_hgt(&m, "N10E021.hgt", 21, 21, plane_fine)};
    const Heightmap *map = made_open(&m, NULL, paths, 2);
    assert_non_null(map);
    assert_int_equal(heightmap_extent(map)->columns, 41);
    for (int k = 0; k <= 400; k++)
        for (int r = 0; r <= 10; r++)
            WITHIN(made_ground(map, 11 - r / 10.0, 20 + k / 200.0), 1000 + k - 30 * r, 1e-2);
    made_end(&m);
}

/* The lattice is that of the finest map; posts of the block are the ground. */
static void blocks_are_the_ground_at_posts(void **state) {
    (void)state;
    Made m;
    float block[9 * 7];
    made_begin(&m);
    const char *paths[] = {made_grid(&m, "a.asc", "ncols 20\nnrows 15\nxllcorner 10\nyllcorner 40\ncellsize 0.1\n", 20, 15, bumps),
                           made_grid(&m, "b.asc", "ncols 20\nnrows 15\nxllcorner 11\nyllcorner 41\ncellsize 0.25\n", 20, 15, further_bumps)};
    for (size_t count = 1; count <= 2; count++) {
        const Heightmap *map = made_open(&m, NULL, paths, count);
        bool whole = heightmap_block(map, 2, 1, 3, 9, 7, block), all = true;
        for (int r = 0; r < 7; r++)
            for (int c = 0; c < 9; c++) {
                double height = (double)NAN;
                GeoPlace place;
                if (!heightmap_at(map, 2 + 3 * c, 1 + 3 * r, &height)) height = (double)NAN;
                all &= !isnan(height);
                assert_true(isnan(block[r * 9 + c]) ? isnan(height) : block[r * 9 + c] == (float)height);
                assert_true(heightmap_to_geo(map, 2 + 3 * c, 1 + 3 * r, &place));
                double ground = made_ground(map, place.latitude, place.longitude);
                assert_true(isnan(height) == isnan(ground) && !(fabs(ground - height) > 1e-3));
            }
        assert_true(whole == all);
    }
    made_end(&m);
}

/* ---- voids ---- */

static double slope_with_hole(int column, int row) {
    int x = column - 100, y = row - 90;
    return x * x + y * y < 40 * 40 ? -32768 : 200 + column + 2 * row;
}
static double slope_west(int column, int row) { return slope_with_hole(column, row); }
static double slope_east(int column, int row) { return slope_with_hole(column + 100, row); }

static void voids_are_filled_from_their_rims(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *path = made_hgt(&m, "N50E010.hgt", 201, 201, slope_with_hole);
    const Heightmap *map = made_open_one(&m, NULL, path);
    double worst = 0;
    for (int r = 0; r < 201; r++)
        for (int c = 0; c < 201; c++) {
            double height = (double)heightmap_post(map, c, r), slope = 200 + c + 2 * r;
            worst = fmax(worst, fabs(height - slope));
            if (slope_with_hole(c, r) > 0) assert_true(height == slope);
        }
    assert_true(worst < 12); /* a membrane over a slope is the slope; its rise over the hole is 180 m */
    assert_true(heightmap_extent(map)->lowest == 200 && heightmap_extent(map)->highest == 800);
    WITHIN(heightmap_extent(map)->nodata_share, 5025 / 40401.0, 0.001);
    HeightmapOptions holes = {.voids = HEIGHTMAP_HOLES};
    const Heightmap *open = made_open_one(&m, &holes, path);
    assert_true(isnan(made_ground(open, 50.55, 10.5)) && !isnan(made_ground(open, 50.95, 10.05)));
    made_end(&m);
}

static void a_filled_void_has_no_seam_between_tiles(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *whole[] = {made_grid(&m, "whole.asc", "ncols 201\nnrows 201\nxllcenter 10\nyllcenter 50\ncellsize 0.005\nnodata_value -32768\n", 201, 201, slope_with_hole)};
    const char *parts[] = {made_grid(&m, "west.asc", "ncols 101\nnrows 201\nxllcenter 10\nyllcenter 50\ncellsize 0.005\nnodata_value -32768\n", 101, 201, slope_west),
                           made_grid(&m, "east.asc", "ncols 101\nnrows 201\nxllcenter 10.5\nyllcenter 50\ncellsize 0.005\nnodata_value -32768\n", 101, 201, slope_east)};
    const Heightmap *one = made_open(&m, NULL, whole, 1), *two = made_open(&m, NULL, parts, 2);
    for (int r = 0; r < 201; r++)
        for (int c = 0; c < 201; c++) assert_true(heightmap_post(one, c, r) == heightmap_post(two, c, r));
    made_end(&m);
}

static double all_void(int column, int row) { return -32768 + 0 * (column + row); }

static void voids_of_the_first_map_show_the_second(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *paths[] = {made_grid(&m, "a.asc", "ncols 10\nnrows 10\nxllcorner 10\nyllcorner 40\ncellsize 0.1\nnodata_value -32768\n", 10, 10, all_void),
                           made_grid(&m, "b.asc", "ncols 10\nnrows 10\nxllcorner 9\nyllcorner 39\ncellsize 0.3\n", 10, 10, nine)};
    HeightmapOptions options = {.has_nodata = true, .nodata = 5};
    WITHIN(made_ground(made_open(&m, NULL, paths, 2), 40.5, 10.5), 9, 1e-6);
    const char *fives = made_grid(&m, "fives.asc", "ncols 10\nnrows 10\nxllcorner 10\nyllcorner 40\ncellsize 0.1\n", 10, 10, five);
    const char *with_fives[] = {fives, paths[1]};
    WITHIN(made_ground(made_open(&m, &options, with_fives, 2), 40.5, 10.5), 9, 1e-6); /* a sample that the scene calls void */
    assert_null(made_open(&m, NULL, paths, 1));
    assert_non_null(strstr(m.diags.last->message, "none of its posts"));
    made_end(&m);
}

/* ---- bounds ---- */

static double ragged(int column, int row) {
    uint64_t h = (uint64_t)column * 0x9E3779B97F4A7C15u ^ (uint64_t)row * 0xC2B2AE3D27D4EB4Fu;
    h = (h ^ h >> 31) * 0xD6E8FEB86659FD93u;
    return h % 97 == 0 ? -9999 : (double)(h % 1000);
}

/* Against all posts of random boxes, one map and two of different lattices. */
static void ranges_hold_all_posts_between(void **state) {
    (void)state;
    Made m;
    RandomStream random = {7};
    HeightmapOptions holes = {.voids = HEIGHTMAP_HOLES};
    made_begin(&m);
    const char *paths[] = {made_grid(&m, "a.asc", "ncols 150\nnrows 140\nxllcorner 10\nyllcorner 40\ncellsize 0.01\nnodata_value -9999\n", 150, 140, ragged),
                           made_grid(&m, "b.asc", "ncols 60\nnrows 50\nxllcorner 9.9\nyllcorner 39.9\ncellsize 0.033\nnodata_value -9999\n", 60, 50, ragged)};
    for (size_t count = 1; count <= 2; count++) {
        const Heightmap *map = made_open(&m, &holes, paths, count);
        const HeightmapExtent *e = heightmap_extent(map);
        for (int k = 0; k < 60; k++) {
            int x0 = (int)(random_next_unit(&random) * e->columns), x1 = (int)(random_next_unit(&random) * e->columns);
            int y0 = (int)(random_next_unit(&random) * e->rows), y1 = (int)(random_next_unit(&random) * e->rows);
            double low = VTS_INFINITY, high = -VTS_INFINITY, told_low, told_high;
            bool whole = true, told_whole;
            for (int y = int_min(y0, y1); y <= int_max(y0, y1); y++)
                for (int x = int_min(x0, x1); x <= int_max(x0, x1); x++) {
                    double h = (double)heightmap_post(map, x, y);
                    whole &= !isnan(h);
                    low = isnan(h) ? low : fmin(low, h);
                    high = isnan(h) ? high : fmax(high, h);
                }
            bool told = heightmap_range(map, x0, y0, x1, y1, &told_low, &told_high, &told_whole);
            assert_true(told || low > high);
            assert_true(!told || (told_low <= low + 1e-4 && told_high >= high - 1e-4));
            assert_true(!told_whole || whole);
        }
    }
    made_end(&m);
}

/* ---- the geoid ---- */

static void put_big(unsigned char *at, uint64_t bits, int count) {
    for (int i = 0; i < count; i++) at[i] = (unsigned char)(bits >> 8 * (count - 1 - i));
}

/* 37 x 19 nodes of ten degrees over the globe: 1 m for each degree of latitude north, and 50. */
static const char *make_geoid(Made *m, const char *name) {
    static unsigned char bytes[40 + 4 * 36 * 19];
    const double header[] = {-90, -180, 10, 10};
    for (int i = 0; i < 4; i++) {
        uint64_t bits;
        memcpy(&bits, &header[i], 8);
        put_big(bytes + 8 * i, bits, 8);
    }
    put_big(bytes + 32, 19, 4);
    put_big(bytes + 36, 36, 4);
    for (int i = 0; i < 36 * 19; i++) {
        float n = (float)(50 - 90 + 10 * (i / 36));
        uint32_t bits;
        memcpy(&bits, &n, 4);
        put_big(bytes + 40 + 4 * i, bits, 4);
    }
    return made_file(m, name, bytes, sizeof bytes);
}

static void heights_above_the_geoid_become_heights_above_the_ellipsoid(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    make_geoid(&m, "mine.gtx");
    const char *folders[] = {m.folder};
    HeightmapOptions options = {.geoid = "mine", .folders = folders, .folder_count = 1};
    const char *path = made_hgt(&m, "S01W180.hgt", 101, 101, five);
    const Heightmap *map = made_open_one(&m, &options, path);
    for (int k = 0; k <= 10; k++) WITHIN(made_ground(map, -k / 10.0, -179.5), 5 + 50 - k / 10.0, 1e-4);
    WITHIN((double)heightmap_post(map, 100, 100), 54, 1e-4);
    double low, high;
    assert_true(heightmap_range(map, 0, 0, 100, 100, &low, &high, NULL));
    assert_true(low <= 54 && low > 53.8 && high >= 55 && high < 55.2);
    options.geoid = "egm2042";
    assert_null(made_open(&m, &options, &path, 1));
    assert_non_null(strstr(m.diags.last->message, "proj-data"));
    made_end(&m);
}

/* ---- files that are not what they say ---- */

static double any(int column, int row) { return column + row; }

static void refused(Made *m, const char *path, const char *why) {
    size_t before = m->diags.error_count;
    assert_null(made_open(m, NULL, &path, 1));
    assert_true(m->diags.error_count > before);
    if (!strstr(m->diags.last->message, path) || !strstr(m->diags.last->message, why)) fail_msg("'%s' has no '%s'", m->diags.last->message, why);
}

static void bad_files_are_named_with_the_cause(void **state) {
    (void)state;
    Made m;
    char folder[128];
    made_begin(&m);
    snprintf(folder, sizeof folder, "%s/N01E001.hgt", m.folder);
    assert_int_equal(mkdir(folder, 0700), 0);
    refused(&m, folder, "folder");
    rmdir(folder);
    refused(&m, "/nowhere/at/all.tif", "No such file");
    refused(&m, made_text(&m, "empty.tif", ""), "empty");
    refused(&m, made_text(&m, "text.tif", "this is a text"), "");
    refused(&m, made_text(&m, "text.png", "this is a text"), "");
    refused(&m, made_text(&m, "text.dem", "this is a text"), "USGS");
    refused(&m, made_text(&m, "N03E003.hgt", "this is a text, 27 byte long"), "square");
    refused(&m, made_hgt(&m, "somewhere.hgt", 3, 3, any), "N44W072.hgt");
    refused(&m, made_text(&m, "huge.asc", "ncols 1000000000\nnrows 1000000000\nxllcorner 0\nyllcorner 1\ncellsize 1\n1 2 3"), "can hold");
    refused(&m, made_text(&m, "short.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 1\ncellsize 1\n11 22 33 44 55 66 77"), "ends");
    refused(&m, made_text(&m, "words.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 1\ncellsize 1\n1 2 three 4"), "'three'");
    refused(&m, made_text(&m, "none.asc", "ncols 0\nnrows 2\nxllcorner 0\nyllcorner 1\ncellsize 1\n1 2 3"), "0 x 2");
    refused(&m, made_text(&m, "flat.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 1\ncellsize 0\n1 2"), "georeference");
    refused(&m, made_text(&m, "header.asc", "ncols"), "");
    made_end(&m);
}

static void tiffs_that_lie_are_refused(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    Made m;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_I16, .columns = 40, .rows = 40, .height = any, .scale = scale, .tie = tie,
                  .keys = {{1024, 0, 1, 2}, {1025, 0, 1, 2}, {2048, 0, 1, 4326}}, .key_count = 3, .height_told = 1000000000};
    refused(&m, made_tiff(&m, "tall.tif", &t), "");
    t.height_told = 0;
    const char *path = made_tiff(&m, "cut.tif", &t);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    for (off_t size = info.st_size * 2 / 3; size > 0; size = size * 2 / 3) { /* the tags stand behind the samples */
        assert_int_equal(truncate(path, size), 0);
        refused(&m, path, "");
    }
    t.keys[2][3] = 4267; /* NAD27 */
    refused(&m, made_tiff(&m, "old.tif", &t), "");
    made_end(&m);
}

/* The budget is asked before a file is read on, and what was opened is given back. */
static jmp_buf out_of_memory;
static void on_exhausted(void *context) {
    (void)context;
    longjmp(out_of_memory, 1);
}

static void a_budget_bounds_what_is_read(void **state) {
    (void)state;
    Made m;
    Arena arena;
    MemoryBudget budget = {.limit = 4 << 20, .on_exhausted = on_exhausted};
    made_begin(&m);
    const char *path = made_hgt(&m, "N00E000.hgt", 1201, 1201, ragged);
    volatile bool jumped = false;
    arena_init(&arena, &budget, 0);
    HeightmapOptions options = {0};
    if (setjmp(out_of_memory) == 0)
        heightmap_open(&path, 1, &options, &arena, &m.diags, (Span){0});
    else
        jumped = true;
    assert_true(jumped);
    arena_destroy(&arena);
    assert_true(budget.used == 0);
    made_end(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_with_common_edges_are_one_map),
        cmocka_unit_test(tiles_of_areas_have_no_seam),
        cmocka_unit_test(maps_cross_the_antimeridian),
        cmocka_unit_test(a_map_of_the_globe_closes),
        cmocka_unit_test(maps_of_other_lattices_are_blended),
        cmocka_unit_test(slopes_go_on_from_map_to_map),
        cmocka_unit_test(blocks_are_the_ground_at_posts),
        cmocka_unit_test(voids_are_filled_from_their_rims),
        cmocka_unit_test(a_filled_void_has_no_seam_between_tiles),
        cmocka_unit_test(voids_of_the_first_map_show_the_second),
        cmocka_unit_test(ranges_hold_all_posts_between),
        cmocka_unit_test(heights_above_the_geoid_become_heights_above_the_ellipsoid),
        cmocka_unit_test(bad_files_are_named_with_the_cause),
        cmocka_unit_test(tiffs_that_lie_are_refused),
        cmocka_unit_test(a_budget_bounds_what_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
