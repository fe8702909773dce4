/* Systems as texts beside a map against the same systems by their codes; and maps of agencies, where they are at hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "map_files.h"
#include "terrain/geoid.h"
#include "terrain/map_place.h"

#include <sys/stat.h>

#define WITHIN(a, b, error) assert_true(fabs((a) - (b)) <= (error))

#define GCS_NAD83 "GEOGCS[\"NAD83\",DATUM[\"North_American_Datum_1983\",SPHEROID[\"GRS 1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]"
#define GCS_WGS84 "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]"
#define GCS_ETRS  "GEOGCS[\"ETRS89\",DATUM[\"D_ETRS_1989\",SPHEROID[\"GRS_1980\",6378137.0,298.257222101]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]"

static const struct {
    int code; /* PROJ's data knows it */
    const char *text;
    double latitude, longitude;
} SYSTEMS[] = {
    {4326, GCS_WGS84, 12, 34},
    {32633, "PROJCS[\"WGS_1984_UTM_Zone_33N\"," GCS_WGS84 ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",15.0],PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]", 47, 13},
    {32733, "PROJCS(\"WGS_1984_UTM_Zone_33S\"," GCS_WGS84 ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",15],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",10000000],UNIT[\"metre\",1],AXIS[\"Easting\",EAST],AUTHORITY[\"EPSG\",\"32733\"])", -22, 16},
    {5070, "PROJCS[\"NAD83 / Conus Albers\"," GCS_NAD83 ",PROJECTION[\"Albers_Conic_Equal_Area\"],PARAMETER[\"latitude_of_center\",23],PARAMETER[\"longitude_of_center\",-96],PARAMETER[\"standard_parallel_1\",29.5],PARAMETER[\"standard_parallel_2\",45.5],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]", 40, -100},
    {2154, "PROJCRS[\"RGF93 v1 / Lambert-93\",BASEGEOGCRS[\"RGF93 v1\",DATUM[\"Reseau Geodesique Francais 1993 v1\",ELLIPSOID[\"GRS 1980\",6378137,298.257222101,LENGTHUNIT[\"metre\",1]]],PRIMEM[\"Greenwich\",0,ANGLEUNIT[\"degree\",0.0174532925199433]]],CONVERSION[\"Lambert-93\",METHOD[\"Lambert Conic Conformal (2SP)\",ID[\"EPSG\",9802]],PARAMETER[\"Latitude of false origin\",46.5,ANGLEUNIT[\"degree\",0.0174532925199433]],PARAMETER[\"Longitude of false origin\",3],PARAMETER[\"Latitude of 1st standard parallel\",49],PARAMETER[\"Latitude of 2nd standard parallel\",44],PARAMETER[\"Easting at false origin\",700000],PARAMETER[\"Northing at false origin\",6600000]],CS[Cartesian,2],AXIS[\"easting (X)\",east],LENGTHUNIT[\"metre\",1]]", 45, 6},
    {3413, "PROJCS[\"WGS_1984_NSIDC_Sea_Ice_Polar_Stereographic_North\"," GCS_WGS84 ",PROJECTION[\"Polar_Stereographic\"],PARAMETER[\"latitude_of_origin\",70],PARAMETER[\"central_meridian\",-45],PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]", 75, -40},
    {3031, "PROJCS[\"WGS_1984_Antarctic_Polar_Stereographic\"," GCS_WGS84 ",PROJECTION[\"Stereographic_South_Pole\"],PARAMETER[\"False_Easting\",0.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",0.0],PARAMETER[\"Standard_Parallel_1\",-71.0],UNIT[\"Meter\",1.0]]", -78, 160},
    {3857, "PROJCS[\"WGS_1984_Web_Mercator_Auxiliary_Sphere\"," GCS_WGS84 ",PROJECTION[\"Mercator_Auxiliary_Sphere\"],PARAMETER[\"False_Easting\",0.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",0.0],PARAMETER[\"Standard_Parallel_1\",0.0],PARAMETER[\"Auxiliary_Sphere_Type\",0.0],UNIT[\"Meter\",1.0]]", 60, 100},
    {3035, "PROJCS[\"ETRS89_LAEA_Europe\"," GCS_ETRS ",PROJECTION[\"Lambert_Azimuthal_Equal_Area\"],PARAMETER[\"False_Easting\",4321000.0],PARAMETER[\"False_Northing\",3210000.0],PARAMETER[\"Central_Meridian\",10.0],PARAMETER[\"Latitude_Of_Origin\",52.0],UNIT[\"Meter\",1.0]]", 48, 2},
    {2229, "PROJCS[\"NAD83 / California zone 5 (ftUS)\"," GCS_NAD83 ",PROJECTION[\"Lambert_Conformal_Conic_2SP\"],PARAMETER[\"standard_parallel_1\",35.4666666666667],PARAMETER[\"standard_parallel_2\",34.0333333333333],PARAMETER[\"latitude_of_origin\",33.5],PARAMETER[\"central_meridian\",-118],PARAMETER[\"false_easting\",6561666.667],PARAMETER[\"false_northing\",1640416.667],UNIT[\"US survey foot\",0.304800609601219]]", 34, -118.5},
};

