/* Where samples lie: maps by corners and by GeoTIFF's tags, and files that are damaged or lie. */
#include "base/random.h"
#include "terrain/georeference.h"
#include "tiff_bytes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) print_message("%.12g is not %.12g\n", a, b);
    assert_true(fabs(a - b) <= tolerance);
}

/* Whether the sample lies there, and what lies there is the sample. */
static void assert_place(const Georeference *r, double column, double row, double latitude, double longitude) {
    GeoPlace place;
    double c, w;
    assert_true(georeference_to_geo(r, column, row, &place));
    assert_near(place.latitude, latitude, 1e-9);
    assert_near(remainder(place.longitude - longitude, 360), 0, 1e-9);
    assert_true(georeference_from_geo(r, (GeoPlace){latitude, longitude, 0}, &c, &w));
    assert_near(c, column, 1e-5);
    assert_near(w, row, 1e-5);
}

static Georeference corners(int columns, int rows, bool area, double west, double south, double east, double north) {
    Georeference r;
    Projection lonlat;
    georeference_init(&r);
    projection_lonlat(&lonlat);
    assert_true(georeference_from_corners(&r, &lonlat, (double[]){west, south}, (double[]){east, north}, columns, rows, area));
    return r;
}

static void areas_and_points(void **state) {
    (void)state;
    Georeference point = corners(1201, 1201, false, -72, 44, -71, 45);
    assert_place(&point, 0, 0, 45, -72);
    assert_place(&point, 1200, 1200, 44, -71);
    assert_place(&point, 600, 0, 45, -71.5);
    Georeference area = corners(1200, 1200, true, -72, 44, -71, 45);
    assert_place(&area, -0.5, -0.5, 45, -72);
    assert_place(&area, 0, 0, 45 - 0.5 / 1200, -72 + 0.5 / 1200);
    assert_true(area.area && !point.area);
}

static void around_the_globe(void **state) {
    (void)state;
    /* Across 180 degrees: longitudes go on, and whoever asks may name them either way. */
    Georeference across = corners(3, 2, false, 179, -17, -179, -16);
    assert_place(&across, 0, 0, -16, 179);
    assert_place(&across, 2, 0, -16, -179);
    assert_place(&across, 1, 1, -17, -180);
    GeoPlace a, b;
    assert_true(georeference_to_geo(&across, 0, 0, &a) && georeference_to_geo(&across, 2, 0, &b));
    assert_near(b.longitude - a.longitude, 2, 1e-12);
    /* The whole globe: its two ends are apart. */
    Georeference globe = corners(360, 180, true, -180, -90, 180, 90);
    assert_true(georeference_to_geo(&globe, 0, 0, &a) && georeference_to_geo(&globe, 359, 0, &b));
    assert_near(b.longitude - a.longitude, 359, 1e-9);
    assert_place(&globe, 359, 179, -89.5, 179.5);
    /* UTM zone 60 over its eastern border, web Mercator over its end. */
    Projection p;
    Georeference r;
    georeference_init(&r);
    assert_true(projection_utm(&p, 60, false));
    assert_true(georeference_from_corners(&r, &p, (double[]){700000, 8000000}, (double[]){1000000, 8100000}, 301, 101, false));
    assert_true(georeference_to_geo(&r, 0, 0, &a) && georeference_to_geo(&r, 300, 0, &b));
    assert_true(b.longitude - a.longitude > 2 && b.longitude - a.longitude < 4);
    assert_true(projection_from_epsg(&p, 3857, NULL));
    assert_true(georeference_from_corners(&r, &p, (double[]){19900000, 0}, (double[]){20200000, 100000}, 300, 100, true));
    for (int column = 0; column < 300; column += 23) {
        double c, w;
        assert_true(georeference_to_geo(&r, column, 50, &a));
        a.longitude = remainder(a.longitude, 360);
        assert_true(georeference_from_geo(&r, a, &c, &w));
        assert_near(c, column, 1e-6);
    }
    /* A pole within the map. */
    assert_true(projection_from_epsg(&p, 3413, NULL));
    assert_true(georeference_from_corners(&r, &p, (double[]){-1000, -1000}, (double[]){1000, 1000}, 3, 3, false));
    assert_true(georeference_to_geo(&r, 1, 1, &a));
    assert_near(a.latitude, 90, 1e-9);
    assert_true(georeference_to_geo(&r, 1, 2, &b) && georeference_to_geo(&r, 1, 0, &a));
    assert_near(b.longitude, -45, 1e-9);
    assert_near(remainder(a.longitude - 135, 360), 0, 1e-9);
}

