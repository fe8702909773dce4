/* Places on the globe: fixed values of GeographicLib 2.1's programs CartConvert, GeodSolve and GeoConvert, and where these are installed
 * the programs themselves, on random places and on all that are nasty. */
#include "base/random.h"
#include "terrain/geodesy.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const double MILLIMETRE = 1e-3;
static const GeoPlace origin = {46.5, 7.9, 1200};

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) print_message("%.12g is not %.12g\n", a, b);
    assert_true(fabs(a - b) <= tolerance);
}

/* ---- fixed values ---- */

static void scene_points(void **state) {
    (void)state;
    /* latitude, longitude, height; east, north, up about the origin */
    static const double table[][6] = {
        {46.6, 8, 0, 7662.170473, 11121.050567, -1214.303433},
        {-33.8, 151.2, 50, 3170803.582845, 678513.179463, -11855491.649928},
        {90, 0, 0, 0, 4397056.767767, -1757068.805098},
        {-90, 0, -100, 0, -4354273.480900, -10979046.690914},
        {0, 180, 8848, 877856.253871, 4610343.220847, -10722879.123266},
        {84.5, -179.999, -430, 84286.015713, 4817143.374646, -2196921.192632},
        {46.5, 367.9, 1200, 0, 0, 0},
    };
    GeoFrame frame;
    assert_true(geo_frame_init(&frame, origin, false));
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        const double *t = table[i];
        Vec3 p;
        GeoPlace back;
        assert_true(geo_to_scene(&frame, (GeoPlace){t[0], t[1], t[2]}, &p));
        assert_near(p.x, t[3], 2e-6);
        assert_near(p.z, t[4], 2e-6);
        assert_near(p.y, t[5], 2e-6);
        assert_true(scene_to_geo(&frame, p, &back));
        assert_near(back.latitude, t[0], 1e-9);
        assert_near(remainder(back.longitude - t[1], 360) * cos(t[0] * VTS_RADIANS), 0, 1e-9);
        assert_near(back.height, t[2], MILLIMETRE);
    }
}

static void geodesic_lines(void **state) {
    (void)state;
    static const double table[][7] = {
        {0, 0, 0.5, 179.7, 15.55688279349, -15.55748610915, 19944127.420750},
        {0, 0, 0, 180, 0, 0, 20003931.458625},
        {90, 0, -90, 0, 180, 0, 20003931.458625},
        {10, 179.9, 10, -179.9, 89.98263516502, -89.98263516502, 21927.872478},
        {46, 8, 46, 8, 180, 0, 0},
        {-70, 20, 71, -150, -68.44198511333, 77.68990446983, 19618825.611767},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        const double *t = table[i];
        GeodesicLine line;
        assert_true(geodesic_inverse((GeoPlace){t[0], t[1], 9}, (GeoPlace){t[2], t[3], -50}, &line));
        assert_near(line.distance, t[6], 2e-6);
        assert_near(line.azimuth, t[4], 1e-9);
        assert_near(line.azimuth_back, t[5], 1e-9);
        GeoPlace there;
        assert_true(geodesic_direct((GeoPlace){t[0], t[1], 9}, line.azimuth, line.distance, &there));
        assert_near(there.latitude, t[2], 1e-9);
        assert_near(there.height, 9, 0);
    }
}

