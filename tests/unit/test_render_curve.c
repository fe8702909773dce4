/* Curves through texel space against themselves sampled densely, and the tree over boxes against asking all of them. */
#include "render/curve_tree.h"

#include "base/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static double between(RandomStream *r, double lo, double hi) { return lo + (hi - lo) * random_next_unit(r); }
static Vec3 any_vec(RandomStream *r, double size) { return vec3(between(r, -size, size), between(r, -size, size), between(r, -size, size)); }

static Curve any_curve(RandomStream *r, double bow) {
    return (Curve){any_vec(r, 1), any_vec(r, 1.5), any_vec(r, bow), any_vec(r, bow), 0, 1};
}

static double apart(Vec3 a, Vec3 b) { return vec3_length(vec3_sub(a, b)); }

static void curves_have_their_rates_and_bounds(void **state) {
    (void)state;
    RandomStream r = {1};
    for (int i = 0; i < 2000; i++) {
        Curve c = any_curve(&r, 0.8);
        Box3 hull = curve_hull(&c);
        Vec3 spread = curve_spread(&c);
        assert_true(apart(curve_rate(&c, 0), vec3_add(c.chord, c.bow_from)) < 1e-12);
        assert_true(apart(curve_rate(&c, 1), vec3_add(c.chord, c.bow_to)) < 1e-12);
        for (int k = 0; k <= 16; k++) {
            double s = k / 16.0, h = 1e-5;
            Vec3 x = curve_point(&c, s), rate = vec3_scale(vec3_sub(curve_point(&c, s + h), curve_point(&c, s - h)), 0.5 / h);
            Vec3 off = vec3_sub(x, vec3_madd(c.from, c.chord, s));
            assert_true(apart(rate, curve_rate(&c, s)) < 1e-8);
            for (int axis = 0; axis < 3; axis++) {
                assert_true(fabs(vec3_get(off, axis)) <= vec3_get(spread, axis) + 1e-12);
                assert_true(vec3_get(x, axis) >= vec3_get(hull.min, axis) - 1e-12 && vec3_get(x, axis) <= vec3_get(hull.max, axis) + 1e-12);
            }
        }
    }
}

static void parts_are_the_curve(void **state) {
    (void)state;
    RandomStream r = {2};
    for (int i = 0; i < 2000; i++) {
        Curve c = any_curve(&r, 0.8);
        double a = between(&r, 0, 1), b = between(&r, 0, 1), s = between(&r, 0, 1);
        Curve part = curve_part(&c, a, b), deeper = curve_part(&part, 0.25, 0.5);
        assert_true(apart(curve_point(&part, s), curve_point(&c, a + s * (b - a))) < 1e-12);
        assert_true(apart(curve_point(&deeper, s), curve_point(&c, deeper.start + s * deeper.length)) < 1e-12);
    }
}

/* Changes of sign among many values find each root that is not a pair closer than a step. */
static void roots_are_where_the_sign_changes(void **state) {
    (void)state;
    enum { STEPS = 4000 };
    RandomStream r = {3};
    int by_count[4] = {0};
    for (int i = 0; i < 3000; i++) {
        Curve c = any_curve(&r, i & 1 ? 4 : 0.3);
        Vec3 n = any_vec(&r, 1), corner = vec3_madd(curve_point(&c, between(&r, 0, 1)), any_vec(&r, 1), i % 3 ? 0.2 : 0);
        CurvePlane plane = curve_over_plane(&c, corner, n);
        double s[3], found[3];
        int count = curve_plane_roots(&plane, s), expected = 0;
        double before = vec3_dot(n, vec3_sub(curve_point(&c, 0), corner));
        for (int k = 1; k <= STEPS; k++) {
            double at = (double)k / STEPS, value = vec3_dot(n, vec3_sub(curve_point(&c, at), corner));
            if ((before > 0) != (value > 0) && expected < 3) found[expected++] = at;
            before = value;
        }
        assert_true(count >= expected);
        for (int k = 0; k < count; k++) {
            assert_true(fabs(vec3_dot(n, vec3_sub(curve_point(&c, s[k]), corner))) < 1e-12 * (1 + vec3_length(n)));
            assert_true(k == 0 || s[k] >= s[k - 1]);
        }
        if (count == expected)
            for (int k = 0; k < count; k++) assert_true(s[k] <= found[k] + 1e-9 && s[k] >= found[k] - 1.0 / STEPS - 1e-9);
        if (curve_misses_plane(&plane)) assert_int_equal(count, 0);
        by_count[count]++;
    }
    printf("%d, %d, %d and %d planes met 0, 1, 2 and 3 times\n", by_count[0], by_count[1], by_count[2], by_count[3]);
    for (int k = 0; k < 4; k++) assert_true(by_count[k] > 10);
}

