/* Where the sun stands: NREL's published example, Meeus' examples, the equinoxes and solstices of almanacs; dates right and wrong. */
#include "terrain/sun.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance)) print_message("%.12g is not %.12g\n", a, b);
    assert_true(fabs(a - b) <= tolerance);
}

static double days_of(const char *text) {
    double days = 0;
    StrBuf error = {0};
    if (!sun_parse_time(text, &days, &error)) fail_msg("%s", error.data);
    strbuf_free(&error);
    return days;
}

static Vec3 sun_at(GeoPlace place, const char *time) {
    Vec3 d = {0};
    assert_true(sun_direction(place, days_of(time), &d));
    assert_near(vec3_length(d), 1, 1e-12);
    return d;
}
static double elevation(Vec3 d) { return asin(d.y) / VTS_RADIANS; }
static double azimuth(Vec3 d) { return fmod(360 + atan2(d.x, d.z) / VTS_RADIANS, 360); }

/* Reda & Andreas, Solar Position Algorithm for Solar Radiation Applications (NREL/TP-560-34302), appendix A.5: topocentric elevation
 * without refraction e0, and azimuth. */
static void example_of_nrel(void **state) {
    (void)state;
    Vec3 d = sun_at((GeoPlace){39.742476, -105.1786, 1830.14}, "2003-10-17T12:30:30-07:00");
    assert_near(elevation(d), 39.872046, 0.0005);
    assert_near(azimuth(d), 194.34024, 0.0005);
}

/* At the pole the elevation is the declination, less the parallax of 8.8 seconds of arc. */
static double declination(const char *time) {
    Vec3 d = sun_at((GeoPlace){90, 0, 0}, time);
    return elevation(d) + 8.794 / 3600 * cos(asin(d.y));
}

static void declinations(void **state) {
    (void)state;
    assert_near(declination("1992-10-12T23:59:01Z"), -7.783817, 0.0005); /* Meeus, example 25.b */
    static const char *const equinoxes[] = {"2000-03-20T07:35Z", "2000-09-22T17:28Z", "2026-03-20T14:46Z", "2026-09-23T00:05Z", "2003-03-21T01:00Z", "1962-03-21T02:30Z"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(equinoxes); i++) assert_near(declination(equinoxes[i]), 0, 0.001);
    assert_near(declination("2000-06-21T01:48Z"), 23.4379, 0.001);
    assert_near(declination("2000-12-21T13:37Z"), -23.4379, 0.001);
    assert_near(declination("2026-06-21T08:25Z"), 23.4375, 0.0015);
}

/* The sun crosses the meridian when the equation of time says so (3 November: 16 min 26 s early; 11 February: 14 min 14 s late). */
static void noons(void **state) {
    (void)state;
    static const struct {
        const char *time;
        double longitude;
    } table[] = {{"2019-11-03T11:43:34Z", 0}, {"2019-02-11T12:14:13Z", 0}, {"2019-11-03T17:43:34Z", -90}, {"2019-11-03T01:43:34+02:00", 180}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) {
        assert_near(azimuth(sun_at((GeoPlace){50, table[i].longitude, 0}, table[i].time)), 180, 0.02);
        assert_near(remainder(azimuth(sun_at((GeoPlace){-50, table[i].longitude, 0}, table[i].time)), 360), 0, 0.02);
    }
}

/* Height and parallax: from high above one sees the sun from elsewhere. */
static void parallax(void **state) {
    (void)state;
    Vec3 low = sun_at((GeoPlace){0, 0, 0}, "2026-03-20T06:07Z"), high = sun_at((GeoPlace){0, 0, 6378137}, "2026-03-20T06:07Z");
    assert_near(elevation(low) - elevation(high), 8.794 / 3600, 1e-4);
}

static void times(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double days;
    } table[] = {
        {"2000-01-01T12:00Z", 0},          {"2000-01-01", -0.5},           {"2000-01-01T14:00+02:00", 0},   {"2000-01-01T04:30-0730", 0},
        {"2000-01-01T13:00+01", 0},        {"2000-01-01 12:00", 0},        {"2000-01-01T24:00", 0.5},       {"2000-03-01", 59.5},
        {"1900-03-01", -36465.5},          {"2004-02-29", 1519.5},         {"2001-01-01", 365.5},           {"1987-01-27", -4722.5},
        {"1600-12-31", -145732.5},         {"0333-01-27", -608833.5},      {"2000-01-01T12:00:30.5", 30.5 / 86400}, {"2016-12-31T23:59:60Z", 6209.5},
        {"2000-01-01T12:00:30,25Z", 30.25 / 86400},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(table); i++) assert_near(days_of(table[i].text), table[i].days, 1e-9);
}

static void no_times(void **state) {
    (void)state;
    static const char *const wrong[] = {
        "", "x", "2026", "2026-06", "2026-6-1", "26-06-21", "2026-13-01", "2026-00-01", "2026-01-00", "2026-04-31", "2026-02-29", "1900-02-29", "2100-02-29",
        "2026-06-21T", "2026-06-21T1", "2026-06-21T10", "2026-06-21T10:", "2026-06-21T10:60", "2026-06-21T25:00", "2026-06-21T24:01", "2026-06-21T10:00:61",
        "2026-06-21T10:00:", "2026-06-21T10:00:00.", "2026-06-21T10:00X", "2026-06-21T10:00+", "2026-06-21T10:00+2", "2026-06-21T10:00+02:",
        "2026-06-21T10:00+02:0", "2026-06-21T10:00+99:00", "2026-06-21T10:00+02:60", "2026-06-21T10:00Z ", " 2026-06-21", "2026-06-21Z", "2026/06/21", "-2026-06-21",
        "2026-06-21T10:00Z+02:00", "tomorrow",
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(wrong); i++) {
        double days = 7;
        StrBuf error = {0};
        if (sun_parse_time(wrong[i], &days, &error)) fail_msg("'%s' was taken for %g", wrong[i], days);
        assert_true(days == 7 && strstr(error.data, wrong[i]));
        strbuf_free(&error);
    }
}

static void no_directions(void **state) {
    (void)state;
    Vec3 d;
    assert_false(sun_direction((GeoPlace){91, 0, 0}, 0, &d));
    assert_false(sun_direction((GeoPlace){0, (double)NAN, 0}, 0, &d));
    assert_false(sun_direction((GeoPlace){0, 0, 0}, (double)NAN, &d));
    assert_false(sun_direction((GeoPlace){0, 0, 0}, 1e300, &d));
    assert_true(sun_direction((GeoPlace){-90, 0, 0}, days_of("0000-01-01"), &d) && vec3_is_finite(d));
    assert_true(sun_direction((GeoPlace){90, 0, 0}, days_of("9999-12-31"), &d) && vec3_is_finite(d));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_nrel), cmocka_unit_test(declinations), cmocka_unit_test(noons),         cmocka_unit_test(parallax),
        cmocka_unit_test(times),           cmocka_unit_test(no_times),     cmocka_unit_test(no_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
