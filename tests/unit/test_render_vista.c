/* Parts of a picture in which only one thing can be seen. */
#include "base/random.h"
#include "render/vista.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static Vec3 middle_of(const Box3 *b) { return vec3_lerp(b->min, b->max, 0.5); }

static Ray line_to(Vec3 from, Vec3 to) { return (Ray){from, vec3_normalize(vec3_sub(to, from))}; }

/* From the origin through the corners of a rectangle at z = 1. */
static void corners_at(double x0, double y0, double x1, double y1, Ray out[4]) {
    for (int k = 0; k < 4; k++) out[k] = line_to(vec3(0, 0, 0), vec3(k & 1 ? x1 : x0, k & 2 ? y1 : y0, 1));
}

static Box3 box_at(double x, double y, double z, double half) {
    return (Box3){vec3(x - half, y - half, z - half), vec3(x + half, y + half, z + half)};
}

static bool even_with(VistaPiece piece, const Ray corners[4], uint32_t object) {
    Ray wide[4];
    corners_at(-1, -1, 1, 1, wide);
    const VistaPieces pieces = {&piece, 1, false};
    Vista vista = vista_of(&pieces, wide);
    return vista_view(&vista, corners, object, (VistaWidth){0, 0}) == VISTA_EVEN;
}

static void test_what_is_beside_does_not_count(void **state) {
    (void)state;
    Ray corners[4];
    corners_at(0, 0, 0.1, 0.1, corners);
    assert_true(even_with((VistaPiece){.box = box_at(5, 0, 10, 1), .object = 0}, corners, 7));
    assert_true(even_with((VistaPiece){.box = box_at(0.5, -3, 10, 2.9), .object = 0}, corners, 0));
    assert_true(even_with((VistaPiece){.box = box_at(0, 0, -10, 1), .object = 0}, corners, 0)); /* behind the eye */
    assert_false(even_with((VistaPiece){.box = box_at(0.5, 0.5, 10, 0.01), .object = 0}, corners, 7));
    assert_false(even_with((VistaPiece){.box = box_at(1.1, 0.5, 10, 0.2), .object = 0}, corners, 7));
}

static void test_what_is_convex_hides_what_is_behind(void **state) {
    (void)state;
    Ray corners[4];
    corners_at(0, 0, 0.1, 0.1, corners);
    assert_true(even_with((VistaPiece){.box = box_at(0.5, 0.5, 10, 2), .object = 7}, corners, 7));
    assert_false(even_with((VistaPiece){.box = box_at(0.5, 0.5, 10, 2), .object = 8}, corners, 7));
    assert_false(even_with((VistaPiece){.box = box_at(0.5, 0.5, 10, 2), .object = 0}, corners, 7));
    assert_false(even_with((VistaPiece){.box = box_at(0, 0, 0, 2), .object = 7}, corners, 7)); /* seen from within */
}

static void test_few_things_are_told(void **state) {
    (void)state;
    Ray corners[4];
    VistaPiece two[] = {{.box = box_at(0.5, 0.5, 10, 2), .object = 0}, {.box = box_at(0.5, 0.5, 20, 2), .object = 8}};
    corners_at(0, 0, 0.1, 0.1, corners);
    VistaPieces pieces = {two, 1, false};
    Vista vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0, 0}), VISTA_SOME);
    pieces.count = 2;
    vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0, 0}), VISTA_SOME);
    assert_int_equal(vista_view(&vista, corners, 8, (VistaWidth){0, 0}), VISTA_SOME); /* what is before it may be seen */
    VistaPiece many[VISTA_MOST + 1];
    for (int i = 0; i <= VISTA_MOST; i++) many[i] = two[0];
    pieces = (VistaPieces){many, VISTA_MOST + 1, false};
    vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0, 0}), VISTA_OPEN);
}

/* What is wider than what is asked about cannot lie between the corners without being met by one. Of what may have holes nobody knows how wide it is. */
static void test_what_is_wide_is_no_surprise(void **state) {
    (void)state;
    Ray corners[4];
    corners_at(0, 0, 0.1, 0.1, corners); /* 0.8 wide, 8 off, where the box begins */
    VistaPiece piece = {.box = box_at(1.5, 0.5, 10, 2), .width = 4, .whole = true, .object = 8};
    const VistaPieces pieces = {&piece, 1, false};
    const Vista vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0.3, 0}), VISTA_WIDE);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0.6, 0}), VISTA_SOME);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0, 3.9}), VISTA_WIDE);
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0, 4.1}), VISTA_SOME);
    piece.whole = false;
    assert_int_equal(vista_view(&vista, corners, 7, (VistaWidth){0.3, 0}), VISTA_SOME);
}

