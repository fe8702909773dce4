/* Pavements: every piece has its tiles, and the numbers are POV-Ray's. */
#include "pattern/pavement.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#define H 0.86602540378443865

/* POV-Ray 3.7.0.10's numbers at places drawn by lot, for every pavement and looks drawn by lot: written by a program for it, of
 * function { pigment { pavement … } }. */
static const struct {
    PavementSettings settings;
    double x, z, number;
} numbers[] = {
#include "pov_pavements.inc"
};

static void numbers_are_povrays(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        double number = pavement_number(&numbers[i].settings, vec3(numbers[i].x, 0.7, numbers[i].z));
        assert_true(fabs(number - numbers[i].number) < 2e-5); /* they are written with five digits */
    }
}

/* ---- pieces ---- */

enum { SIDE = 40 };

/* Middles of a grid's cells, two triangles to a cell, and from each the steps over its sides. */
typedef struct Grid {
    int sides, kinds;
    double u[2], v[2], middle[2][2];
} Grid;

static const Grid grids[] = {
    {3, 2, {1, 0}, {0.5, H}, {{0.5, H / 3}, {1, 2 * H / 3}}},
    {4, 1, {1, 0}, {0, 1}, {{0.5, 0.5}}},
    {6, 1, {1.5, H}, {0, 2 * H}, {{1, 0}}},
};

/* Cells around one of each kind: over cells, and the other's kind. */
typedef struct Step {
    int i, j, kind;
} Step;
static const Step around[3][2][6] = {
    {{{0, 0, 1}, {-1, 0, 1}, {0, -1, 1}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
    {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}},
    {{{1, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, -1, 0}}},
};

static void place(const Grid *g, int i, int j, int kind, double *at) {
    for (int k = 0; k < 2; k++) at[k] = g->middle[kind][k] + i * g->u[k] + j * g->v[k];
}

/* Cells that hang together with this one, which are struck off. */
static int piece_size(const Grid *g, const PavementSettings *s, bool (*met)[SIDE][2], int i, int j, int kind) {
    if (i < 0 || j < 0 || i >= SIDE || j >= SIDE) return 1000; /* it reaches out of what is looked at */
    if (met[i][j][kind]) return 0;
    met[i][j][kind] = true;
    int size = 1;
    double here[2], there[2];
    place(g, i, j, kind, here);
    for (int k = 0; k < g->sides; k++) {
        Step step = around[g - grids][kind][k];
        place(g, i + step.i, j + step.j, step.kind, there);
        double across = pavement_number(s, vec3((here[0] + there[0]) / 2, 0, (here[1] + there[1]) / 2));
        if (across < 0.999) size += piece_size(g, s, met, i + step.i, j + step.j, step.kind);
    }
    return size;
}

static void pieces_have_their_tiles(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof grids / sizeof *grids; k++)
        for (int tiles = 1; tiles <= 6; tiles++)
            for (int pattern = 1; pattern <= pavement_count(grids[k].sides, tiles); pattern++) {
                PavementSettings settings = {.sides = grids[k].sides, .tiles = tiles, .pattern = pattern};
                bool met[SIDE][SIDE][2] = {{{false}}};
                for (int i = 12; i < 28; i++)
                    for (int j = 12; j < 28; j++)
                        for (int kind = 0; kind < grids[k].kinds; kind++) {
                            int size = piece_size(&grids[k], &settings, met, i, j, kind);
                            assert_true(size == 0 || size == tiles);
                        }
            }
}

static void there_are_so_many(void **state) {
    (void)state;
    assert_int_equal(pavement_count(4, 6), 35);
    assert_int_equal(pavement_count(6, 5), 22);
    assert_int_equal(pavement_count(6, 6), 0);
    assert_int_equal(pavement_count(5, 1), 0);
    assert_int_equal(pavement_count(2, 1), 0);
    assert_int_equal(pavement_count(7, 1), 0);
    assert_int_equal(pavement_count(4, 0), 0);
    assert_int_equal(pavement_count(4, 7), 0);
}

/* No place is without a number; far from the origin pavements go on. */
static void numbers_are_in_range(void **state) {
    (void)state;
    const double places[] = {0, -0.0, 1e-300, -1e-300, 1e9, -1e12, 1e13, HUGE_VAL, -HUGE_VAL, NAN};
    const int sides[] = {3, 4, 6};
    for (size_t k = 0; k < 3; k++)
        for (int form = 0; form <= 3; form++)
            for (int look = 0; look <= 2; look++)
                for (size_t i = 0; i < sizeof places / sizeof *places; i++)
                    for (size_t j = 0; j < sizeof places / sizeof *places; j++) {
                        PavementSettings s = {sides[k], 5, 3, look, look, form};
                        double number = pavement_number(&s, vec3(places[i], 0, places[j]));
                        assert_true(number >= 0 && number <= 1);
                    }
    const PavementSettings bricks = {.sides = 4, .tiles = 2, .pattern = 1};
    assert_true(pavement_number(&bricks, vec3(1e9 + 0.25, 0, 1e9 + 1)) == pavement_number(&bricks, vec3(0.25, 0, 1)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_povrays),
        cmocka_unit_test(pieces_have_their_tiles),
        cmocka_unit_test(there_are_so_many),
        cmocka_unit_test(numbers_are_in_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
