/* Rays through lattices against summation in small steps. */
#include "base/random.h"
#include "volume/lattice.h"

#include <unistd.h>

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

static void assert_near(double found, double wanted, double tolerance) {
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.12g, not %.12g", found, wanted);
}

static Arena arena;

static Lattice make(int x, int y, int z, double filled, uint64_t seed) {
    Lattice lattice;
    RandomStream random = {seed};
    lattice_init(&lattice, (int[3]){x, y, z}, &arena);
    for (int k = 0; k < z; k++)
        for (int j = 0; j < y; j++)
            for (int i = 0; i < x; i++) lattice_set(&lattice, i, j, k, random_next_unit(&random) < filled ? (float)random_next_unit(&random) : 0);
    lattice_finish(&lattice);
    return lattice;
}

/* Simpson's rule between all walls is exact for cubics, found without walking: walls of all axes, sorted. */
static double brute_length(const Lattice *l, const Ray *ray, double t0, double t1) {
    double walls[256], sum = 0;
    int count = 0;
    walls[count++] = t0, walls[count++] = t1;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i <= l->size[k] + 1; i++) {
            double d = vec3_get(ray->direction, k), t = (i - vec3_get(ray->origin, k)) / d;
            if (d != 0 && t > t0 && t < t1) walls[count++] = t;
        }
    for (int i = 1; i < count; i++)
        for (int j = i; j > 0 && walls[j - 1] > walls[j]; j--) {
            double w = walls[j];
            walls[j] = walls[j - 1], walls[j - 1] = w;
        }
    for (int i = 0; i + 1 < count; i++) {
        double a = walls[i], b = walls[i + 1];
        double f0 = lattice_value(l, vec3_madd(ray->origin, ray->direction, a)), f1 = lattice_value(l, vec3_madd(ray->origin, ray->direction, b));
        sum += (b - a) / 6 * (f0 + 4 * lattice_value(l, vec3_madd(ray->origin, ray->direction, (a + b) / 2)) + f1);
    }
    return sum;
}

static double walked_length(const Lattice *l, const Ray *ray, double t0, double t1) {
    LatticeWalk walk;
    LatticePiece piece;
    double sum = 0, end = t0;
    lattice_walk_begin(&walk, l, ray, t0, t1);
    while (lattice_walk_next(&walk, &piece)) {
        assert_true(piece.t0 >= end - 1e-12 && piece.t1 >= piece.t0 && piece.t1 <= t1);
        end = piece.t1;
        sum += piece.length;
        double half = lattice_piece_invert(&walk, &piece, piece.length / 3);
        assert_true(half >= piece.t0 && half <= piece.t1);
    }
    return sum;
}

static bool clip(const Lattice *l, const Ray *ray, double *t0, double *t1) {
    Box3 box = {vec3_splat(0.5), vec3(l->size[0] + 0.5, l->size[1] + 0.5, l->size[2] + 0.5)};
    *t0 = -1e9, *t1 = 1e9;
    return box3_clip_ray(box, ray, t0, t1) && *t0 < *t1;
}

static void integrals_are_exact(void **state) {
    (void)state;
    const double fillings[] = {1, 0.3, 0.01};
    for (int f = 0; f < 3; f++) {
        Lattice l = make(13, 5, 22, fillings[f], 7 + (uint64_t)f);
        RandomStream random = {99};
        for (int i = 0; i < 3000; i++) {
            Ray ray = {vec3(14 * random_next_unit(&random), 6 * random_next_unit(&random), 23 * random_next_unit(&random)),
                       vec3(random_next_unit(&random) - 0.5, random_next_unit(&random) - 0.5, random_next_unit(&random) - 0.5)};
            double t0, t1;
            if (i % 5 == 0) ray.direction.x = 0; /* along walls, */
            if (i % 7 == 0) ray.direction.z = 0;
            if (i % 3 == 0) ray.origin = vec3(floor(ray.origin.x), floor(ray.origin.y), floor(ray.origin.z)); /* and in them */
            if (vec3_length(ray.direction) < 0.01 || !clip(&l, &ray, &t0, &t1)) continue;
            double truth = brute_length(&l, &ray, t0, t1);
            assert_near(walked_length(&l, &ray, t0, t1), truth, 1e-9 * (1 + truth));
        }
    }
}