/* Whatever a line between the corners meets must not be called nothing. */
static void test_nothing_that_can_be_met_is_left_out(void **state) {
    (void)state;
    RandomStream s = {5};
    int told = 0;
    for (int n = 0; n < 20000; n++) {
        double x = random_next_unit(&s) - 0.5, y = random_next_unit(&s) - 0.5,
               w = 0.2 * random_next_unit(&s) + 1e-3;
        bool parallel = n % 2;
        Ray corners[4];
        corners_at(x, y, x + w, y + w, corners);
        for (int k = 0; parallel && k < 4; k++)
            corners[k] = (Ray){vec3(k & 1 ? x + w : x, k & 2 ? y + w : y, 0), vec3(0, 0, 1)};
        Box3 box = box_at(2 * random_next_unit(&s) - 1, 2 * random_next_unit(&s) - 1,
                          4 * random_next_unit(&s) - 1, random_next_unit(&s));
        const VistaPiece piece = {.box = box, .object = 0};
        const VistaPieces pieces = {(VistaPiece *)&piece, 1, false};
        Vista vista = vista_of(&pieces, corners);
        bool even = vista_view(&vista, corners, 0, (VistaWidth){0, 0}) == VISTA_EVEN;
        told += even;
        for (int k = 0; even && k < 16; k++) {
            double u = x + w * (k % 4) / 3.0, v = y + w * (k / 4) / 3.0,
                   at = middle_of(&box).z + (k % 3 - 1) * 0.99 * (box.max.z - box.min.z) / 2;
            double px = parallel ? u : u * at, py = parallel ? v : v * at;
            bool within = at > 0 && px > box.min.x && px < box.max.x && py > box.min.y && py < box.max.y;
            assert_false(within);
        }
    }
    assert_in_range(told, 2000, 19000);
}

static void test_what_cannot_be_told(void **state) {
    (void)state;
    Ray corners[4];
    VistaPiece many[VISTA_MOST + 1];
    corners_at(0, 0, 0.1, 0.1, corners);
    VistaPieces pieces = {many, 0, true};
    Vista vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 0, (VistaWidth){0, 0}), VISTA_OPEN); /* something has no end */
    for (int i = 0; i <= VISTA_MOST; i++) many[i] = (VistaPiece){.box = box_at(0.5, 0.5, 10 + i, 0.1), .object = 0};
    pieces = (VistaPieces){many, VISTA_MOST + 1, false};
    vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 0, (VistaWidth){0, 0}), VISTA_OPEN);
    pieces.count = 0;
    vista = vista_of(&pieces, corners);
    assert_int_equal(vista_view(&vista, corners, 0, (VistaWidth){0, 0}), VISTA_EVEN);
    for (int k = 0; k < 4; k++) corners[k].direction = vec3(0, 0, 1); /* no width */
    assert_int_equal(vista_view(&vista, corners, 0, (VistaWidth){0, 0}), VISTA_OPEN);
    corners[1].direction = vec3((double)NAN, 0, 1);
    assert_int_equal(vista_view(&vista, corners, 0, (VistaWidth){0, 0}), VISTA_OPEN);
}

static void test_thin_things_are_told(void **state) {
    (void)state;
    Ray corners[4];
    corners_at(0, 0, 1, 1, corners);
    const double spread = 0.01;
    VistaPiece piece = {.box = box_at(1, 1, 10, 2), .width = 0.05};
    VistaPieces pieces = {&piece, 1, false};
    assert_true(vista_has_thin(&pieces, corners, (VistaWidth){spread, 0})); /* 8 off, where a pixel is 0.08 wide */
    piece.width = 0.2;
    assert_false(vista_has_thin(&pieces, corners, (VistaWidth){spread, 0}));
    assert_true(vista_has_thin(&pieces, corners, (VistaWidth){spread, 0.2}));
    piece = (VistaPiece){.box = box_at(-20, 1, 10, 2), .width = 0.05};
    assert_false(vista_has_thin(&pieces, corners, (VistaWidth){spread, 0}));
}

/* A floor of 20 × 20, `below` the eye, that begins 10 away. */
static bool floor_is_thin(double below, double thickness, double width, double spread, double pixel) {
    Ray corners[4];
    corners_at(-1, -1, 1, 1, corners);
    VistaPiece piece = {.box = {vec3(-10, -below - thickness, 10), vec3(10, -below, 30)}, .width = width};
    VistaPieces pieces = {&piece, 1, false};
    return vista_has_thin(&pieces, corners, (VistaWidth){spread, pixel});
}

static void test_floors_are_as_wide_as_they_look(void **state) {
    (void)state;
    /* From 2 above it fills an angle of at least 2·20/(10.2·31.7) = 0.124. */
    assert_false(floor_is_thin(2, 0, 0, 0.01, 0));
    assert_true(floor_is_thin(2, 0, 0, 0.13, 0));
    assert_true(floor_is_thin(0.1, 0, 0, 0.01, 0)); /* nearly edge-on */
    assert_true(floor_is_thin(-0.1, 0.2, 0.2, 0.05, 0)); /* seen from its own height */
    assert_true(floor_is_thin(2, 0.1, 0.05, 0.01, 0)); /* holds what is thinner than its box */
    assert_true(floor_is_thin(2, 0, 0, 0, 0.1)); /* parallel lines: who knows how they lie */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_what_is_beside_does_not_count),
                                       cmocka_unit_test(test_what_is_convex_hides_what_is_behind),
                                       cmocka_unit_test(test_nothing_that_can_be_met_is_left_out),
                                       cmocka_unit_test(test_what_cannot_be_told), cmocka_unit_test(test_few_things_are_told),
                                       cmocka_unit_test(test_what_is_wide_is_no_surprise),
                                       cmocka_unit_test(test_thin_things_are_told),
                                       cmocka_unit_test(test_floors_are_as_wide_as_they_look)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