static void small_maps(void **state) {
    (void)state;
    Georeference post = corners(1, 1, false, 7, 46, 7, 46), row = corners(5, 1, false, 7, 46, 8, 46), column = corners(1, 5, false, 7, 46, 7, 47);
    assert_place(&post, 0, 0, 46, 7);
    assert_place(&row, 4, 0, 46, 8);
    assert_place(&column, 0, 4, 46, 7);
    assert_place(&column, 0, 0, 47, 7);
    Georeference r, before;
    Projection lonlat;
    georeference_init(&r);
    before = r;
    projection_lonlat(&lonlat);
    assert_false(georeference_from_corners(&r, &lonlat, (double[]){0, 5}, (double[]){1, 5}, 10, 10, true));
    assert_false(georeference_from_corners(&r, &lonlat, (double[]){0, 6}, (double[]){1, 5}, 10, 10, false));
    assert_false(georeference_from_corners(&r, &lonlat, (double[]){0, 5}, (double[]){1, 6}, 0, 10, false));
    assert_false(georeference_from_corners(&r, &lonlat, (double[]){0, 80}, (double[]){1, 200}, 10, 10, true));
    assert_false(georeference_from_corners(&r, &lonlat, (double[]){(double)NAN, 5}, (double[]){1, 6}, 10, 10, true));
    assert_false(georeference_from_affine(&r, &lonlat, (double[]){0, 1, 2}, (double[]){0, 2, 4}, 10, 10, true));
    assert_false(georeference_from_affine(&r, &lonlat, (double[]){0, 1, VTS_INFINITY}, (double[]){0, 0, 1}, 10, 10, true));
    assert_false(georeference_from_affine(&r, &lonlat, (double[]){0, 0, 0}, (double[]){0, 0, 0}, 10, 10, true));
    assert_memory_equal(&r, &before, sizeof r);
    double c;
    GeoPlace place;
    assert_false(georeference_to_geo(&r, 0, 0, &place) || georeference_from_geo(&r, place, &c, &c));
}

/* ---- GeoTIFF ---- */

static const char path[] = "georeference_test.tif";

/* Keys as quadruples: key, 0, 1, value. */
typedef struct Keys {
    uint16_t values[64];
    uint32_t count;
} Keys;
static Keys keys_of(const uint16_t pairs[][2], size_t count) {
    Keys k = {.values = {1, 1, 0, (uint16_t)count}, .count = 4};
    for (size_t i = 0; i < count; i++) {
        const uint16_t four[] = {pairs[i][0], 0, 1, pairs[i][1]};
        memcpy(k.values + k.count, four, sizeof four);
        k.count += 4;
    }
    return k;
}
#define KEYS(...) keys_of((const uint16_t[][2]){__VA_ARGS__}, sizeof((const uint16_t[][2]){__VA_ARGS__}) / 4)

typedef struct Tags {
    Keys keys;
    const double *scale, *ties, *matrix;
    uint32_t tie_count;
    const char *metadata, *nodata;
    bool big;
} Tags;

