/* Map projections: values of PROJ 9.1, the ways back, and systems that are refused. */
#include "base/random.h"
#include "terrain/projection.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) print_message("%.12g is not %.12g\n", a, b);
    assert_true(fabs(a - b) <= tolerance);
}

static void take_epsg(Projection *p, int code) {
    StrBuf error = {0};
    bool ok = projection_from_epsg(p, code, &error);
    if (!ok) print_message("EPSG:%d: %s\n", code, error.data);
    strbuf_free(&error);
    assert_true(ok);
}

/* Metres between two places, roughly. */
static double apart(GeoPlace a, GeoPlace b) {
    return 111e3 * hypot(a.latitude - b.latitude, remainder(a.longitude - b.longitude, 360) * cos(a.latitude * VTS_RADIANS));
}

static void values_of_proj(void **state) {
    (void)state;
    static const struct {
        int code;
        double latitude, longitude, x, y;
    } table[] = {
        {3035, 63, 21, 4878390.2688, 4476814.4744},
        {3035, 38.7, -9.5, 2634521.3264, 1952301.5357},
        {6931, 89.5, -100, -54998.3599, 9697.6947},
        {6932, -71, 33, 1150121.9051, 1771032.4258},
        {3031, -77.85, 166.7, 304792.0965, -1289361.3032},
        {3413, 70, -51, -228700.7149, -2175941.9527},
        {5070, 46, -118, -1691418.7873, 2753519.3917},
        {3577, -38, 145, 1147633.1431, -4212901.0072}, /* Albers in the south */
        {2154, 43.7, 7.4, 1054581.2954, 6298878.1246},
        {32633, 52.5, 13.4, 391390.7313, 5817855.2408},
        {2225, 40.6, -122.4, 6450599.6162, 2102109.8298}, /* in US survey feet */
        {3395, -53, -70, -7792364.3555, -6948849.3848},
        {2193, -41.3, 174.8, 1750697.5213, 5426376.6232},
        {3857, 71, -179.5, -19981848.5974, 11402272.1593},
        {3832, 5, 179, 3228265.2330, 553583.8468},
        {5041, 85, 10, 2096454.1638, 1452981.2545},
        {3005, 48.4, -123.4, 1192894.1780, 379568.6092},
        {2180, 52.2, 21, 636640.4670, 483432.2008},
        {4087, -40, 100, 11131949.0793, -4452779.6317},
        {3414, 1.29, 103.85, 29856.4998, 30267.1712},
        {26910, 37, -122, 588977.3244, 4095339.6911},
        {3978, 44.6, -63.6, 2439338.1209, 120953.7556},
        {4326, 44.6, -63.6, -63.6, 44.6},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        Projection p;
        double x, y;
        GeoPlace place = {table[i].latitude, table[i].longitude, 0}, back;
        take_epsg(&p, table[i].code);
        assert_true(projection_forward(&p, place, &x, &y));
        assert_near(x, table[i].x, 2e-4);
        assert_near(y, table[i].y, 2e-4);
        assert_true(projection_reverse(&p, x, y, &back));
        assert_near(apart(back, place), 0, 1e-6);
    }
}

/* Arithmetic codes against their definitions, which need no lists. */
static void utm_codes(void **state) {
    (void)state;
    for (int zone = 1; zone <= 60; zone++)
        for (int south = 0; south < 2; south++) {
            Projection p;
            UtmPlace utm;
            double x = 0, y = 0;
            GeoPlace place = {south ? -33.3 : 41.7, 6 * zone - 184.9, 0};
            take_epsg(&p, (south ? 32700 : 32600) + zone);
            assert_true(utm_from_geo(place, &utm) && projection_forward(&p, place, &x, &y));
            assert_int_equal(utm.zone, zone);
            assert_near(x, utm.easting, 1e-6);
            assert_near(y, utm.northing, 1e-6);
        }
    for (int code = 32661; code <= 32761; code += 100) {
        Projection p;
        UtmPlace utm;
        double x = 0, y = 0;
        GeoPlace place = {code == 32661 ? 87.1 : -85.2, 133, 0};
        take_epsg(&p, code);
        assert_true(utm_from_geo(place, &utm) && projection_forward(&p, place, &x, &y));
        assert_near(hypot(x - utm.easting, y - utm.northing), 0, 1e-6);
    }
}

