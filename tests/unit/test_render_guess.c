/* Middles of a tile that are guessed between others. */
#include "render/guess.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

typedef Middle World(int x, int y); /* what is to be seen there */

typedef struct Watch {
    World *world;
    int found, guessed, wrong;
    bool seen[FILM_TILE][FILM_TILE];
} Watch;

static bool see(void *context, int x, int y, const Guess *guess, Middle *out) {
    Watch *w = context;
    *out = w->world(x, y);
    if (guess && guess_light(guess, out)) {
        w->guessed++;
        return true;
    }
    w->found++;
    w->wrong += w->seen[y][x]; /* twice */
    w->seen[y][x] = true;
    return false;
}

static Middle grey(float light, uint32_t object) {
    return (Middle){.seen = {{light, light, light}, 1},
                    .normal = {0, 0, object ? 1 : 0},
                    .object = object,
                    .calm = true,
                    .refinable = true};
}

static double worst(const Watch *w, const Middle *out, int columns, int rows) {
    double most = 0;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            Middle truth = w->world(x, y);
            assert_int_equal(out[y * FILM_TILE + x].object, truth.object);
            most = fmax(most, fabs((double)(out[y * FILM_TILE + x].seen.color.x - truth.seen.color.x)));
        }
    return most;
}

typedef VistaView ViewOf(void *context, int x0, int y0, int x1, int y1, uint32_t object);

static Watch look_with(World *world, ViewOf *view, double error, int columns, int rows, Middle *out) {
    Watch w = {.world = world};
    const GuessSight sight = {.see = see, .view = view, .context = &w, .tolerance = error, .accepted = error * error / 4};
    guess_tile(&sight, columns, rows, out);
    assert_int_equal(w.wrong, 0);
    return w;
}

static Watch look(World *world, double error, int columns, int rows, Middle *out) { return look_with(world, NULL, error, columns, rows, out); }

static VistaView all_even(void *context, int x0, int y0, int x1, int y1, uint32_t object) {
    return VISTA_EVEN;
    (void)context, (void)x0, (void)y0, (void)x1, (void)y1, (void)object;
}
static VistaView all_some(void *context, int x0, int y0, int x1, int y1, uint32_t object) {
    return VISTA_SOME;
    (void)context, (void)x0, (void)y0, (void)x1, (void)y1, (void)object;
}

static VistaView all_wide(void *context, int x0, int y0, int x1, int y1, uint32_t object) {
    return VISTA_WIDE;
    (void)context, (void)x0, (void)y0, (void)x1, (void)y1, (void)object;
}

static Middle even(int x, int y) { return grey(0.2f + 0.01f * (float)x + 0.005f * (float)y, 1); }
static Middle curved(int x, int y) {
    return grey(0.5f + 0.3f * sinf(0.1f * (float)x) * cosf(0.13f * (float)y), 1);
}
static Middle edge(int x, int y) { return grey(x + 2 * y < 40 ? 0.1f : 0.7f, 1); }
static Middle two(int x, int y) { return x * x + y * y < 500 ? grey(0.3f, 1) : grey(0.6f, 2); }
static Middle thin(int x, int y) {
    return x == 14 ? grey(0.9f, 2) : grey(0.3f, 1);
    (void)y;
}
static Middle speckled(int x, int y) { return grey((x * 7 + y * 13) % 11 == 0 ? 0.9f : 0.1f, 1); }

/* A pattern of the colour `c` in light that changes evenly. */
static Middle tinted(int x, int y, float c) {
    static const Texture texture = {.under = NULL};
    const float lit = 0.3f + 0.01f * (float)(x + y);
    Middle m = grey(c * lit + 0.05f, 1);
    m.calm = false;
    m.tint = (SurfaceTint){&texture, {c, c, c}, {lit, lit, lit}};
    return m;
}
static Middle specks(int x, int y) { return tinted(x, y, (x * 7 + y * 13) % 11 == 0 ? 0.9f : 0.1f); }