/* What lies in a plane with the curve, touches it or is no number must end. */
static void odd_planes_end(void **state) {
    (void)state;
    const Curve flat = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}, 0, 1}, touching = {{-1, 1, 0}, {2, 0, 0}, {0, -4, 0}, {0, 4, 0}, 0, 1};
    const Vec3 up = {0, 1, 0}, origin = {0, 0, 0};
    double s[3];
    CurvePlane plane = curve_over_plane(&flat, origin, up);
    assert_true(curve_plane_roots(&plane, s) <= 3);
    plane = curve_over_plane(&touching, origin, up);
    assert_true(curve_plane_roots(&plane, s) <= 2);
    plane = (CurvePlane){{(double)NAN, 1, -1, 1}};
    assert_true(curve_plane_roots(&plane, s) <= 3);
    plane = (CurvePlane){{VTS_INFINITY, -VTS_INFINITY, 1e300, -1e300}};
    assert_true(curve_plane_roots(&plane, s) <= 3);
}

enum { MOST_BOXES = 3000 };
typedef struct Seen {
    const uint32_t *order;
    bool item[MOST_BOXES];
    int visits, stop_after;
} Seen;

static bool see(void *context, uint32_t first, uint32_t count) {
    Seen *seen = context;
    for (uint32_t i = 0; i < count; i++) seen->item[seen->order[first + i]] = true;
    return ++seen->visits == seen->stop_after;
}

static void the_tree_leaves_out_nothing(void **state) {
    (void)state;
    static const size_t counts[] = {0, 1, 2, 3, 5, 17, 400, MOST_BOXES};
    static Box3 boxes[MOST_BOXES];
    static uint32_t order[MOST_BOXES];
    RandomStream r = {4};
    long met = 0, visited = 0;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(counts); k++) {
        Arena arena;
        arena_init(&arena, NULL, 0);
        for (size_t i = 0; i < counts[k]; i++) {
            Vec3 at = any_vec(&r, 1), size = i % 7 ? vec3_scale(vec3_add(any_vec(&r, 1), vec3_splat(1)), 0.06) : vec3(0, 0, 0);
            if (i % 5 == 0 && i) at = boxes[i - 1].min; /* some in one place */
            boxes[i] = (Box3){at, vec3_add(at, size)};
        }
        const CurveTree *tree = curve_tree_build(boxes, counts[k], order, &arena, &arena);
        for (int i = 0; i < 200; i++) {
            Curve c = any_curve(&r, i % 3 ? 0.2 : 0);
            if (i % 4 == 0) c.chord.y = c.bow_from.y = c.bow_to.y = 0;
            double s0 = i & 1 ? 0 : 0.3, s1 = i & 2 ? 1 : 0.8, margin = i % 5 ? 0 : 0.01;
            Seen seen = {.order = order};
            curve_tree_walk(tree, &c, margin, s0, &s1, see, &seen);
            visited += seen.visits;
            for (int step = 0; step <= 300; step++) {
                Vec3 x = curve_point(&c, s0 + (s1 - s0) * step / 300);
                for (size_t n = 0; n < counts[k]; n++) {
                    Box3 b = boxes[n];
                    if (x.x < b.min.x - margin || x.y < b.min.y - margin || x.z < b.min.z - margin || x.x > b.max.x + margin ||
                        x.y > b.max.y + margin || x.z > b.max.z + margin)
                        continue;
                    assert_true(seen.item[n]);
                    met++;
                }
            }
            Seen first = {.order = order, .stop_after = 1};
            curve_tree_walk(tree, &c, margin, s0, &s1, see, &first);
            assert_true(first.visits <= 1 && (first.visits == 1) == (seen.visits > 0));
        }
        arena_destroy(&arena);
    }
    printf("%ld points of curves in boxes, %ld visits\n", met, visited);
    assert_true(met > 1000);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(curves_have_their_rates_and_bounds), cmocka_unit_test(parts_are_the_curve),
                                       cmocka_unit_test(roots_are_where_the_sign_changes), cmocka_unit_test(odd_planes_end),
                                       cmocka_unit_test(the_tree_leaves_out_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
