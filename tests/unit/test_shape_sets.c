/* Sets as triangles: volumes and areas in closed form, closed surfaces, distances from the exact surfaces, random trees against
 * their inside, and what is degenerate. */
#include "object_parts.h"
#include "base/random.h"
#include "shape/tessellate.h"
#include "shape/trace.h"
#include "shape/weld.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#include <string.h>

static Arena arena;

static int set_up(void **state) {
    (void)state;
    arena_init(&arena, NULL, 0);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    arena_destroy(&arena);
    return 0;
}

/* ---- measures ---- */

static Vec3 corner(const TriangleSoup *soup, size_t t, int i) {
    return soup->vertices.items[soup->triangles.items[t].vertex[i]].position;
}

static Vec3 twice_area(const TriangleSoup *soup, size_t t) {
    Vec3 a = corner(soup, t, 0);
    return vec3_cross(vec3_sub(corner(soup, t, 1), a), vec3_sub(corner(soup, t, 2), a));
}

static double soup_area(const TriangleSoup *soup) {
    double sum = 0;
    for (size_t t = 0; t < soup->triangles.count; t++) sum += vec3_length(twice_area(soup, t)) / 2;
    return sum;
}

static double soup_volume(const TriangleSoup *soup) {
    double sum = 0;
    for (size_t t = 0; t < soup->triangles.count; t++) sum += vec3_dot(corner(soup, t, 0), twice_area(soup, t)) / 6;
    return sum;
}

/* Edges, found by exact place, that run more often one way than the other. */
static size_t open_edges(const TriangleSoup *soup) {
    size_t count = soup->vertices.count, edge_count = 0, open = 0;
    Vec3 *points = arena_new_array(&arena, Vec3, count);
    uint32_t *place = arena_new_array(&arena, uint32_t, count);
    WeldEdge *edges = arena_new_array(&arena, WeldEdge, 3 * soup->triangles.count);
    for (size_t i = 0; i < count; i++) points[i] = soup->vertices.items[i].position;
    uint32_t places = weld_points(points, count, 0, &arena, place);
    for (uint32_t t = 0; t < soup->triangles.count; t++) {
        const uint32_t *v = soup->triangles.items[t].vertex;
        for (uint8_t e = 0; e < 3; e++) {
            uint32_t a = place[v[e]], b = place[v[(e + 1) % 3]];
            if (a != b) edges[edge_count++] = (WeldEdge){a < b ? a : b, a < b ? b : a, t, e, a < b};
        }
    }
    weld_sort_edges(edges, edge_count, places, &arena);
    for (size_t i = 0, end; i < edge_count; i = end) {
        int balance = 0;
        for (end = i; end < edge_count && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi; end++)
            balance += edges[end].forward ? 1 : -1;
        open += balance != 0;
    }
    return open;
}

static void assert_closed(const TriangleSoup *soup) {
    size_t open = open_edges(soup);
    if (open) print_error("%zu open edges of %zu triangles\n", open, soup->triangles.count);
    assert_int_equal(open, 0);
    for (size_t t = 0; t < soup->triangles.count; t++) assert_true(soup->triangles.items[t].solid);
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance)) print_error("%.9g, expected %.9g ± %g\n", value, expected, tolerance);
    assert_true(fabs(value - expected) <= tolerance);
}

/* ---- objects ---- */

static const Object *kept(Object object, const Transform *transform) {
    Object *copy = arena_new(&arena, Object);
    *copy = object;
    if (transform) copy->place = arena_copy(&arena, PLACE(*transform), sizeof(Affine));
    return copy;
}

static const Object *sphere(Vec3 center, double radius) {
    Object object = {.kind = OBJECT_SPHERE};
    object.as.sphere.center = center;
    object.as.sphere.radius = radius;
    return kept(object, NULL);
}

static const Object *box(Vec3 a, Vec3 b) {
    Object object = {.kind = OBJECT_BOX};
    object.as.box.corner1 = a;
    object.as.box.corner2 = b;
    return kept(object, NULL);
}