static void make(TiffBytes *t, const Tags *tags) {
    *t = (TiffBytes){.width = 10, .height = 8, .big = tags->big};
    if (tags->scale) tiff_add(t, 33550, TIFF_DOUBLE_TYPE, 3, tags->scale);
    if (tags->ties) tiff_add(t, 33922, TIFF_DOUBLE_TYPE, 6 * tags->tie_count, tags->ties);
    if (tags->matrix) tiff_add(t, 34264, TIFF_DOUBLE_TYPE, 16, tags->matrix);
    if (tags->keys.count) tiff_add(t, 34735, TIFF_SHORT_TYPE, tags->keys.count, tags->keys.values);
    if (tags->metadata) tiff_add(t, 42112, TIFF_ASCII_TYPE, (uint32_t)strlen(tags->metadata) + 1, tags->metadata);
    if (tags->nodata) tiff_add(t, 42113, TIFF_ASCII_TYPE, (uint32_t)strlen(tags->nodata) + 1, tags->nodata);
    tiff_finish(t);
}

static GeoreferenceStatus read_tags(const Tags *tags, Georeference *r, StrBuf *error) {
    static TiffBytes t;
    TiffFacts facts;
    make(&t, tags);
    assert_true(tiff_write(path, t.bytes, t.size));
    GeoreferenceStatus status = georeference_read_tiff(path, r, &facts, error);
    unlink(path);
    assert_int_equal(facts.width, 10);
    assert_int_equal(facts.height, 8);
    assert_int_equal(facts.bits, 16);
    return status;
}

static Georeference take_tags(const Tags *tags) {
    Georeference r;
    StrBuf error = {0};
    GeoreferenceStatus status = read_tags(tags, &r, &error);
    if (status != GEOREFERENCE_OK) print_message("%s\n", error.data);
    strbuf_free(&error);
    assert_int_equal(status, GEOREFERENCE_OK);
    return r;
}

static const double degree_scale[] = {0.1, 0.1, 0}, degree_tie[] = {0, 0, 0, 7, 46, 0};

static void pixel_is_area_or_point(void **state) {
    (void)state;
    for (int big = 0; big < 2; big++) {
        Georeference area = take_tags(&(Tags){.keys = KEYS({1024, 2}, {1025, 1}, {2048, 4326}), .scale = degree_scale, .ties = degree_tie, .tie_count = 1, .big = big});
        Georeference point = take_tags(&(Tags){.keys = KEYS({1024, 2}, {1025, 2}, {2048, 4326}), .scale = degree_scale, .ties = degree_tie, .tie_count = 1, .big = big});
        assert_place(&area, 0, 0, 45.95, 7.05);
        assert_place(&point, 0, 0, 46, 7);
        assert_place(&point, 9, 7, 45.3, 7.9);
        assert_true(area.area && !point.area);
    }
}

static void projected(void **state) {
    (void)state;
    /* UTM 32 north by its code; the tie point is not the first pixel. */
    const double scale[] = {30, 30, 0}, tie[] = {4, 2, 0, 500120, 5099940, 0};
    Georeference r = take_tags(&(Tags){.keys = KEYS({1024, 1}, {1025, 2}, {3072, 32632}), .scale = scale, .ties = tie, .tie_count = 1});
    GeoPlace place;
    assert_true(georeference_to_geo(&r, 0, 0, &place));
    UtmPlace utm;
    assert_true(utm_from_geo(place, &utm));
    assert_near(utm.easting, 500000, 1e-6);
    assert_near(utm.northing, 5100000, 1e-6);
    /* Lambert 93, in a turned and sheared map. */
    const double matrix[16] = {20, 5, 0, 700000, 4, -25, 0, 6600000, 0, 0, 0, 0, 0, 0, 0, 1};
    r = take_tags(&(Tags){.keys = KEYS({1024, 1}, {1025, 1}, {3072, 2154}), .matrix = matrix});
    double x = 0, y = 0;
    assert_true(georeference_to_geo(&r, 3, 2, &place) && projection_forward(&r.projection, place, &x, &y));
    assert_near(x, 700000 + 20 * 3.5 + 5 * 2.5, 1e-5);
    assert_near(y, 6600000 + 4 * 3.5 - 25 * 2.5, 1e-5);
    /* The same by four tie points, and by three that lie otherwise. */
    double ties[24];
    for (int i = 0; i < 4; i++) {
        double c = i & 1 ? 10 : 0, w = i & 2 ? 8 : 0;
        memcpy(ties + 6 * i, (double[]){c, w, 0, 700000 + 20 * c + 5 * w, 6600000 + 4 * c - 25 * w, 0}, 6 * sizeof *ties);
    }
    Georeference fitted = take_tags(&(Tags){.keys = KEYS({1024, 1}, {1025, 1}, {3072, 2154}), .ties = ties, .tie_count = 4});
    for (int i = 0; i < 3; i++) {
        assert_near(fitted.x[i], r.x[i], 1e-6);
        assert_near(fitted.y[i], r.y[i], 1e-6);
    }
}

