/* Edges through pixels, told by the middles around and by samples along them. */
#include "base/random.h"
#include "render/contrast.h"
#include "render/draw.h"
#include "render/pixel_edge.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef struct Line {
    double x, y, distance; /* unit direction */
} Line;

static Line random_line(RandomStream *s, int n) {
    double angle = n % 4 ? 2 * VTS_PI * random_next_unit(s) : VTS_PI / 2 * (n / 4);
    return (Line){cos(angle), sin(angle), 1.4 * random_next_unit(s) - 0.7};
}

static bool is_beyond(const Line *line, double x, double y) { return line->x * x + line->y * y > line->distance; }

/* By many points of the pixel. */
static double true_share(const Line *line) {
    enum { SIDE = 200 };
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) count += is_beyond(line, (i % SIDE + 0.5) / SIDE - 0.5, (i / SIDE + 0.5) / SIDE - 0.5);
    return count / (double)(SIDE * SIDE);
}

static void add_point(EdgePoints *points, const Line *line, float x, float y) {
    const int i = points->count++;
    points->x[i] = x, points->y[i] = y;
    points->beyond[i] = is_beyond(line, (double)x, (double)y);
}

static EdgePoints middles_of(const Line *line) {
    EdgePoints points = {.count = 0};
    for (int k = 0; k < 9; k++) add_point(&points, line, (float)(k % 3 - 1), (float)(k / 3 - 1));
    return points;
}

/* What as many samples laid by lot, and the pixel's middle, say of it. */
static double counted(const Line *line, int samples, uint64_t pixel) {
    int beyond = is_beyond(line, 0, 0);
    for (int k = 0; k < samples; k++) {
        double x, y;
        draw_pair(&(Draw){pixel, (uint32_t)k}, DRAW_PIXEL, &x, &y);
        beyond += is_beyond(line, x - 0.5, y - 0.5);
    }
    return beyond / (double)(samples + 1);
}

static void test_samples_along_an_edge_tell_more_than_numbers(void **state) {
    enum { SAMPLES = 4 };
    RandomStream s = {11};
    double by_number = 0, fitted[SAMPLES + 1] = {0}, expected[SAMPLES + 1] = {0};
    int possible = 0, lost = 0;
    (void)state;
    for (int n = 0; n < 2000; n++) {
        const Line line = random_line(&s, n);
        const double truth = true_share(&line), off = counted(&line, SAMPLES, random_next(&s)) - truth;
        EdgePoints points = middles_of(&line);
        EdgeFit fit;
        if (truth == 0 || truth == 1 || !edge_fit(&points, &fit)) continue;
        possible++;
        by_number += off * off;
        for (int k = 0;; k++) {
            float x, y;
            fitted[k] += ((double)fit.beyond - truth) * ((double)fit.beyond - truth);
            expected[k] += (double)fit.variance;
            if (k == SAMPLES) break;
            edge_place(&fit, k, &x, &y);
            assert_true(fabsf(x) <= 0.5f && fabsf(y) <= 0.5f);
            add_point(&points, &line, x, y);
            if (edge_fit(&points, &fit)) continue;
            lost++;
            break;
        }
    }
    assert_in_range(lost, 0, possible / 50);
    for (int k = 0; k <= SAMPLES; k++) {
        if (k) assert_true(fitted[k] < 0.6 * fitted[k - 1]);
        assert_true(expected[k] > 0.6 * fitted[k] && expected[k] < 1.6 * fitted[k]);
    }
    assert_true(fitted[SAMPLES] < by_number / 8);
}

static void test_what_is_no_edge_is_not_fitted(void **state) {
    (void)state;
    EdgeFit fit;
    EdgePoints crossed = {.x = {-0.4f, 0.4f, -0.4f, 0.4f}, .y = {-0.4f, -0.4f, 0.4f, 0.4f}, .beyond = {true, false, false, true}, .count = 4};
    assert_false(edge_fit(&crossed, &fit));
    EdgePoints one = {.x = {-0.4f, 0.4f}, .y = {0, 0}, .beyond = {true, true}, .count = 2};
    assert_false(edge_fit(&one, &fit));
}