static const Object *cylinder(Vec3 base, Vec3 cap, double radius) {
    Object object = {.kind = OBJECT_CYLINDER};
    object.as.cone.base = base;
    object.as.cone.cap = cap;
    object.as.cone.base_radius = object.as.cone.cap_radius = radius;
    return kept(object, NULL);
}

static const Object *plane(Vec3 normal, double distance) {
    Object object = {.kind = OBJECT_PLANE};
    object.as.plane.normal = vec3_normalize(normal);
    object.as.plane.distance = distance;
    return kept(object, NULL);
}




static const Object *group(ObjectKind kind, size_t count, const Object *const *items) {
    Object object = {.kind = (uint8_t)kind};
    const Object **list = arena_copy(&arena, items, count * sizeof *items);
    object.as.group = arena_copy(&arena, GROUP(list, count), sizeof(ObjectGroup));
    return kept(object, NULL);
}

#define SET(kind, ...) group(kind, sizeof((const Object *[]){__VA_ARGS__}) / sizeof(const Object *), (const Object *[]){__VA_ARGS__})


static const double TOLERANCE = 0.01;

static bool mesh(const Object *object, double tolerance, TriangleSoup *soup, ShapeRefusal *refusal) {
    const TessellateOptions options = {.tolerance = tolerance};
    *soup = (TriangleSoup){0};
    return tessellate(object, NULL, &options, &arena, soup, refusal);
}

static TriangleSoup soup_of(const Object *object) {
    TriangleSoup soup;
    ShapeRefusal refusal;
    assert_true(mesh(object, TOLERANCE, &soup, &refusal));
    return soup;
}

/* ---- distances: random points of the triangles from the exact surface, by rays both ways along the normal ---- */

static double worst_distance(const Object *object, const TriangleSoup *soup, size_t samples) {
    ShapeTracer *tracer = shape_tracer_create(&arena);
    RandomStream random = {7};
    double worst = 0;
    for (size_t i = 0; i < samples; i++) {
        size_t t = (size_t)(random_next_unit(&random) * (double)soup->triangles.count);
        double u = random_next_unit(&random), v = random_next_unit(&random), best = VTS_INFINITY;
        if (u + v > 1) u = 1 - u, v = 1 - v;
        Vec3 n = vec3_normalize(twice_area(soup, t)), a = corner(soup, t, 0);
        Vec3 p = vec3_madd(vec3_madd(a, vec3_sub(corner(soup, t, 1), a), u), vec3_sub(corner(soup, t, 2), a), v);
        if (vec3_length_squared(n) == 0) continue;
        for (int k = 0; k < 14; k++) { /* the axes, the normal, diagonals: the surface lies across one of them */
            Vec3 d = k < 2 ? n : k < 8 ? vec3(k / 2 == 1, k / 2 == 2, k / 2 == 3) : vec3(1, k / 2 & 1 ? 1 : -1, k / 2 & 2 ? 1 : -1);
            d = vec3_normalize(k & 1 ? vec3_negate(d) : d);
            Ray ray = {vec3_madd(p, d, -0.05), d};
            TraceHit hit;
            for (double from = 0; shape_trace(tracer, object, &ray, from, &hit) && hit.t < 0.1; from = hit.t + 1e-9)
                best = double_min(best, fabs(hit.t - 0.05));
        }
        worst = double_max(worst, best);
    }
    return worst;
}

static void assert_on_surface(const Object *object, const TriangleSoup *soup) {
    double worst = worst_distance(object, soup, 2000);
    if (worst > TOLERANCE) print_error("%g off the surface\n", worst);
    assert_true(worst <= TOLERANCE);
}

/* ---- closed forms ---- */

static void check_measures(const Object *object, double volume, double area) {
    TriangleSoup soup = soup_of(object);
    assert_closed(&soup);
    assert_near(soup_volume(&soup), volume, TOLERANCE * area);
    assert_near(soup_area(&soup), area, 0.01 * area);
}