static void one_cell_is_even(void **state) {
    (void)state;
    Lattice l;
    lattice_init(&l, (int[3]){1, 1, 1}, &arena);
    lattice_set(&l, 0, 0, 0, 0.25f);
    lattice_finish(&l);
    Ray ray = {vec3(0.5, 0.6, 0.7), vec3(1, 0, 0)};
    assert_near(walked_length(&l, &ray, 0, 1), 0.25, 1e-12);
    assert_near(lattice_mean(&l), 0.25, 1e-12);
}

static void empty_has_no_pieces(void **state) {
    (void)state;
    Lattice l = make(20, 20, 20, 0, 1);
    Ray ray = {vec3(0.5, 3, 3), vec3(1, 0.1, 0.2)};
    assert_near(walked_length(&l, &ray, 0, 20), 0, 0);
}

/* The integral up to where a length is reached is that length. */
static void inversion_is_exact(void **state) {
    (void)state;
    Lattice l = make(9, 9, 9, 0.5, 3);
    RandomStream random = {5};
    for (int i = 0; i < 500; i++) {
        Ray ray = {vec3(0.5, 0.5 + 9 * random_next_unit(&random), 0.5 + 9 * random_next_unit(&random)), vec3(1, random_next_unit(&random) - 0.5, 0.1)};
        double t0, t1, before = 0;
        LatticeWalk walk;
        LatticePiece piece;
        if (!clip(&l, &ray, &t0, &t1)) continue;
        lattice_walk_begin(&walk, &l, &ray, t0, t1);
        while (lattice_walk_next(&walk, &piece)) {
            double wanted = piece.length * random_next_unit(&random), t = lattice_piece_invert(&walk, &piece, wanted);
            assert_near(brute_length(&l, &ray, t0, t), before + wanted, 1e-9);
            before += piece.length;
        }
    }
}

/* Where walls of two empty blocks meet, rounding says either that the ray is in the one or in the other: it must not go to and fro for ever. */
static void rays_through_edges_of_empty_blocks_end(void **state) {
    (void)state;
    Lattice l = make(40, 40, 40, 0.0005, 11);
    RandomStream random = {6};
    alarm(60); /* by which it would be found */
    for (int i = 0; i < 200000; i++) {
        Vec3 way = vec3(random_next_unit(&random) - 0.5, random_next_unit(&random) - 0.5, random_next_unit(&random) - 0.5);
        double far = 100 * random_next_unit(&random), t0 = 0, t1 = 200;
        Vec3 edge = vec3(4 * floor(10 * random_next_unit(&random)), 4 * floor(10 * random_next_unit(&random)), 40 * random_next_unit(&random));
        Ray ray = {vec3_madd(edge, way, -far), way};
        LatticeWalk walk;
        LatticePiece piece;
        if (!box3_clip_ray((Box3){vec3_splat(0.5), vec3_splat(40.5)}, &ray, &t0, &t1)) continue;
        double last = t0;
        lattice_walk_begin(&walk, &l, &ray, t0, t1);
        for (; lattice_walk_next(&walk, &piece); last = piece.t1) assert_true(piece.t0 >= last && piece.t1 <= t1);
    }
    alarm(0);
}

/* Cells that go into each other evenly keep all that is in them, and each is the mean of its block. */
static void coarser_ones_hold_as_much(void **state) {
    (void)state;
    Lattice fine = make(12, 6, 9, 0.7, 5), coarse;
    lattice_coarsen(&coarse, &fine, (int[3]){4, 3, 9}, &arena);
    assert_near(lattice_mean(&coarse), lattice_mean(&fine), 1e-7);
    double sum = 0;
    for (int j = 3; j <= 4; j++)
        for (int i = 4; i <= 6; i++) sum += lattice_value(&fine, vec3(i, j, 7));
    assert_near(lattice_value(&coarse, vec3(2, 2, 7)), sum / 6, 1e-6);
    lattice_coarsen(&coarse, &fine, (int[3]){5, 4, 7}, &arena); /* unevenly: no cell is left out, none beyond the ends is asked for */
    for (int k = 1; k <= 7; k++) assert_true(isfinite(lattice_value(&coarse, vec3(5, 4, k))));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(integrals_are_exact), cmocka_unit_test(one_cell_is_even), cmocka_unit_test(empty_has_no_pieces), cmocka_unit_test(coarser_ones_hold_as_much),
                                       cmocka_unit_test(inversion_is_exact), cmocka_unit_test(rays_through_edges_of_empty_blocks_end)};
    arena_init(&arena, NULL, 0);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_destroy(&arena);
    return failed;
}