/* Keys that spell a projection out: transverse Mercator in US survey feet. */
static void user_defined(void **state) {
    (void)state;
    static TiffBytes t;
    const double parameters[] = {40, -75, 0.9999, 200000 / 1200.0 * 3937, 0}, scale[] = {100, 100, 0}, tie[] = {0, 0, 0, 700000, 300000, 0};
    const uint16_t keys[] = {1,    1, 0, 10, 1024, 0, 1, 1,     1025, 0,     1, 2, 2048, 0,     1, 4269, 3072, 0,     1, 32767, 3074, 0, 1, 32767, 3075, 0,     1, 1,
                             3076, 0, 1, 9003, 3080, 34736, 1, 1, 3081, 34736, 1, 0, 3082, 34736, 1, 3,    3083, 34736, 1, 4, 3092, 34736, 1, 2};
    uint16_t counted[64];
    memcpy(counted, keys, sizeof keys);
    counted[3] = (uint16_t)(sizeof keys / 8 - 1);
    t = (TiffBytes){.width = 4, .height = 4};
    tiff_add(&t, 33550, TIFF_DOUBLE_TYPE, 3, scale);
    tiff_add(&t, 33922, TIFF_DOUBLE_TYPE, 6, tie);
    tiff_add(&t, 34735, TIFF_SHORT_TYPE, (uint32_t)(sizeof keys / 2), counted);
    tiff_add(&t, 34736, TIFF_DOUBLE_TYPE, 5, parameters);
    tiff_finish(&t);
    assert_true(tiff_write(path, t.bytes, t.size));
    Georeference r;
    StrBuf error = {0};
    GeoreferenceStatus status = georeference_read_tiff(path, &r, NULL, &error);
    unlink(path);
    if (error.size) print_message("%s\n", error.data);
    strbuf_free(&error);
    assert_int_equal(status, GEOREFERENCE_OK);
    const ProjectionParameters *a = &r.projection.parameters;
    assert_int_equal(a->kind, PROJECTION_TRANSVERSE_MERCATOR);
    assert_near(a->unit, 1200.0 / 3937, 1e-15);
    assert_near(a->false_east, 200000, 1e-6);
    assert_near(a->scale, 0.9999, 1e-15);
    assert_near(a->longitude, -75, 1e-12);
    assert_near(a->latitude, 40, 1e-12);
}