static void utm_places(void **state) {
    (void)state;
    static const struct {
        double latitude, longitude;
        int zone;
        bool north;
        double easting, northing;
    } table[] = {
        {0, 0, 31, true, 166021.443081, 0},
        {-0.000001, 0, 31, false, 166021.443081, 9999999.889317},
        {56, 3, 32, true, 126049.970713, 6222336.335317}, /* Norway's wide zone */
        {55.999999, 3, 31, true, 500000, 6206079.475955},
        {60, 2.999999, 31, true, 499999.944222, 6651411.190363},
        {64, 3, 31, true, 500000, 7097014.162587},
        {63, 11.9999999, 32, true, 651916.847404, 6989134.047995},
        {72, 8.999999, 31, true, 706636.461552, 7999233.633797}, /* Svalbard's */
        {72, 9, 33, true, 293363.504110, 7999233.637230},
        {72, 20.999999, 33, true, 706636.461552, 7999233.633797},
        {72, 21, 35, true, 293363.504110, 7999233.637230},
        {80, 33, 37, true, 383885.348663, 8887579.007720},
        {83.999999, 42, 38, true, 465005.339128, 9329005.070960},
        {84, 42, 0, true, 2446127.912642, 1504524.757005},
        {-80, 0, 31, false, 441867.784867, 1116915.044052},
        {-80.000001, 0, 0, false, 2000000, 3112951.025115},
        {90, 77, 0, true, 2000000, 2000000},
        {-90, 77, 0, false, 2000000, 2000000},
        {10, 180, 1, true, 171071.263941, 1106908.854243},
        {10, -180, 1, true, 171071.263941, 1106908.854243},
        {10, 179.9999999, 60, true, 828928.725085, 1106908.854143},
        {-45, 540, 1, false, 263553.973899, 5012670.495301},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        UtmPlace utm;
        assert_true(utm_from_geo((GeoPlace){table[i].latitude, table[i].longitude, 0}, &utm));
        assert_int_equal(utm.zone, table[i].zone);
        assert_int_equal(utm.north, table[i].north);
        assert_near(utm.easting, table[i].easting, 2e-6);
        assert_near(utm.northing, table[i].northing, 2e-6);
    }
}

/* ---- closed forms ---- */

/* Straight up and down at the origin, and the fall of the earth: x²/2r with r the radius of curvature along the meridian. */
static void curvature(void **state) {
    (void)state;
    const double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f), s = sin(origin.latitude * VTS_RADIANS);
    const double meridian = a * (1 - e2) / pow(1 - e2 * s * s, 1.5) + origin.height;
    GeoFrame frame;
    Vec3 p;
    assert_true(geo_frame_init(&frame, origin, false));
    assert_true(geo_to_scene(&frame, (GeoPlace){origin.latitude, origin.longitude, origin.height - 300}, &p));
    assert_near(vec3_length(vec3_sub(p, vec3(0, -300, 0))), 0, 1e-8);
    assert_true(geo_to_scene(&frame, (GeoPlace){origin.latitude + 0.01, origin.longitude, origin.height}, &p));
    assert_near(p.y, -p.z * p.z / (2 * meridian), 1e-4);
    assert_near(p.x, 0, 1e-8);
}

/* The map of a flat frame keeps distances and azimuths from the origin, and heights. */
static void flat_frame(void **state) {
    (void)state;
    GeoFrame frame;
    assert_true(geo_frame_init(&frame, (GeoPlace){-17.5, 179.95, 10}, true));
    for (uint64_t i = 0; i < 300; i++) {
        double azimuth = 360 * random_unit(random_hash(1, i, 0, 0)) - 180, distance = exp(16 * random_unit(random_hash(2, i, 0, 0)));
        GeoPlace there, back;
        Vec3 p, up;
        assert_true(geodesic_direct(frame.origin, azimuth, distance, &there));
        there.height = 500;
        assert_true(geo_to_scene(&frame, there, &p));
        assert_near(p.y, 490, 1e-9);
        assert_near(hypot(p.x, p.z), distance, MILLIMETRE);
        assert_near(remainder(atan2(p.x, p.z) / VTS_RADIANS - azimuth, 360) * VTS_RADIANS * distance, 0, MILLIMETRE);
        assert_true(scene_to_geo(&frame, p, &back));
        assert_near(back.latitude, there.latitude, 1e-8);
        assert_near(back.height, 500, 1e-9);
        assert_true(geo_direction_to_scene(&frame, there, vec3(0, 1, 0), &up));
        assert_near(up.y, 1, 1e-12);
    }
}

