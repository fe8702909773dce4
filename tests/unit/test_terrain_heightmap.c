/* Heightmaps from files that the test writes: where posts lie, what is between them, what is not there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "map_files.h"

#define WITHIN(a, b, error) assert_true(fabs((a) - (b)) <= (error))

static double plane(int column, int row) { return 100 + 2 * column + 3 * row; }
static double bumps(int column, int row) { return 500 + 40 * sin(0.7 * column) * cos(0.4 * row) + column; }
static double below_the_sea(int column, int row) { return -400 + column - row; }

static const char GRID_4_3[] = "NCOLS 4\nnrows 3\nXLLCORNER 10\nyllcorner 50\ncellsize 0.5\n";

/* ---- where posts lie ---- */

static void tiles_lie_where_their_names_say(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *map = made_open_one(&m, NULL, made_hgt(&m, "S03W072.hgt", 11, 11, plane));
    const HeightmapExtent *e = heightmap_extent(map);
    assert_int_equal(e->columns, 11);
    WITHIN(e->west, -72, 1e-9);
    WITHIN(e->east, -71, 1e-9);
    WITHIN(e->south, -3, 1e-9);
    WITHIN(e->north, -2, 1e-9);
    for (int r = 0; r < 11; r++)
        for (int c = 0; c < 11; c++) WITHIN(made_ground(map, -2 - r / 10.0, -72 + c / 10.0), plane(c, r), 1e-4);
    WITHIN(made_ground(map, -2.25, -71.85), plane(1, 2) + 2.5, 1e-4); /* between posts: a plane is bilinear */
    assert_true(isnan(made_ground(map, -1.99, -71.5)));
    assert_true(isnan(made_ground(map, -2.5, -70.99)));
    WITHIN(e->row_spacing, 11058, 2); /* a tenth of a degree at the equator: 11,057 m along a meridian, 11,132 m along it */
    WITHIN(e->column_spacing, 11119, 3);
    made_end(&m);
}

static void tiles_of_high_latitudes_have_fewer_columns(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *map = made_open_one(&m, NULL, made_hgt(&m, "n60e005.hgt", 601, 1201, below_the_sea));
    assert_int_equal(heightmap_extent(map)->columns, 601);
    assert_int_equal(heightmap_extent(map)->rows, 1201);
    WITHIN(made_ground(map, 61, 6), below_the_sea(600, 0), 1e-4);
    WITHIN(made_ground(map, 60, 5), below_the_sea(0, 1200), 1e-4);
    WITHIN(heightmap_extent(map)->lowest, -1600, 0);
    made_end(&m);
}

static void corners_and_middles_of_cells_are_told_apart(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *corner = made_open_one(&m, NULL, made_grid(&m, "corner.asc", GRID_4_3, 4, 3, plane));
    const Heightmap *centre = made_open_one(
        &m, NULL, made_grid(&m, "centre.asc", "\xEF\xBB\xBFnrows 3\r\nncols 4\r\nxllcenter 10,25\r\nyllcenter 50.25\r\ndx 0.5\r\ndy 5d-1\r\nnodata_value -9999\r\n", 4, 3, plane));
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            WITHIN(made_ground(corner, 51.25 - 0.5 * r, 10.25 + 0.5 * c), plane(c, r), 1e-6);
            WITHIN(made_ground(centre, 51.25 - 0.5 * r, 10.25 + 0.5 * c), plane(c, r), 1e-6);
        }
    assert_true(isnan(made_ground(corner, 51.26, 11))); /* the ground ends with the posts */
    assert_string_equal(heightmap_extent(corner)->system, "longitude and latitude");
    made_end(&m);
}

static void one_post_and_one_row_are_plates(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *post = made_open_one(&m, NULL, made_text(&m, "post.asc", "ncols 1\nnrows 1\nxllcorner 7\nyllcorner 46\ncellsize 2\n1234.5\n"));
    WITHIN(made_ground(post, 46, 7), 1234.5, 1e-9);
    WITHIN(made_ground(post, 48, 9), 1234.5, 1e-9);
    assert_true(isnan(made_ground(post, 48.01, 9)));
    const Heightmap *row = made_open_one(&m, NULL, made_text(&m, "row.asc", "ncols 3\nnrows 1\nxllcorner 7\nyllcorner 46\ncellsize 2\n10 20 30\n"));
    assert_int_equal(heightmap_extent(row)->columns, 3);
    assert_int_equal(heightmap_extent(row)->rows, 2);
    WITHIN(made_ground(row, 46, 9), 15, 1e-6);
    WITHIN(made_ground(row, 48, 9), 15, 1e-6);
    const Heightmap *column = made_open_one(&m, NULL, made_text(&m, "column.asc", "ncols 1\nnrows 2\nxllcorner 7\nyllcorner 46\ncellsize 2\n10 20\n"));
    WITHIN(made_ground(column, 48, 7), 15, 1e-6);
    WITHIN(made_ground(column, 48, 9), 15, 1e-6);
    made_end(&m);
}