static void samples(void **state) {
    (void)state;
    Tags tags = {.keys = KEYS({1024, 2}, {1025, 1}, {2048, 4326}), .scale = degree_scale, .ties = degree_tie, .tie_count = 1};
    Georeference r = take_tags(&tags);
    assert_false(r.has_nodata);
    assert_true(r.scale == 1 && r.offset == 0 && r.unit == 1 && r.heights == GEO_HEIGHTS_UNKNOWN);
    static const struct {
        const char *text;
        bool has;
        double value;
    } nodata[] = {{"-32768", true, -32768}, {"-3.39999999999999996e+38 ", true, -3.4e38}, {"0", true, 0}, {"", false, 0}, {"none", false, 0}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(nodata); i++) {
        tags.nodata = nodata[i].text;
        r = take_tags(&tags);
        assert_int_equal(r.has_nodata, nodata[i].has);
        if (r.has_nodata) assert_near(r.nodata, nodata[i].value, 0);
    }
    tags.nodata = "nan";
    r = take_tags(&tags);
    assert_true(r.has_nodata && isnan(r.nodata));
    tags.metadata = "<GDALMetadata>\n  <Item name=\"SCALE\" sample=\"1\" role=\"scale\">9</Item>\n  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-1000</Item>\n"
                    "  <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.25</Item>\n  <Item name=\"scale\">77</Item>\n  <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item>\n</GDALMetadata>";
    r = take_tags(&tags);
    assert_near(r.scale, 0.25, 0);
    assert_near(r.offset, -1000, 0);
    assert_near(r.unit, 0.3048, 0);
    static const char *const odd[] = {"<Item ", "<Item role=\"scale\" sample=\"0\"", "<Item sample=\"0\" role=\"scale\">", "<Item sample=\"0\" role=\"scale\">0</Item>",
                                      "<Item sample=\"0\" role=\"scale\">inf</Item>", "<Item sample=\"0\" role=\"scale>5", "<Item role=\"", "role=\"scale\">5"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(odd); i++) {
        tags.metadata = odd[i];
        assert_near(take_tags(&tags).scale, 1, 0);
    }
}

static void vertical_systems(void **state) {
    (void)state;
    static const struct {
        uint16_t geographic, vertical, unit;
        GeoHeights heights;
        double metres;
    } table[] = {
        {4326, 5773, 0, GEO_HEIGHTS_GEOID, 1},                  /* EGM96 */
        {4326, 6360, 0, GEO_HEIGHTS_GEOID, 1200.0 / 3937},      /* NAVD88 in US survey feet */
        {4326, 5703, 9002, GEO_HEIGHTS_GEOID, 0.3048},          /* NAVD88, in feet all the same */
        {4326, 5715, 0, GEO_HEIGHTS_GEOID, -1},                 /* depth below the sea */
        {4326, 5030, 9001, GEO_HEIGHTS_ELLIPSOID, 1},           /* as the first GeoTIFFs said it */
        {4979, 0, 0, GEO_HEIGHTS_ELLIPSOID, 1},
        {4326, 0, 9002, GEO_HEIGHTS_UNKNOWN, 0.3048},
        {4326, 60000, 0, GEO_HEIGHTS_GEOID, 1},                 /* no such system */
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        uint16_t pairs[5][2] = {{1024, 2}, {1025, 1}, {2048, table[i].geographic}};
        size_t count = 3;
        if (table[i].vertical) memcpy(pairs[count++], (uint16_t[]){4096, table[i].vertical}, 4);
        if (table[i].unit) memcpy(pairs[count++], (uint16_t[]){4099, table[i].unit}, 4);
        Georeference r = take_tags(&(Tags){.keys = keys_of((const uint16_t(*)[2])pairs, count), .scale = degree_scale, .ties = degree_tie, .tie_count = 1});
        assert_int_equal(r.heights, table[i].heights);
        assert_near(r.unit, table[i].metres, 1e-12);
        assert_int_equal(r.vertical_epsg, table[i].vertical);
    }
}

static void no_system(void **state) {
    (void)state;
    /* Without keys: degrees if they can be that. */
    Georeference r = take_tags(&(Tags){.scale = degree_scale, .ties = degree_tie, .tie_count = 1});
    assert_place(&r, 0, 0, 45.95, 7.05);
    /* Keys and no place: the projection is known. */
    r = take_tags(&(Tags){.keys = KEYS({1024, 1}, {1025, 1}, {3072, 32632})});
    assert_true(!r.placed && r.has_projection);
    r = take_tags(&(Tags){.nodata = "5"});
    assert_true(!r.placed && !r.has_projection && r.has_nodata);
}