/* Directions turn with the frame as differences of points do. */
static void directions(void **state) {
    (void)state;
    for (int flat = 0; flat < 2; flat++) {
        GeoFrame frame;
        GeoPlace place = {47.2, 9.1, 700}, north = {47.2 + 1e-5, 9.1, 700}, higher = {47.2, 9.1, 701};
        Vec3 at = {0}, to = {0}, above = {0}, d = {0}, up = {0};
        assert_true(geo_frame_init(&frame, origin, flat));
        assert_true(geo_to_scene(&frame, place, &at) && geo_to_scene(&frame, north, &to) && geo_to_scene(&frame, higher, &above));
        assert_true(geo_direction_to_scene(&frame, place, vec3(0, 0, 1), &d) && geo_direction_to_scene(&frame, place, vec3(0, 1, 0), &up));
        /* The flat map stretches across: its turning is the mean of what it does to east and north. */
        assert_near(vec3_length(vec3_sub(vec3_normalize(vec3_sub(to, at)), d)), 0, flat ? 1e-4 : 1e-6);
        assert_near(vec3_length(vec3_sub(vec3_sub(above, at), up)), 0, 1e-6);
    }
}

/* ---- no places ---- */

static void no_places(void **state) {
    (void)state;
    const double nan = (double)NAN, inf = VTS_INFINITY;
    const GeoPlace wrong[] = {{90.0001, 0, 0}, {-91, 0, 0}, {nan, 0, 0}, {0, nan, 0}, {0, inf, 0}, {0, -inf, 0}, {0, 0, nan}, {inf, 0, 0}};
    GeoFrame frame, flat;
    Vec3 p = {7, 7, 7};
    UtmPlace utm;
    GeodesicLine line;
    GeoPlace back;
    assert_true(geo_frame_init(&frame, origin, false) && geo_frame_init(&flat, origin, true));
    for (size_t i = 0; i < VTS_ARRAY_COUNT(wrong); i++) {
        GeoFrame other;
        assert_false(geo_to_scene(&frame, wrong[i], &p));
        assert_false(geo_to_scene(&flat, wrong[i], &p));
        assert_false(geo_frame_init(&other, wrong[i], false));
        if (isfinite(wrong[i].height)) {
            assert_false(utm_from_geo(wrong[i], &utm));
            assert_false(geodesic_inverse(wrong[i], origin, &line));
            assert_false(geodesic_inverse(origin, wrong[i], &line));
        }
    }
    assert_near(p.x, 7, 0);
    assert_false(scene_to_geo(&frame, vec3(nan, 0, 0), &back));
    assert_false(scene_to_geo(&flat, vec3(0, inf, 0), &back));
    /* The middle of the earth has some place, and what is very far has one. */
    assert_true(scene_to_geo(&frame, mat3_apply_transposed(&frame.axes, vec3_negate(frame.centre)), &back));
    assert_true(scene_to_geo(&frame, vec3(1e12, 1e12, -1e12), &back));
    assert_true(utm_from_geo((GeoPlace){10, 1e9, 0}, &utm));
}

/* ---- GeographicLib's programs ---- */

enum { RANDOM_PLACES = 2000 };

static GeoPlace nasty_or_random(uint64_t i) {
    static const double latitudes[] = {0, -0.0, 1e-20, -1e-20, 90, -90, 89.9999999, -89.9999999, 84, 83.9999999, -80, -80.0000001, 56, 64, 72};
    static const double longitudes[] = {0, 180, -180, 179.9999999, -179.9999999, 3, 9, 12, 21, 33, 42, 359, -200, 2.9999999};
    const uint64_t most = VTS_ARRAY_COUNT(latitudes) * VTS_ARRAY_COUNT(longitudes);
    if (i < most) return (GeoPlace){latitudes[i / VTS_ARRAY_COUNT(longitudes)], longitudes[i % VTS_ARRAY_COUNT(longitudes)], 0};
    return (GeoPlace){180 * random_unit(random_hash(i, 0, 0, 0)) - 90, 360 * random_unit(random_hash(i, 1, 0, 0)) - 180,
                      9000 * random_unit(random_hash(i, 2, 0, 0)) - 500};
}