static void check_body(const Object *object, double volume, double area) {
    check_measures(object, volume, area);
    TriangleSoup soup = soup_of(object);
    assert_on_surface(object, &soup);
}

static void an_eighth_of_a_ball(void **state) {
    (void)state;
    const Object *object = SET(OBJECT_INTERSECTION, sphere(vec3(0, 0, 0), 1), box(vec3(0, 0, 0), vec3(2, 2, 2)));
    check_body(object, VTS_PI / 6, 5 * VTS_PI / 4);
}

static void a_ball_with_a_hole(void **state) {
    (void)state;
    const Object *object = SET(OBJECT_DIFFERENCE, sphere(vec3(0, 0, 0), 1), cylinder(vec3(0, -2, 0), vec3(0, 2, 0), 0.5));
    double h = sqrt(3.0);
    check_body(object, VTS_PI * h * h * h / 6, 2 * VTS_PI * h + VTS_PI * h);
}

static void two_cylinders_that_cross(void **state) {
    (void)state;
    const Object *a = cylinder(vec3(-2, 0, 0), vec3(2, 0, 0), 1), *b = cylinder(vec3(0, -2, 0), vec3(0, 2, 0), 1);
    check_body(SET(OBJECT_INTERSECTION, a, b), 16.0 / 3, 16);
}

static void a_merge_has_no_walls_inside(void **state) {
    (void)state;
    const Object *a = sphere(vec3(-0.5, 0, 0), 1), *b = sphere(vec3(0.5, 0, 0), 1);
    check_body(SET(OBJECT_MERGE, a, b), 2 * (4 * VTS_PI / 3) - 5 * VTS_PI / 12, 2 * 4 * VTS_PI - 2 * 2 * VTS_PI * 0.5);
}

static void planes_bound_a_body_together(void **state) {
    (void)state;
    const Object *sides[8];
    for (int i = 0; i < 8; i++) sides[i] = plane(vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1), 1 / sqrt(3));
    check_body(group(OBJECT_INTERSECTION, 8, sides), 4.0 / 3, 4 * sqrt(3.0));
}

static void faces_that_coincide(void **state) {
    (void)state;
    const Object *a = box(vec3(0, 0, 0), vec3(1, 1, 1)), *b = box(vec3(0, 0, 0), vec3(0.5, 1, 1)), *c = box(vec3(1, 0, 0), vec3(2, 1, 1));
    check_measures(SET(OBJECT_DIFFERENCE, a, b), 0.5, 4);
    check_measures(SET(OBJECT_INTERSECTION, a, b), 0.5, 4);
    check_measures(SET(OBJECT_MERGE, a, b), 1, 6);
    check_measures(SET(OBJECT_MERGE, a, c), 2, 10);
    check_measures(SET(OBJECT_DIFFERENCE, a, c), 1, 6);
    TriangleSoup soup = soup_of(SET(OBJECT_DIFFERENCE, a, a));
    assert_int_equal(soup.triangles.count, 0);
    soup = soup_of(SET(OBJECT_INTERSECTION, a, c));
    assert_int_equal(soup.triangles.count, 0);
    const Object *ball = sphere(vec3(0.1, 0.2, 0.3), 0.7);
    soup = soup_of(SET(OBJECT_DIFFERENCE, ball, ball));
    assert_int_equal(soup.triangles.count, 0);
    check_measures(SET(OBJECT_MERGE, ball, ball, ball), 4 * VTS_PI / 3 * 0.343, 4 * VTS_PI * 0.49);
}

/* ---- the rarer solids, of bodies with closed forms ---- */

static const Object *rare(Solid solid) {
    Solid *own = arena_copy(&arena, &solid, sizeof solid);
    solid_rehash(own);
    Object object = {.kind = OBJECT_SOLID, .as.solid = own};
    return kept(object, NULL);
}