static void refused_places(void **state) {
    (void)state;
    const double metres[] = {30, 30, 0}, far[] = {0, 0, 0, 500000, 5000000, 0}, nowhere[] = {0, 0, 0, 7, 4600, 0}, zero[] = {0, 0, 0}, nan[] = {(double)NAN, 1, 0};
    double bent[24], line[18];
    for (int i = 0; i < 4; i++) memcpy(bent + 6 * i, (double[]){i & 1 ? 10 : 0, i & 2 ? 8 : 0, 0, i == 3 ? 9 : 7 + (i & 1), 46 - (i & 2), 0}, 6 * sizeof *bent);
    for (int i = 0; i < 3; i++) memcpy(line + 6 * i, (double[]){i, i, 0, 7 + i, 46 - i, 0}, 6 * sizeof *line);
    const Keys lonlat = KEYS({1024, 2}, {1025, 1}, {2048, 4326});
    const struct {
        Tags tags;
        const char *says;
    } table[] = {
        {{.keys = KEYS({1024, 1}, {1025, 1}, {3072, 26715}), .scale = metres, .ties = far, .tie_count = 1}, "'North American Datum 1927'"},
        {{.keys = KEYS({1024, 1}, {1025, 1}, {3072, 27700}), .scale = metres, .ties = far, .tie_count = 1}, "'Ordnance Survey of Great Britain 1936'"},
        {{.keys = KEYS({1024, 1}, {1025, 1}, {3072, 26931}), .scale = metres, .ties = far, .tie_count = 1}, "oblique Mercator"},
        {{.keys = KEYS({1024, 3}, {1025, 1}), .scale = metres, .ties = far, .tie_count = 1}, "neither geographic nor projected"},
        {{.keys = KEYS({1024, 1}, {1025, 1}, {3072, 12345}), .scale = metres, .ties = far, .tie_count = 1}, "not known"},
        {{.scale = metres, .ties = far, .tie_count = 1}, "not in which coordinate system"},
        {{.keys = lonlat, .scale = degree_scale, .ties = nowhere, .tie_count = 1}, "nowhere on the globe"},
        {{.keys = lonlat, .scale = zero, .ties = degree_tie, .tie_count = 1}, "nowhere on the globe"},
        {{.keys = lonlat, .scale = nan, .ties = degree_tie, .tie_count = 1}, "nowhere on the globe"},
        {{.keys = lonlat, .ties = bent, .tie_count = 4}, "bent"},
        {{.keys = lonlat, .ties = line, .tie_count = 3}, "on a line"},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        Georeference r;
        StrBuf error = {0};
        GeoreferenceStatus status = read_tags(&table[i].tags, &r, &error);
        if (status != GEOREFERENCE_REFUSED || !strstr(error.data, table[i].says)) print_message("%zu: %d %s\n", i, (int)status, error.data ? error.data : "");
        assert_int_equal(status, GEOREFERENCE_REFUSED);
        assert_non_null(strstr(error.data, table[i].says));
        assert_false(r.placed);
        strbuf_free(&error);
    }
}

/* ---- hostile files ---- */

static GeoreferenceStatus read_bytes(const uint8_t *bytes, size_t size) {
    Georeference r;
    StrBuf error = {0};
    assert_true(tiff_write(path, bytes, size));
    GeoreferenceStatus status = georeference_read_tiff(path, &r, NULL, &error);
    assert_true((status == GEOREFERENCE_OK) == (error.size == 0));
    assert_true(status != GEOREFERENCE_UNREADABLE || !r.placed);
    strbuf_free(&error);
    return status;
}

static void no_tiffs(void **state) {
    (void)state;
    static const char text[] = "ncols 3\nnrows 3\nThis is a text, whatever its name says.\n", header[] = "II*\0\xff\xff\xff\xff", far[] = "MM\0*\0\0\xff\xf0";
    assert_int_equal(read_bytes((const uint8_t *)text, sizeof text), GEOREFERENCE_UNREADABLE);
    assert_int_equal(read_bytes((const uint8_t *)header, 8), GEOREFERENCE_UNREADABLE);
    assert_int_equal(read_bytes((const uint8_t *)far, 8), GEOREFERENCE_UNREADABLE);
    assert_int_equal(read_bytes((const uint8_t *)"", 0), GEOREFERENCE_UNREADABLE);
    unlink(path);
    Georeference r;
    assert_int_equal(georeference_read_tiff("there/is/none.tif", &r, NULL, NULL), GEOREFERENCE_UNREADABLE);
    assert_int_equal(georeference_read_tiff(".", &r, NULL, NULL), GEOREFERENCE_UNREADABLE);
    assert_int_equal(mkfifo("georeference_pipe.tif", 0600), 0);
    assert_int_equal(georeference_read_tiff("georeference_pipe.tif", &r, NULL, NULL), GEOREFERENCE_UNREADABLE);
    unlink("georeference_pipe.tif");
}