static void test_sides_are_alike(void **state) {
    RandomStream s = {7};
    (void)state;
    for (int n = 0; n < 200; n++) {
        const Line line = random_line(&s, n);
        EdgePoints points = middles_of(&line);
        EdgeFit fit, turned;
        bool found = edge_fit(&points, &fit);
        for (int i = 0; i < points.count; i++) points.beyond[i] = !points.beyond[i];
        assert_int_equal(edge_fit(&points, &turned), found);
        if (found) assert_true(fabs((double)(fit.beyond + turned.beyond) - 1) < 1e-4);
    }
}

/* ---- cells ---- */

enum { AT = CONTRAST_EDGE + 1 };

static void set_light(Cell *cell, float light) {
    cell->first = cell->mean = vec3f(light, light, light);
    cell->middle = (Radiance){cell->first, 1};
}

/* Dark to the left, bright from the column after the middle on. */
static void lay_edge(Cell cells[3 * CONTRAST_EDGE]) {
    for (int k = 0; k < 9; k++) set_light(&cells[k / 3 * CONTRAST_EDGE + k % 3], k % 3 == 2 ? 0.8f : 0.2f);
}

static void test_light_lies_between_both(void **state) {
    Cell cells[3 * CONTRAST_EDGE] = {{.error = 0}};
    PixelEdge edge;
    (void)state;
    lay_edge(cells);
    assert_true(pixel_edge_begin(&cells[AT], &edge));
    float at_first = pixel_edge_light(&edge).color.x, error = pixel_edge_error(&edge);
    assert_true(at_first > 0.2f && at_first < 0.5f && error > 0);
    /* The edge is at a quarter of the pixel from its right side. */
    for (int k = 0; k < 6; k++) {
        float x, y;
        edge_place(&edge.fit, k, &x, &y);
        const float light = x > 0.25f ? 0.8f : 0.2f;
        assert_true(pixel_edge_add(&edge, x, y, &(Radiance){{light, light, light}, 1}));
    }
    assert_true(fabsf(pixel_edge_light(&edge).color.x - (0.75f * 0.2f + 0.25f * 0.8f)) < 0.02f);
    assert_true(pixel_edge_error(&edge) < error / 20);
    assert_false(pixel_edge_add(&edge, 0, 0, &(Radiance){{0.5f, 0.5f, 0.5f}, 1})); /* a third light */
}

static void test_what_else_is_around_is_no_edge(void **state) {
    static const Texture texture = {.under = NULL};
    Cell cells[3 * CONTRAST_EDGE] = {{.error = 0}};
    PixelEdge edge;
    (void)state;
    for (int k = 0; k < 9; k++) set_light(&cells[k / 3 * CONTRAST_EDGE + k % 3], 0.2f);
    assert_false(pixel_edge_begin(&cells[AT], &edge));
    lay_edge(cells);
    set_light(&cells[0], 0.5f);
    assert_false(pixel_edge_begin(&cells[AT], &edge));
    lay_edge(cells);
    set_light(&cells[AT - 1], 0.8f); /* a line as wide as the pixel */
    set_light(&cells[0], 0.8f);
    set_light(&cells[2 * CONTRAST_EDGE], 0.8f);
    assert_false(pixel_edge_begin(&cells[AT], &edge));
    lay_edge(cells); /* colours of one pattern */
    for (int k = 0; k < 9; k++) {
        Cell *cell = &cells[k / 3 * CONTRAST_EDGE + k % 3];
        cell->object = 1;
        cell->tint = (SurfaceTint){.texture = &texture, .color = cell->first};
    }
    assert_false(pixel_edge_begin(&cells[AT], &edge));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_samples_along_an_edge_tell_more_than_numbers),
                                       cmocka_unit_test(test_what_is_no_edge_is_not_fitted),
                                       cmocka_unit_test(test_sides_are_alike),
                                       cmocka_unit_test(test_light_lies_between_both),
                                       cmocka_unit_test(test_what_else_is_around_is_no_edge)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