static void texts_say_what_codes_say(void **state) {
    (void)state;
    int compared = 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(SYSTEMS); i++) {
        Projection by_text, by_code;
        StrBuf why = {0};
        double x[2], y[2];
        GeoPlace place = {SYSTEMS[i].latitude, SYSTEMS[i].longitude, 0};
        if (!map_parse_system(SYSTEMS[i].text, strlen(SYSTEMS[i].text), &by_text, &why)) fail_msg("%d: %s", SYSTEMS[i].code, why.data);
        assert_true(projection_forward(&by_text, place, &x[0], &y[0]));
        if (projection_from_epsg(&by_code, SYSTEMS[i].code, &why)) {
            assert_true(projection_forward(&by_code, place, &x[1], &y[1]));
            if (!(fabs(x[0] - x[1]) < 0.02 && fabs(y[0] - y[1]) < 0.02)) fail_msg("%d: %.4f %.4f by text, %.4f %.4f by code", SYSTEMS[i].code, x[0], y[0], x[1], y[1]);
            compared++;
        }
        strbuf_free(&why);
    }
    assert_true(compared >= 4); /* the arithmetic ones need no data of PROJ */
}

static void keywords_are_read(void **state) {
    (void)state;
    static const char north[] = "Projection    UTM\r\nZone          33\r\nDatum         WGS-84\r\nUnits         METERS\r\n", south[] = "Projection UTM\nZone -33\n";
    static const char degrees[] = "Projection    GEOGRAPHIC\nDatum NAD83\nUnits DD\n";
    Projection p;
    double x, y;
    assert_true(map_parse_system(north, sizeof north - 1, &p, NULL));
    assert_true(projection_forward(&p, (GeoPlace){47, 15, 0}, &x, &y));
    WITHIN(x, 500000, 1e-3);
    assert_true(map_parse_system(south, sizeof south - 1, &p, NULL));
    assert_true(projection_forward(&p, (GeoPlace){-1, 15, 0}, &x, &y));
    assert_true(y > 9e6);
    assert_true(map_parse_system(degrees, sizeof degrees - 1, &p, NULL));
    assert_true(projection_forward(&p, (GeoPlace){47, 15, 0}, &x, &y));
    WITHIN(x, 15, 1e-12);
}

static void what_cannot_be_placed_is_refused(void **state) {
    (void)state;
    static const char *const texts[][2] = {
        {"", "none that tells"},
        {"some words", "none that tells"},
        {"GEOGCS[\"NAD27\",DATUM[\"D_North_American_1927\",SPHEROID[\"Clarke_1866\",6378206.4,294.9786982]],UNIT[\"Degree\",0.0174532925199433]]", "datum"},
        {"PROJCS[\"x\"," GCS_WGS84 ",PROJECTION[\"Krovak\"],UNIT[\"Meter\",1.0]]", "not modelled"},
        {"PROJCS[\"x\"," GCS_WGS84 ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"Azimuth\",3],UNIT[\"Meter\",1.0]]", "no parameter"},
        {"Projection STATEPLANE\nDatum NAD83\n", "not modelled"},
        {"[[[[[[", ""},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(texts); i++) {
        Projection p;
        StrBuf why = {0};
        assert_false(map_parse_system(texts[i][0], strlen(texts[i][0]), &p, &why));
        assert_true(why.size > 0 && strstr(why.data, texts[i][1]));
        strbuf_free(&why);
    }
}

