/* Pictures of the ground: which of their points a point of the scene has, against GeographicLib's own easting and northing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "map_files.h"
#include "terrain/drape.h"

#define WITHIN(a, b, error) assert_true(fabs((a) - (b)) <= (error))

static const char UTM_32[] =
    "PROJCS[\"WGS_1984_UTM_Zone_32N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],"
    "PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",9.0],PARAMETER[\"Scale_Factor\",0.9996],"
    "PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";

enum { COLUMNS = 10000, ROWS = 8000 };
/* Pixels of 5 m; the middle of the first. */
static const double PIXEL = 5, WEST = 412340, NORTH = 5180020;

static const PicturePlace *utm_picture(Made *m, const GeoFrame *frame) {
    StrBuf text = {0}, error = {0};
    strbuf_addf(&text, "%g\n0\n0\n%g\n%.3f\n%.3f\n", PIXEL, -PIXEL, WEST, NORTH);
    made_text(m, "ortho.tfw", text.data);
    made_text(m, "ortho.prj", UTM_32);
    const char *path = made_text(m, "ortho.tif", "only its name counts here");
    const PicturePlace *place = drape_open(path, COLUMNS, ROWS, frame, &m->arena, &error);
    assert_non_null(place);
    strbuf_free(&text);
    strbuf_free(&error);
    return place;
}

static void check_utm(bool flat) {
    Made m;
    GeoFrame frame;
    RandomStream random = {7};
    made_begin(&m);
    assert_true(geo_frame_init(&frame, (GeoPlace){46.3, 8.2, 600}, flat));
    const PicturePlace *place = utm_picture(&m, &frame);
    for (int i = 0; i < 2000; i++) {
        /* Over it, and far beyond its rim. */
        const Vec3 p = vec3((random_next_unit(&random) - 0.5) * 90000, random_next_unit(&random) * 8000 - 500, (random_next_unit(&random) - 0.5) * 90000);
        GeoPlace geo;
        UtmPlace utm;
        double u, v;
        assert_true(scene_to_geo(&frame, p, &geo) && utm_from_geo(geo, &utm));
        if (utm.zone != 32) continue;
        assert_true(place->find(place, p, &u, &v));
        WITHIN(u * COLUMNS, (utm.easting - WEST) / PIXEL + 0.5, 0.2);
        WITHIN((1 - v) * ROWS, (NORTH - utm.northing) / PIXEL + 0.5, 0.2);
    }
    made_end(&m);
}

static void points_have_the_pixels_of_their_places(void **state) {
    (void)state;
    check_utm(false);
}

static void flat_scenes_too(void **state) {
    (void)state;
    check_utm(true);
}

/* The whole earth from a scene on it: no lattice helps, and half of it is on the other side. */
static void the_whole_earth_is_calculated(void **state) {
    (void)state;
    Made m;
    GeoFrame frame;
    StrBuf error = {0};
    made_begin(&m);
    assert_true(geo_frame_init(&frame, (GeoPlace){-20, 179.9, 0}, false));
    made_text(&m, "earth.pgw", "0.1\n0\n0\n-0.1\n-179.95\n89.95\n");
    const PicturePlace *place = drape_open(made_text(&m, "earth.png", ""), 3600, 1800, &frame, &m.arena, &error);
    assert_non_null(place);
    for (int i = 0; i < 200; i++) {
        const GeoPlace geo = {-89 + 0.89 * i, -180 + fmod(77.7 * i + 1, 360), 10.0 * i};
        Vec3 p;
        double u, v;
        assert_true(geo_to_scene(&frame, geo, &p));
        assert_true(place->find(place, p, &u, &v));
        WITHIN(u, (geo.longitude + 180) / 360, 1e-4);
        WITHIN(v, (geo.latitude + 90) / 180, 1e-4);
    }
    strbuf_free(&error);
    made_end(&m);
}

static void pictures_without_a_place_are_refused(void **state) {
    (void)state;
    Made m;
    GeoFrame frame;
    StrBuf error = {0};
    made_begin(&m);
    assert_true(geo_frame_init(&frame, (GeoPlace){46, 8, 0}, false));
    assert_null(drape_open(made_text(&m, "a.png", ""), 10, 10, &frame, &m.arena, &error));
    assert_true(error.size > 0);
    strbuf_free(&error);
    made_text(&m, "b.pgw", "0\n0\n0\n0\n7\n46\n"); /* pixels of no size */
    assert_null(drape_open(made_text(&m, "b.png", ""), 10, 10, &frame, &m.arena, &error));
    strbuf_free(&error);
    made_end(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_the_pixels_of_their_places),
        cmocka_unit_test(flat_scenes_too),
        cmocka_unit_test(the_whole_earth_is_calculated),
        cmocka_unit_test(pictures_without_a_place_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