/* ---- GeoTIFF ---- */

enum { MODEL = 1024, RASTER = 1025, GEOGRAPHIC = 2048, PROJECTED = 3072, VERTICAL_UNIT = 4099 };

static void samples_of_tiffs_are_read_as_they_are_stored(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    static const struct {
        MadeSample sample;
        MadeHeight *height;
    } kinds[] = {{MADE_I16, below_the_sea}, {MADE_U16, plane}, {MADE_F32, bumps}, {MADE_F64, bumps}};
    Made m;
    made_begin(&m);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(kinds); k++) {
        char name[16];
        snprintf(name, sizeof name, "%zu.tif", k);
        MadeTiff t = {.sample = kinds[k].sample, .columns = 9, .rows = 7, .height = kinds[k].height, .scale = scale, .tie = tie,
                      .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 2}, {GEOGRAPHIC, 0, 1, 4326}}, .key_count = 3};
        const Heightmap *map = made_open_one(&m, NULL, made_tiff(&m, name, &t));
        for (int r = 0; r < 7; r++)
            for (int c = 0; c < 9; c++) {
                assert_true((float)kinds[k].height(c, r) == heightmap_post(map, c, r));
                WITHIN(made_ground(map, 50 - 0.1 * r, 10 + 0.1 * c), kinds[k].height(c, r), 1e-3);
            }
    }
    made_end(&m);
}

/* Rows are asked for one after the other, whatever the file keeps together. */
static void tiles_within_a_file_are_rows(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    static const MadeSample samples[] = {MADE_I16, MADE_F32, MADE_F64}; /* the last is not read by every OpenImageIO: then it is refused */
    Made m;
    made_begin(&m);
    for (size_t k = 0; k < VTS_ARRAY_COUNT(samples); k++) {
        char name[16];
        snprintf(name, sizeof name, "%zu.tif", k);
        MadeTiff t = {.sample = samples[k], .columns = 70, .rows = 45, .height = bumps, .scale = scale, .tie = tie, .tile = 16,
                      .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 2}, {GEOGRAPHIC, 0, 1, 4326}}, .key_count = 3};
        const char *path = made_tiff(&m, name, &t);
        const Heightmap *map = made_open(&m, NULL, &path, 1);
        if (!map) {
            assert_true(samples[k] == MADE_F64);
            assert_non_null(strstr(m.diags.last->message, "64-bit floats"));
            continue;
        }
        for (int r = 0; r < 45; r++)
            for (int c = 0; c < 70; c++) assert_true(heightmap_post(map, c, r) == (k == 0 ? (float)(int)bumps(c, r) : (float)bumps(c, r)));
    }
    made_end(&m);
}

static double high(int column, int row) { return 40000 + column + row; }

static void large_unsigned_samples_are_no_negative_ones(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    Made m;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_U16, .columns = 2, .rows = 2, .scale = scale, .tie = tie, .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 1}, {GEOGRAPHIC, 0, 1, 4326}}, .key_count = 3};
    t.height = high;
    const Heightmap *map = made_open_one(&m, NULL, made_tiff(&m, "high.tif", &t));
    assert_true(heightmap_post(map, 1, 1) == 40002.0f);
    WITHIN(made_ground(map, 49.95, 10.05), 40000, 1e-6); /* an area's middle: half a pixel from the tie point */
    made_end(&m);
}

static double feet_and_voids(int column, int row) { return column == 1 && row == 1 ? -9999 : 1000 + column; }