/* Where light is a multiple of a pattern's colour every colour is looked at, and few of the lights are found. */
static void test_details_of_patterns_are_not_guessed(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(specks, 0.004, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    assert_in_range(w.found, 1, FILM_TILE * FILM_TILE / 4);
}

static Middle ramp(int x, int y) { return tinted(x, y, 0.2f + 0.01f * (float)(x + y)); }
static Middle line(int x, int y) { return tinted(x, y, x == 13 ? 0.9f : 0.4f); }

/* Colours that change evenly are interpolated where something at most a few pixels wide cannot hide between; a line one pixel wide shows. */
static void test_even_patterns_are_guessed_from_few(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look_with(ramp, all_even, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 0.01);
    assert_in_range(w.found + w.guessed, 1, FILM_TILE * FILM_TILE / 3);
    w = look_with(line, all_even, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 0.01); /* it is 0.15 brighter or more */
}

static void test_even_light_is_guessed_from_few(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(even, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    assert_in_range(w.found, 1, FILM_TILE * FILM_TILE / 3);
    assert_int_equal(w.found + w.guessed, FILM_TILE * FILM_TILE);
}

static Middle third(int x, int y) { return grey(1 / 3.0f, 1 + 0 * (uint32_t)(x + y)); }
static Middle endless(int x, int y) { return grey(HUGE_VALF, 1 + 0 * (uint32_t)(x + y)); }

/* In tiles whose last squares are narrower, too, whose weights are no binary fractions. Of endless light nothing is a mean. */
static void test_equal_light_stays_what_it_is(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    for (int columns = 5; columns <= FILM_TILE; columns++) {
        Watch w = look(third, 0.01, columns, FILM_TILE, out);
        assert_true(worst(&w, out, columns, FILM_TILE) == 0 && w.guessed > 0);
        w = look(endless, 0.01, columns, FILM_TILE, out);
        assert_int_equal(w.guessed, 0);
        for (int y = 0; y < FILM_TILE; y++)
            for (int x = 0; x < columns; x++) assert_true(isinf(out[y * FILM_TILE + x].seen.color.x));
    }
}

static Middle bare(int x, int y) {
    Middle m = even(x, y);
    m.single = true;
    return m;
}

/* Even light over ground that turns from pixel to pixel, of which so much is hidden. */
static Middle rough(int x, int y, float hidden) {
    Middle m = even(x, y);
    m.normal = (x + y) & 1 ? (Vec3f){0.5f, 0, 0.866f} : (Vec3f){0, 0, 1};
    m.hidden = hidden;
    return m;
}
static Middle rough_bare(int x, int y) { return rough(x, y, 0); }
static Middle rough_under_matter(int x, int y) { return rough(x, y, 0.95f); }

/* Between bare places of a skin there may be anything; of ground that matter hides the slope hardly counts. */
static void test_matter_of_skins(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(bare, 0.01, FILM_TILE, FILM_TILE, out);
    assert_int_equal(w.guessed, 0);
    assert_int_equal(w.found, FILM_TILE * FILM_TILE);
    w = look(rough_under_matter, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    assert_in_range(w.found, 1, FILM_TILE * FILM_TILE / 3);
    Watch open = look(rough_bare, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(open.found > 2 * w.found);
}

static void test_curved_light_is_as_exact_as_asked(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    int before = 0;
    for (double error = 0.02; error > 1e-5; error /= 10) {
        Watch w = look(curved, error, FILM_TILE, FILM_TILE, out);
        assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 2 * error);
        assert_in_range(w.found, before, FILM_TILE * FILM_TILE);
        before = w.found;
    }
}

/* The corner of something wide, most of which is in the tile below, or above. */
static Middle corner_from_below(int x, int y) { return y >= 29 + abs(x - 12) ? grey(0.8f, 2) : grey(0.3f, 1); }
static Middle corner_from_above(int x, int y) { return y <= 2 - abs(x - 12) ? grey(0.8f, 2) : grey(0.3f, 1); }

static void test_corners_from_other_tiles_are_followed(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    World *const worlds[] = {corner_from_below, corner_from_above};
    for (int k = 0; k < 2; k++) {
        Watch w = look_with(worlds[k], all_wide, 0.01, FILM_TILE, FILM_TILE, out);
        assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
        assert_in_range(w.found + w.guessed, 1, FILM_TILE * FILM_TILE / 3);
    }
}

/* Returns how many were guessed. */
static int guessed_rightly(World *world) {
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(world, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    return w.guessed;
}

static void test_edges_of_light_are_found(void **state) {
    (void)state;
    assert_true(guessed_rightly(edge) > 0);
}

static void test_nothing_is_guessed_over_what_else_is_met(void **state) {
    (void)state;
    guessed_rightly(two);
    assert_true(guessed_rightly(thin) > 0);
}

/* Within (8, 16) to (16, 24) it is met at none of the corners. */
static Middle bulge(int x, int y) {
    const float off_x = (float)x - 4.5f, off_y = (float)y - 20;
    return off_x * off_x + off_y * off_y < 25 ? grey(0.6f, 2) : grey(0.3f, 1);
}
/* Along a slanted stripe three pixels wide, and of what lies within a square of four. */
static Middle stripe(int x, int y) { return abs(2 * x - y - 11) < 4 ? grey(0.6f, 2) : grey(0.3f, 1); }
static Middle spot(int x, int y) { return x > 16 && x < 20 && y > 12 && y < 16 ? grey(0.6f, 2) : grey(0.3f, 1); }

static void test_edges_are_followed_into_even_squares(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look_with(bulge, all_even, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    assert_in_range(w.found, 1, FILM_TILE * FILM_TILE / 3);
    w = look_with(stripe, all_some, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    w = look_with(spot, all_some, 0.01, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) < 1e-5);
    assert_in_range(w.found + w.guessed, 1, FILM_TILE * FILM_TILE * 2 / 3);
}

/* Specks lie between the corners; the guesses that are tried tell. */
static void test_guesses_that_are_wrong_are_given_up(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(speckled, 0.004, FILM_TILE, FILM_TILE, out);
    assert_true(worst(&w, out, FILM_TILE, FILM_TILE) == 0);
    for (int i = 0; i < FILM_TILE * FILM_TILE; i++) assert_true(out[i].doubt == 0);
}

static void test_nothing_is_guessed_unless_asked(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    Watch w = look(even, 0, FILM_TILE, FILM_TILE, out);
    assert_int_equal(w.found, FILM_TILE * FILM_TILE);
    assert_int_equal(w.guessed, 0);
}

static void test_tiles_of_any_size(void **state) {
    (void)state;
    Middle out[FILM_TILE * FILM_TILE];
    for (int columns = 1; columns <= FILM_TILE; columns++)
        for (int rows = 1; rows <= FILM_TILE; rows += columns % 3 + 1) {
            Watch w = look(curved, 0.01, columns, rows, out);
            assert_true(worst(&w, out, columns, rows) < 0.02);
            assert_true(w.found + w.guessed >= columns * rows);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_even_light_is_guessed_from_few),
                                       cmocka_unit_test(test_details_of_patterns_are_not_guessed),
                                       cmocka_unit_test(test_even_patterns_are_guessed_from_few),
                                       cmocka_unit_test(test_equal_light_stays_what_it_is),
                                       cmocka_unit_test(test_matter_of_skins),
                                       cmocka_unit_test(test_curved_light_is_as_exact_as_asked),
                                       cmocka_unit_test(test_edges_of_light_are_found),
                                       cmocka_unit_test(test_nothing_is_guessed_over_what_else_is_met),
                                       cmocka_unit_test(test_edges_are_followed_into_even_squares),
                                       cmocka_unit_test(test_guesses_that_are_wrong_are_given_up),
                                       cmocka_unit_test(test_nothing_is_guessed_unless_asked),
                                       cmocka_unit_test(test_corners_from_other_tiles_are_followed),
                                       cmocka_unit_test(test_tiles_of_any_size)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