static void rare_solids_have_their_volume(void **state) {
    (void)state;
    static const SweepSphere capsule[] = {{{0, 0, 0}, 0.4}, {{0, 1, 0}, 0.4}};
    static const Point2 square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}, {0.25, 0.25}};
    static const Point2 cone[] = {{0, 0}, {1, 0}, {0, 1}};
    static const double ball[] = {1, 0, 0, 0, 1, 0, 0, 1, 0, -1};
    const BlobPart part = {{0, 0, 0}, {0, 0, 0}, 1, 1, transform_identity(), NULL};
    double r = sqrt(1 - sqrt(0.25)); /* where (1 - r²)² is the threshold */
    check_body(rare((Solid){.kind = SOLID_SUPERELLIPSOID, .as.superellipsoid = {1, 1}}), 4 * VTS_PI / 3, 4 * VTS_PI);
    check_body(rare((Solid){.kind = SOLID_SWEEP, .as.sweep = {CURVE_LINEAR, capsule, 2}}), VTS_PI * 0.16 * (1 + 1.6 / 3),
               2 * VTS_PI * 0.4 * 1.8);
    check_body(rare((Solid){.kind = SOLID_PRISM, .as.prism = {CURVE_LINEAR, false, false, 0, 2, square, 10}}), 1.5, 2 * 0.75 + 2 * 6);
    check_body(rare((Solid){.kind = SOLID_LATHE, .as.turned = {CURVE_LINEAR, cone, 3, false}}), VTS_PI / 3, VTS_PI * (1 + sqrt(2)));
    check_body(rare((Solid){.kind = SOLID_BLOB, .as.blob = {.threshold = 0.25, .parts = arena_copy(&arena, &part, sizeof part), .count = 1}}),
               4 * VTS_PI / 3 * r * r * r, 4 * VTS_PI * r * r);
    const Object *poly = rare((Solid){.kind = SOLID_POLYNOMIAL, .as.polynomial = {2, ball, 10}});
    check_body(SET(OBJECT_INTERSECTION, poly, plane(vec3(0, 1, 0), 0), box(vec3(-2, -2, -2), vec3(2, 2, 2))), 2 * VTS_PI / 3, 3 * VTS_PI);
}

static void what_is_degenerate_gives_nothing(void **state) {
    (void)state;
    TriangleSoup soup;
    ShapeRefusal refusal;
    const double nan = (double)NAN;
    const Object *ball = sphere(vec3(0, 0, 0), 1), *bad[] = {
        SET(OBJECT_INTERSECTION, ball, sphere(vec3(5, 0, 0), 1)), SET(OBJECT_INTERSECTION, ball, sphere(vec3(2, 0, 0), 1)),
        SET(OBJECT_DIFFERENCE, ball, sphere(vec3(0, 0, 0), nan)), SET(OBJECT_INTERSECTION, ball, sphere(vec3(nan, 0, 0), 1)),
        group(OBJECT_INTERSECTION, 0, NULL), SET(OBJECT_DIFFERENCE, sphere(vec3(0, 0, 0), 0), ball)};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(bad); i++) mesh(bad[i], TOLERANCE, &soup, &refusal);
    const Object *deep = ball;
    for (int i = 0; i < 300; i++) deep = SET(OBJECT_DIFFERENCE, deep, sphere(vec3(1, 0.001 * i, 0), 0.3));
    mesh(deep, 0.05, &soup, &refusal);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_eighth_of_a_ball, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_ball_with_a_hole, set_up, tear_down),
        cmocka_unit_test_setup_teardown(two_cylinders_that_cross, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_merge_has_no_walls_inside, set_up, tear_down),
        cmocka_unit_test_setup_teardown(planes_bound_a_body_together, set_up, tear_down),
        cmocka_unit_test_setup_teardown(faces_that_coincide, set_up, tear_down),
        cmocka_unit_test_setup_teardown(rare_solids_have_their_volume, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_degenerate_gives_nothing, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