static void scale_offset_feet_and_voids(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    Made m;
    made_begin(&m);
    HeightmapOptions holes = {.voids = HEIGHTMAP_HOLES};
    MadeTiff t = {.sample = MADE_I16, .columns = 4, .rows = 3, .height = feet_and_voids, .scale = scale, .tie = tie,
                  .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 2}, {GEOGRAPHIC, 0, 1, 4326}, {VERTICAL_UNIT, 0, 1, 9002}}, .key_count = 4,
                  .nodata = "-9999"};
    const Heightmap *feet = made_open_one(&m, &holes, made_tiff(&m, "feet.tif", &t));
    WITHIN((double)heightmap_post(feet, 2, 0), 1002 * 0.3048, 1e-4);
    assert_true(isnan(heightmap_post(feet, 1, 1)));
    WITHIN(heightmap_extent(feet)->lowest, 1000 * 0.3048, 1e-4);
    WITHIN(heightmap_extent(feet)->nodata_share, 1 / 12.0, 1e-9);
    t.key_count = 3;
    t.metadata = "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-50</Item><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>";
    const Heightmap *scaled = made_open_one(&m, &holes, made_tiff(&m, "scaled.tif", &t));
    WITHIN((double)heightmap_post(scaled, 3, 2), 1003 * 0.1 - 50, 1e-4);
    made_end(&m);
}

static double odd_floats(int column, int row) {
    return column == 0 && row == 0 ? (double)NAN : column == 1 && row == 0 ? -3.4028234663852886e38 : column == 2 && row == 0 ? 1e31 : 7;
}

static void what_is_no_height_is_void(void **state) {
    (void)state;
    static const double scale[] = {0.1, 0.1, 0}, tie[] = {0, 0, 0, 10, 50, 0};
    Made m;
    made_begin(&m);
    HeightmapOptions holes = {.voids = HEIGHTMAP_HOLES};
    MadeTiff t = {.sample = MADE_F32, .columns = 4, .rows = 3, .height = odd_floats, .scale = scale, .tie = tie,
                  .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 2}, {GEOGRAPHIC, 0, 1, 4326}}, .key_count = 3};
    const char *path = made_tiff(&m, "odd.tif", &t);
    const Heightmap *map = made_open_one(&m, &holes, path);
    for (int c = 0; c < 3; c++) assert_true(isnan(heightmap_post(map, c, 0)));
    assert_true(heightmap_post(map, 3, 0) == 7.0f);
    const Heightmap *filled = made_open_one(&m, NULL, path);
    for (int c = 0; c < 4; c++) assert_true(heightmap_post(filled, c, 0) == 7.0f);
    made_end(&m);
}

/* Turned by 30 degrees about (10, 50). */
static void rotated_maps_are_turned(void **state) {
    (void)state;
    static const double affine[16] = {0.0866025403784, 0.05, 0, 10, 0.05, -0.0866025403784, 0, 50, 0, 0, 0, 0, 0, 0, 0, 1};
    Made m;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_I16, .columns = 5, .rows = 4, .height = plane, .affine = affine,
                  .keys = {{MODEL, 0, 1, 2}, {RASTER, 0, 1, 2}, {GEOGRAPHIC, 0, 1, 4326}}, .key_count = 3};
    const Heightmap *map = made_open_one(&m, NULL, made_tiff(&m, "turned.tif", &t));
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 5; c++)
            WITHIN(made_ground(map, 50 + 0.05 * c - 0.0866025403784 * r, 10 + 0.0866025403784 * c + 0.05 * r), plane(c, r), 1e-4);
    assert_true(isnan(made_ground(map, 50.19, 10)));
    made_end(&m);
}

static void southern_zones_and_their_edges(void **state) {
    (void)state;
    /* UTM 56 south over Sydney: 151.2 E, 33.9 S lies at 333,538 E 6,247,411 N (from GeoConvert). */
    static const double scale[] = {1000, 1000, 0}, tie[] = {0, 0, 0, 320000, 6260000, 0};
    Made m;
    UtmPlace at;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_I16, .columns = 31, .rows = 31, .height = plane, .scale = scale, .tie = tie,
                  .keys = {{MODEL, 0, 1, 1}, {RASTER, 0, 1, 2}, {PROJECTED, 0, 1, 32756}}, .key_count = 3};
    const Heightmap *map = made_open_one(&m, NULL, made_tiff(&m, "sydney.tif", &t));
    assert_true(utm_from_geo((GeoPlace){-33.9, 151.2, 0}, &at));
    WITHIN(at.easting, 333538, 300);
    WITHIN(made_ground(map, -33.9, 151.2), 100 + 2 * (at.easting - 320000) / 1000 + 3 * (6260000 - at.northing) / 1000, 1e-3);
    assert_true(heightmap_extent(map)->south < -33.9 && heightmap_extent(map)->north > -33.9);
    made_end(&m);
}