/* Forth and back over the globe, poles and the meridian of 180 degrees too; where a map ends it says so. */
static void round_trips(void **state) {
    (void)state;
    static const ProjectionParameters all[] = {
        {.kind = PROJECTION_LONLAT, .unit = 0.9, .prime_meridian = 2.337},
        {.kind = PROJECTION_LAMBERT_CONFORMAL, .latitude = -37, .longitude = 179, .parallels = {-36, -38}, .false_east = 7e5},
        {.kind = PROJECTION_LAMBERT_CONFORMAL, .latitude = 46.8, .parallels = {46.8, 46.8}, .scale = 0.99987742, .prime_meridian = 2.337},
        {.kind = PROJECTION_ALBERS, .latitude = -10, .longitude = 132, .parallels = {-18, -36}},
        {.kind = PROJECTION_ALBERS, .latitude = 23, .longitude = -96, .parallels = {29.5, 45.5}, .unit = 0.3048},
        {.kind = PROJECTION_POLAR_STEREOGRAPHIC, .latitude = 90, .longitude = -45, .parallels = {70, 0}, .scale = 0},
        {.kind = PROJECTION_POLAR_STEREOGRAPHIC, .latitude = -90, .parallels = {-71, 0}},
        {.kind = PROJECTION_MERCATOR, .longitude = 100, .parallels = {-41, 0}},
        {.kind = PROJECTION_LAMBERT_AZIMUTHAL, .latitude = 52, .longitude = 10, .false_east = 4321000},
        {.kind = PROJECTION_LAMBERT_AZIMUTHAL, .latitude = 90, .longitude = 180},
        {.kind = PROJECTION_LAMBERT_AZIMUTHAL, .latitude = 0, .longitude = 170},
        {.kind = PROJECTION_EQUIRECTANGULAR, .parallels = {45, 0}},
        {.kind = PROJECTION_WEB_MERCATOR},
    };
    static const double latitudes[] = {-90, -89.999999, -66, -1e-9, 0, 35, 89.9999, 90};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(all); i++) {
        Projection p;
        int met = 0;
        assert_true(projection_init(&p, &all[i], NULL));
        for (uint64_t k = 0; k < 400; k++) {
            double latitude = k < 80 ? latitudes[k % VTS_ARRAY_COUNT(latitudes)] : 170 * random_unit(random_hash(k, 0, 0, 0)) - 85, x, y;
            GeoPlace place = {latitude, k % 9 == 0 ? 180 : 360 * random_unit(random_hash(k, 1, 0, 0)) - 180, 0}, back;
            if (!projection_forward(&p, place, &x, &y)) continue;
            assert_true(isfinite(x) && isfinite(y));
            /* Far from their middle maps lose digits with their scale, the azimuthal one at its rim; a pole that is a line loses its longitude. */
            double reach = all[i].kind == PROJECTION_LAMBERT_AZIMUTHAL ? 1.2e7 : 2e7;
            if (fabs(latitude) < 86 && hypot(x - p.shift[0], y - p.shift[1]) * p.parameters.unit < reach && projection_reverse(&p, x, y, &back)) {
                assert_near(apart(back, place), 0, 1e-5);
                met++;
            }
        }
        assert_true(met > 100);
    }
}

/* An equal-area map is one, a conformal one has the same scale in all directions. */
static void properties(void **state) {
    (void)state;
    static const struct {
        int code;
        bool conformal;
    } maps[] = {{3035, false}, {5070, false}, {3577, false}, {6932, false}, {2154, true}, {3413, true}, {32633, true}, {3395, true}};
    const double f = 1 / 298.257223563, e2 = f * (2 - f), step = 1e-5;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(maps); i++) {
        Projection p;
        take_epsg(&p, maps[i].code);
        bool south = maps[i].code == 3577 || maps[i].code == 6932;
        for (int k = 0; k < 20; k++) {
            double latitude = (south ? -1 : 1) * (35 + k), longitude = p.meridian + 0.4 * k - 3, x[3], y[3];
            const GeoPlace at[3] = {{latitude, longitude, 0}, {latitude, longitude + step, 0}, {latitude + step, longitude, 0}};
            for (int j = 0; j < 3; j++) assert_true(projection_forward(&p, at[j], &x[j], &y[j]));
            double s = sin(latitude * VTS_RADIANS), w = 1 - e2 * s * s, unit = 6378137 * step * VTS_RADIANS;
            double east = unit * cos(latitude * VTS_RADIANS) / sqrt(w), north = unit * (1 - e2) / pow(w, 1.5);
            double ex = (x[1] - x[0]) / east, ey = (y[1] - y[0]) / east, nx = (x[2] - x[0]) / north, ny = (y[2] - y[0]) / north;
            if (maps[i].conformal) {
                assert_near(ex * nx + ey * ny, 0, 1e-5);
                assert_near(hypot(ex, ey) / hypot(nx, ny), 1, 1e-5);
            } else assert_near(ex * ny - ey * nx, 1, 1e-5);
        }
    }
}

