/* Ground behind nearer ground, against rays that meet the ground between all posts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "map_files.h"
#include "terrain/ground_horizon.h"

enum { SIDE = 401, SPOTS = 700 };

static double hills(int column, int row) { return 900 + 500 * sin(column / 9.0) * cos(row / 13.0) + 90 * sin(column / 2.1 + row / 3.3) + (column * 7919 + row * 104729) % 41; }
static double hills_and_a_hole(int column, int row) { return column > 196 && column < 206 && row > 170 && row < 198 ? -32768 : hills(column, row); }

typedef struct Land {
    Made files;
    const Ground *ground;
} Land;

static void open_land(Land *land, MadeHeight *height, HeightmapVoids voids, double exaggeration, bool flat) {
    GeoFrame frame;
    const HeightmapOptions options = {.voids = voids};
    made_begin(&land->files);
    const char *path = made_hgt(&land->files, "N46E008.hgt", SIDE, SIDE, height);
    const Heightmap *map = heightmap_open(&path, 1, &options, &land->files.arena, &land->files.diags, (Span){0});
    assert_non_null(map);
    assert_true(geo_frame_init(&frame, (GeoPlace){46.5, 8.5, 0}, flat));
    land->ground = ground_create(map, &frame, exaggeration, &land->files.arena);
    assert_non_null(land->ground);
}

static Vec3 over_ground(const Ground *g, double x, double z, double above) {
    double y;
    assert_true(ground_ops.height(g, vec3(x, 0, z), &y));
    return vec3(x, y + above, z);
}

/* The eye sees the point: nothing of the ground is before it. */
static bool sees(const Ground *g, Vec3 eye, Vec3 point) {
    const Ray ray = {eye, vec3_sub(point, eye)};
    double t;
    return !ground_ops.meet(g, &ray, 0, 1 - 1e-9, &t);
}

typedef struct Tally {
    int hidden, wrong, deep, missed;
} Tally;

/* Upright cylinders on the ground, 120 m wide and 40 m high; deep ones are those that stay unseen if they are 250 m higher and as much wider. */
static Tally look(const Ground *g, Vec3 eye, Arena *arena) {
    const double reach = 60, rise = 40, deeper = 250;
    GroundHorizon *horizon = ground_horizon_create(g, eye, arena);
    RandomStream random = {11};
    Tally tally = {0};
    assert_non_null(horizon);
    for (int i = 0; i < SPOTS; i++) {
        const Vec3 p = over_ground(g, (random_next_unit(&random) - 0.5) * 60000, (random_next_unit(&random) - 0.5) * 90000, 0);
        const bool hidden = ground_horizon_hides(horizon, p, reach, p.y + rise, 0);
        bool deep = true;
        for (int k = 0; k < 12; k++) {
            const double angle = k * VTS_PI / 6;
            const Vec3 out = vec3(sin(angle), 0, cos(angle)), edge = vec3_madd(p, out, reach * random_next_unit(&random));
            const Vec3 high = vec3(edge.x, p.y + rise * random_next_unit(&random), edge.z), far = vec3_madd(p, out, deeper);
            if (hidden && sees(g, eye, high)) tally.wrong++;
            deep &= !sees(g, eye, vec3(far.x, fmax(p.y, far.y) + deeper, far.z));
        }
        tally.hidden += hidden, tally.deep += deep, tally.missed += deep && !hidden;
    }
    return tally;
}

static void check(double exaggeration, bool flat, double above) {
    Land land;
    open_land(&land, hills, HEIGHTMAP_FILL, exaggeration, flat);
    Tally tally = look(land.ground, over_ground(land.ground, 1300, -2100, above), &land.files.arena);
    assert_int_equal(tally.wrong, 0);
    assert_true(tally.hidden > SPOTS / 10 && tally.deep > SPOTS / 20);
    assert_true(tally.missed < tally.deep / 20);
    made_end(&land.files);
}

static void what_is_hidden_is_not_seen_and_most_is_found(void **state) {
    (void)state;
    check(1, false, 2);
    check(1, true, 300);
    check(-1.5, false, 40);
}

static void behind_a_hole_anything_may_be_seen(void **state) {
    (void)state;
    Land whole, holed;
    open_land(&whole, hills, HEIGHTMAP_FILL, 1, false);
    open_land(&holed, hills_and_a_hole, HEIGHTMAP_HOLES, 1, false);
    const Vec3 eye = over_ground(whole.ground, 0, 0, 300), north = over_ground(whole.ground, 0, 40000, 0), south = over_ground(whole.ground, 0, -40000, 0);
    GroundHorizon *over_all = ground_horizon_create(whole.ground, eye, &whole.files.arena), *over_hole = ground_horizon_create(holed.ground, eye, &holed.files.arena);
    assert_true(ground_horizon_hides(over_all, north, 100, north.y - 600, 0) && ground_horizon_hides(over_all, south, 100, south.y - 600, 0));
    assert_false(ground_horizon_hides(over_hole, north, 100, north.y - 600, 0));
    assert_true(ground_horizon_hides(over_hole, south, 100, south.y - 600, 0));
    made_end(&whole.files);
    made_end(&holed.files);
}

static void eyes_under_the_ground_or_beside_it_have_no_horizon(void **state) {
    (void)state;
    Land land;
    open_land(&land, hills, HEIGHTMAP_FILL, 1, false);
    assert_null(ground_horizon_create(land.ground, over_ground(land.ground, 0, 0, -1), &land.files.arena));
    assert_null(ground_horizon_create(land.ground, vec3(80000, 3000, 0), &land.files.arena));
    assert_null(ground_horizon_create(land.ground, vec3((double)NAN, 3000, 0), &land.files.arena));
    const Vec3 eye = over_ground(land.ground, 0, 0, 2);
    GroundHorizon *horizon = ground_horizon_create(land.ground, eye, &land.files.arena);
    assert_false(ground_horizon_hides(horizon, eye, 1, -1000, 0));                       /* about the eye */
    assert_false(ground_horizon_hides(horizon, vec3(1000, -9e9, 0), 1e300, -9e9, 0));    /* everywhere */
    assert_false(ground_horizon_hides(horizon, vec3(9000, 0, 0), 10, (double)NAN, 0));
    assert_false(ground_horizon_hides(horizon, vec3(9000, 0, 0), 10, HUGE_VAL, 0));
    made_end(&land.files);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_hidden_is_not_seen_and_most_is_found),
        cmocka_unit_test(behind_a_hole_anything_may_be_seen),
        cmocka_unit_test(eyes_under_the_ground_or_beside_it_have_no_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