static void a_pole_may_lie_inside(void **state) {
    (void)state;
    /* EPSG 32661: the pole at 2,000,000 E 2,000,000 N. */
    static const double scale[] = {20000, 20000, 0}, tie[] = {0, 0, 0, 1800000, 2200000, 0};
    Made m;
    made_begin(&m);
    MadeTiff t = {.sample = MADE_I16, .columns = 21, .rows = 21, .height = plane, .scale = scale, .tie = tie,
                  .keys = {{MODEL, 0, 1, 1}, {RASTER, 0, 1, 2}, {PROJECTED, 0, 1, 32661}}, .key_count = 3};
    const Heightmap *map = made_open_one(&m, NULL, made_tiff(&m, "pole.tif", &t));
    for (double longitude = -180; longitude <= 180; longitude += 30) WITHIN(made_ground(map, 90, longitude), plane(10, 10), 1e-3);
    WITHIN(heightmap_extent(map)->north, 90, 0);
    WITHIN(heightmap_extent(map)->east - heightmap_extent(map)->west, 360, 1e-9);
    WITHIN(made_ground(map, 89, 0), 100 + 20 + 3 * (10 + 5.5515), 0.05); /* 111,030 m south of it along the meridian of Greenwich: down */
    made_end(&m);
}

/* ---- beside the file ---- */

static void world_files_and_systems_beside(void **state) {
    (void)state;
    static const char PGM[] = "P5\n3 2\n65535\n\0\012\0\024\0\036\0\050\0\062\0\074";
    Made m;
    made_begin(&m);
    const char *picture = made_file(&m, "heights.pgm", PGM, sizeof PGM - 1);
    made_text(&m, "heights.pmw", "30\n0\n0\n-30\n500015\n4649985\n");
    made_text(&m, "heights.prj",
              "PROJCS[\"WGS_1984_UTM_Zone_33N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
              "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],"
              "PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",15.0],PARAMETER[\"Scale_Factor\",0.9996],"
              "PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]");
    const Heightmap *map = made_open_one(&m, NULL, picture);
    GeoPlace place;
    UtmPlace at;
    assert_true(heightmap_post(map, 2, 1) == 60.0f);
    assert_true(heightmap_to_geo(map, 0, 0, &place) && utm_from_geo(place, &at));
    assert_int_equal(at.zone, 33);
    WITHIN(at.easting, 500015, 1e-3); /* a world file names the middle of the first pixel */
    WITHIN(at.northing, 4649985, 1e-3);
    made_end(&m);
}

static void the_scene_may_place_a_map(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *path = made_grid(&m, "local.asc", "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n", 4, 3, plane);
    assert_null(made_open(&m, NULL, &path, 1)); /* a local origin is no place on the globe */
    assert_non_null(strstr(m.diags.last->message, "georeference"));
    HeightmapPlace place = {.west_south = {8, 47}, .east_north = {12, 50}, .area = true};
    projection_lonlat(&place.projection);
    HeightmapOptions options = {.place = &place};
    WITHIN(made_ground(made_open_one(&m, &options, path), 49.5, 8.5), plane(0, 0), 1e-6);
    place.area = false;
    WITHIN(made_ground(made_open_one(&m, &options, path), 50, 8), plane(0, 0), 1e-6);
    WITHIN(made_ground(made_open_one(&m, &options, path), 47, 12), plane(3, 2), 1e-6);
    made_end(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_lie_where_their_names_say),
        cmocka_unit_test(tiles_of_high_latitudes_have_fewer_columns),
        cmocka_unit_test(corners_and_middles_of_cells_are_told_apart),
        cmocka_unit_test(one_post_and_one_row_are_plates),
        cmocka_unit_test(samples_of_tiffs_are_read_as_they_are_stored),
        cmocka_unit_test(tiles_within_a_file_are_rows),
        cmocka_unit_test(large_unsigned_samples_are_no_negative_ones),
        cmocka_unit_test(scale_offset_feet_and_voids),
        cmocka_unit_test(what_is_no_height_is_void),
        cmocka_unit_test(rotated_maps_are_turned),
        cmocka_unit_test(southern_zones_and_their_edges),
        cmocka_unit_test(a_pole_may_lie_inside),
        cmocka_unit_test(world_files_and_systems_beside),
        cmocka_unit_test(the_scene_may_place_a_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