static void refused_systems(void **state) {
    (void)state;
    static const struct {
        int code;
        const char *says;
    } table[] = {
        {26715, "'North American Datum 1927'"}, {23030, "'European Datum 1950'"}, {27700, "'Ordnance Survey of Great Britain 1936'"},
        {30161, "'Tokyo'"}, {2100, "'Greek Geodetic Reference System 1987'"}, {2039, "'Israel 1993'"}, {28992, "'Amersfoort'"}, {4807, "'Nouvelle"},
        {26931, "oblique Mercator"}, {2953, "oblique stereographic"}, {5880, "polyconic"}, {0, "EPSG:0"}, {-7, "EPSG:-7"}, {1, "EPSG:1"},
        {99999, "EPSG:99999"}, {2147483647, "EPSG:2147483647"},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        Projection p;
        StrBuf error = {0};
        assert_false(projection_from_epsg(&p, table[i].code, &error));
        if (!strstr(error.data, table[i].says)) print_message("EPSG:%d: %s\n", table[i].code, error.data);
        assert_non_null(strstr(error.data, table[i].says));
        assert_true(strstr(error.data, "gdalwarp") || strstr(error.data, "326zz"));
        strbuf_free(&error);
        assert_false(projection_from_epsg(&p, table[i].code, NULL));
    }
}

static void nonsense_parameters(void **state) {
    (void)state;
    const double nan = (double)NAN, inf = VTS_INFINITY;
    const ProjectionParameters all[] = {
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .scale = -1},
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .scale = nan},
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .axis = -5},
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .axis = 6e6, .flattening = 1},
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .false_east = inf},
        {.kind = PROJECTION_TRANSVERSE_MERCATOR, .unit = -1},
        {.kind = PROJECTION_LAMBERT_CONFORMAL, .parallels = {95, 0}},
        {.kind = PROJECTION_LAMBERT_CONFORMAL, .latitude = 91},
        {.kind = PROJECTION_ALBERS, .parallels = {30, -30}, .latitude = nan},
        {.kind = PROJECTION_POLAR_STEREOGRAPHIC, .latitude = 70},
        {.kind = PROJECTION_EQUIRECTANGULAR, .parallels = {90, 0}},
        {.kind = PROJECTION_LONLAT, .prime_meridian = inf},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(all); i++) {
        Projection p;
        StrBuf error = {0};
        assert_false(projection_init(&p, &all[i], &error));
        assert_true(error.size > 10);
        strbuf_free(&error);
    }
    Projection utm;
    double x, y;
    GeoPlace place;
    assert_false(projection_utm(&utm, 61, true));
    assert_false(projection_utm(&utm, -1, true));
    assert_true(projection_utm(&utm, 31, true));
    assert_false(projection_forward(&utm, (GeoPlace){91, 0, 0}, &x, &y));
    assert_false(projection_forward(&utm, (GeoPlace){nan, 0, 0}, &x, &y));
    assert_false(projection_reverse(&utm, nan, 0, &place));
    assert_false(projection_reverse(&utm, 0, inf, &place));
    projection_lonlat(&utm);
    assert_false(projection_reverse(&utm, 10, 90.01, &place));
    assert_true(projection_reverse(&utm, 10, 90.0000001, &place));
    assert_near(place.latitude, 90, 0);
}

static void descriptions(void **state) {
    (void)state;
    static const struct {
        int code;
        const char *says;
    } table[] = {
        {4326, "longitude and latitude"}, {32733, "UTM zone 33 south"}, {3006, "UTM zone 33 north"}, {3857, "web Mercator"},
        {2225, "Lambert's conformal conic about 39.33333333N 122W, parallels 41.66666667N and 40N, in US survey feet"},
        {3413, "polar stereographic about 90N 45W"},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        Projection p;
        StrBuf text = {0};
        take_epsg(&p, table[i].code);
        projection_describe(&p, &text);
        assert_string_equal(text.data, table[i].says);
        strbuf_free(&text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_of_proj), cmocka_unit_test(utm_codes),           cmocka_unit_test(round_trips),  cmocka_unit_test(properties),
        cmocka_unit_test(refused_systems), cmocka_unit_test(nonsense_parameters), cmocka_unit_test(descriptions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