static void whole_file(TiffBytes *t, bool big) {
    static const double matrix[16] = {0.1, 0, 0, 7, 0, -0.1, 0, 46, 0, 0, 0, 0, 0, 0, 0, 1};
    make(t, &(Tags){.keys = KEYS({1024, 1}, {1025, 1}, {3072, 32632}, {4096, 5773}), .scale = degree_scale, .ties = degree_tie, .tie_count = 1, .matrix = matrix,
                    .metadata = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.25</Item></GDALMetadata>", .nodata = "-9999", .big = big});
}

/* Cut short anywhere: an answer, whatever it is. */
static void cut_short(void **state) {
    (void)state;
    static TiffBytes t;
    whole_file(&t, false);
    assert_int_not_equal(read_bytes(t.bytes, t.size), GEOREFERENCE_UNREADABLE);
    for (size_t size = 0; size < t.size; size += size < 170 ? 40 : 7) read_bytes(t.bytes, size);
    unlink(path);
}

/* Bytes of the directory and of what it points at, changed at random: counts, types, offsets, codes. */
static void garbled(void **state) {
    (void)state;
    static TiffBytes t;
    for (uint64_t i = 0; i < 400; i++) {
        whole_file(&t, i & 1);
        size_t directory = 8 + 2 * t.width * t.height;
        for (uint64_t k = 0; k < 1 + i % 4; k++) {
            uint64_t h = random_hash(i, k, 5, 0);
            static const uint8_t values[] = {0, 1, 0x7f, 0x80, 0xff};
            t.bytes[directory + h % (t.size - directory)] = (h >> 40) % 3 ? values[(h >> 32) % 5] : (uint8_t)(h >> 48);
        }
        read_bytes(t.bytes, t.size);
    }
    unlink(path);
}

/* Sizes and counts beyond all that is there. */
static void lies(void **state) {
    (void)state;
    static TiffBytes t;
    static const uint32_t huge[] = {0, 0x7fffffff, 0xffffffff, 1000000000};
    for (size_t field = 0; field < 16; field++)
        for (size_t i = 0; i < VTS_ARRAY_COUNT(huge); i++) {
            whole_file(&t, false);
            size_t entry = 8 + 2 * t.width * t.height + 2 + 12 * field;
            tiff_put(&t, entry + 4, huge[i], 4); /* the count */
            read_bytes(t.bytes, t.size);
            whole_file(&t, false);
            tiff_put(&t, entry + 8, huge[i], 4); /* the value, or where it lies */
            read_bytes(t.bytes, t.size);
        }
    whole_file(&t, false);
    tiff_put(&t, 8 + 2 * t.width * t.height + 2 + 8, 0xfffffff0, 4);
    assert_int_equal(read_bytes(t.bytes, t.size), GEOREFERENCE_UNREADABLE);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_and_points), cmocka_unit_test(around_the_globe), cmocka_unit_test(small_maps),     cmocka_unit_test(pixel_is_area_or_point),
        cmocka_unit_test(projected),        cmocka_unit_test(user_defined),     cmocka_unit_test(samples),        cmocka_unit_test(vertical_systems),
        cmocka_unit_test(no_system),        cmocka_unit_test(refused_places),   cmocka_unit_test(no_tiffs),       cmocka_unit_test(cut_short),
        cmocka_unit_test(garbled),          cmocka_unit_test(lies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