/* ---- a map of the USGS ---- */

static void put(StrBuf *text, const char *format, ...) {
    va_list args;
    va_start(args, format);
    strbuf_vaddf(text, format, args);
    va_end(args);
}

static void pad(StrBuf *text) {
    while (text->size % 1024 != 0) strbuf_addc(text, ' ');
}

/* Three profiles in UTM zone 10, of 200, 3 and 2 posts, the second a step further north; heights in feet, in steps of half a foot. */
static void make_dem(StrBuf *text, int datum) {
    static const int counts[] = {200, 3, 2};
    put(text, "%-144s%6d%6d%6d%6d", "A MADE MAP", 1, 1, 1, 10);
    for (int i = 0; i < 15; i++) put(text, "%24s", "0.0D0");
    put(text, "%6d%6d%6d", 2, 1, 4);
    for (int i = 0; i < 10; i++) put(text, "%24s", "0.5D+06");
    put(text, "%24s%6d%12s%12s%12s%6d%6d", "0.0D0", 0, "30.0", "30.0", "0.5", 1, 3);
    while (text->size < 890) strbuf_addc(text, ' ');
    put(text, "%2d", datum);
    pad(text);
    for (int i = 0; i < 3; i++) {
        put(text, "%6d%6d%6d%6d%24.15E%24.15E%24s%24s%24s", 1, i + 1, counts[i], 1, 500000.0 + 30 * i, 5100000.0 + (i == 1 ? 30 : 0), "100.0D0", "0.0", "0.0");
        for (int k = 0; k < counts[i]; k++) {
            if (k == 146) pad(text);
            put(text, "%6d", i == 0 && k == 1 ? -32767 : 1000 * i + k);
        }
        pad(text);
    }
}

static void profiles_of_a_dem_become_rows(void **state) {
    (void)state;
    Made m;
    StrBuf text = {0};
    made_begin(&m);
    make_dem(&text, 4);
    HeightmapOptions holes = {.voids = HEIGHTMAP_HOLES};
    const Heightmap *map = made_open_one(&m, &holes, made_file(&m, "made.dem", text.data, text.size));
    const HeightmapExtent *e = heightmap_extent(map);
    GeoPlace place;
    UtmPlace at;
    assert_int_equal(e->columns, 3);
    assert_int_equal(e->rows, 200);
    WITHIN((double)heightmap_post(map, 0, 0), (199 * 0.5 + 100) * 0.3048, 1e-3);
    WITHIN((double)heightmap_post(map, 0, 199 - 150), (150 * 0.5 + 100) * 0.3048, 1e-3); /* in the profile's second record */
    assert_true(isnan(heightmap_post(map, 0, 198)));
    assert_true(isnan(heightmap_post(map, 1, 199)) && isnan(heightmap_post(map, 2, 197)));
    WITHIN((double)heightmap_post(map, 1, 198), (1000 * 0.5 + 100) * 0.3048, 1e-3);
    WITHIN((double)heightmap_post(map, 2, 199), (2000 * 0.5 + 100) * 0.3048, 1e-3);
    assert_true(heightmap_to_geo(map, 2, 199, &place) && utm_from_geo(place, &at));
    WITHIN(at.easting, 500060, 1e-3);
    WITHIN(at.northing, 5100000, 1e-3);
    strbuf_clear(&text);
    make_dem(&text, 1);
    const char *old = made_file(&m, "old.dem", text.data, text.size);
    assert_null(made_open(&m, &holes, &old, 1));
    assert_non_null(strstr(m.diags.last->message, "NAD27"));
    const char *cut = made_file(&m, "cut.dem", text.data, text.size - 2048);
    assert_null(made_open(&m, &holes, &cut, 1));
    assert_non_null(strstr(m.diags.last->message, "profile"));
    strbuf_free(&text);
    made_end(&m);
}