/* Writes the places that `line` makes of each number (without exponents: an e is east to the programs), runs the program on them and hands its lines to `check`. */
static void run_program(const char *command, void (*line)(FILE *out, uint64_t i), void (*check)(uint64_t i, const char *text)) {
    char path[] = "vts_geodesy_XXXXXX", program[600], text[400];
    int file = mkstemp(path);
    assert_true(file >= 0);
    FILE *out = fdopen(file, "w");
    for (uint64_t i = 0; i < RANDOM_PLACES; i++) line(out, i);
    fclose(out);
    snprintf(program, sizeof program, "%s < %s", command, path);
    FILE *in = popen(program, "r");
    uint64_t count = 0;
    for (; in && fgets(text, sizeof text, in); count++) check(count, text);
    pclose(in);
    unlink(path);
    assert_int_equal(count, RANDOM_PLACES);
}

static bool is_there(const char *program) {
    char command[200];
    snprintf(command, sizeof command, "command -v %s > /dev/null 2>&1", program);
    return system(command) == 0;
}

static void place_line(FILE *out, uint64_t i) {
    GeoPlace p = nasty_or_random(i);
    fprintf(out, "%.25f %.25f %.25f\n", p.latitude, p.longitude, p.height);
}

static void check_scene(uint64_t i, const char *text) {
    GeoFrame frame;
    Vec3 p = {0};
    double east, north, up;
    assert_int_equal(sscanf(text, "%lf %lf %lf", &east, &north, &up), 3);
    assert_true(geo_frame_init(&frame, origin, false) && geo_to_scene(&frame, nasty_or_random(i), &p));
    assert_near(vec3_length(vec3_sub(p, vec3(east, up, north))), 0, 1e-6);
}

static void pair_line(FILE *out, uint64_t i) {
    GeoPlace a = nasty_or_random(i), b = nasty_or_random((i * 7919 + 13) % RANDOM_PLACES);
    fprintf(out, "%.25f %.25f %.25f %.25f\n", a.latitude, a.longitude, b.latitude, b.longitude);
}

static void check_line(uint64_t i, const char *text) {
    GeodesicLine line;
    double azimuth, back, distance;
    assert_int_equal(sscanf(text, "%lf %lf %lf", &azimuth, &back, &distance), 3);
    assert_true(geodesic_inverse(nasty_or_random(i), nasty_or_random((i * 7919 + 13) % RANDOM_PLACES), &line));
    assert_near(line.distance, distance, 1e-6);
    assert_near(remainder(line.azimuth - azimuth, 360), 0, 1e-9);
    assert_near(remainder(line.azimuth_back - back, 360), 0, 1e-9);
}

static void lonlat_line(FILE *out, uint64_t i) {
    GeoPlace p = nasty_or_random(i);
    fprintf(out, "%.25f %.25f\n", p.latitude, p.longitude);
}

static void check_utm(uint64_t i, const char *text) {
    UtmPlace utm;
    char zone[16], expected[16];
    double easting, northing;
    assert_int_equal(sscanf(text, "%15s %lf %lf", zone, &easting, &northing), 3);
    assert_true(utm_from_geo(nasty_or_random(i), &utm));
    if (utm.zone) snprintf(expected, sizeof expected, "%02d%c", utm.zone, utm.north ? 'n' : 's');
    else snprintf(expected, sizeof expected, "%c", utm.north ? 'n' : 's');
    assert_string_equal(zone, expected);
    assert_near(utm.easting, easting, 1e-6);
    assert_near(utm.northing, northing, 1e-6);
}

static void programs(void **state) {
    (void)state;
    if (!is_there("CartConvert") || !is_there("GeodSolve") || !is_there("GeoConvert")) skip();
    run_program("CartConvert -l 46.5 7.9 1200 -p 9", place_line, check_scene);
    run_program("GeodSolve -i -b -p 9", pair_line, check_line);
    run_program("GeoConvert -u -p 9", lonlat_line, check_utm);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scene_points), cmocka_unit_test(geodesic_lines), cmocka_unit_test(utm_places), cmocka_unit_test(curvature),
        cmocka_unit_test(flat_frame),   cmocka_unit_test(directions),     cmocka_unit_test(no_places),  cmocka_unit_test(programs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