/* ---- maps that are not made here: in the folder that $VTS_TEST_DATA names ---- */

static const char *found(Made *m, const char *name) {
    const char *folder = getenv("VTS_TEST_DATA");
    struct stat info;
    const char *path = arena_printf(&m->arena, "%s/%s", folder ? folder : "", name);
    if (folder && stat(path, &info) == 0) return path;
    made_end(m);
    skip();
    return NULL;
}

static void peak_is(const Heightmap *map, double height, double latitude, double longitude) {
    const HeightmapExtent *e = heightmap_extent(map);
    int column = 0, row = 0;
    for (int r = 0; r < e->rows; r++)
        for (int c = 0; c < e->columns; c++)
            if (heightmap_post(map, c, r) > heightmap_post(map, column, row)) column = c, row = r;
    GeoPlace place;
    assert_true(heightmap_to_geo(map, column, row, &place));
    WITHIN((double)heightmap_post(map, column, row), height, 0.5);
    WITHIN(place.latitude, latitude, 0.0009);
    WITHIN(place.longitude, longitude, 0.0009);
}

/* Its summit lies at 44.2706 N, 71.3033 W; three arc seconds make 1908 of its 1917 m. */
static void mount_washington_is_in_its_place(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    peak_is(made_open_one(&m, NULL, found(&m, "dem/N44W072.hgt")), 1908, 44.2706, -71.3033);
    made_end(&m);
}

/* The same posts as GeoTIFF and as grid. */
static void two_files_of_one_map_agree(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const char *grid = found(&m, "dem/jacksboro.asc");
    const Heightmap *a = made_open_one(&m, NULL, grid), *b = made_open_one(&m, NULL, VTS_SOURCE_DIR "/examples/jacksboro.tif");
    for (int k = 0; k < 2000; k++) {
        double latitude = 36.4470 + 0.2850 * (k % 40) / 39, longitude = -84.4130 + 0.3345 * (k / 40) / 49;
        WITHIN(made_ground(a, latitude, longitude), made_ground(b, latitude, longitude), 1e-3);
    }
    made_end(&m);
}

/* Known of the geoid: 27.5 m below the ellipsoid at Mount Washington. */
static void the_geoid_of_1996_is_read(void **state) {
    (void)state;
    Made m;
    Geoid geoid;
    double n;
    made_begin(&m);
    assert_true(geoid_load(&geoid, found(&m, "geoid/egm96_15.gtx"), NULL, 0, &m.arena, NULL));
    assert_true(geoid_undulation(&geoid, 44.27, -71.30, &n));
    WITHIN(n, -27.518, 0.01);
    assert_true(geoid_undulation(&geoid, 90, 17, &n));
    WITHIN(n, 13.606, 0.01);
    made_end(&m);
}

/* Always there: a map of the examples. */
static void the_map_of_the_examples_is_whole(void **state) {
    (void)state;
    Made m;
    made_begin(&m);
    const Heightmap *map = made_open_one(&m, NULL, VTS_SOURCE_DIR "/examples/jacksboro.tif");
    const HeightmapExtent *e = heightmap_extent(map);
    assert_int_equal(e->columns, 403);
    assert_int_equal(e->rows, 344);
    WITHIN(e->lowest, 236, 0);
    WITHIN(e->highest, 1076, 0);
    WITHIN(e->west, -84.4133333, 1e-6); /* of areas: the first post is half a pixel beside the corner */
    WITHIN(e->north, 36.7325, 1e-6);
    WITHIN(e->nodata_share, 0, 0);
    assert_true(heightmap_post(map, 0, 0) == 483.0f);
    made_end(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_say_what_codes_say),
        cmocka_unit_test(keywords_are_read),
        cmocka_unit_test(what_cannot_be_placed_is_refused),
        cmocka_unit_test(profiles_of_a_dem_become_rows),
        cmocka_unit_test(mount_washington_is_in_its_place),
        cmocka_unit_test(two_files_of_one_map_agree),
        cmocka_unit_test(the_geoid_of_1996_is_read),
        cmocka_unit_test(the_map_of_the_examples_is_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
