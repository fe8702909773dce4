/* Folded boxes: all places of a point, the sign of det J over a box, pieces of rays; and that the two roads agree. */
#include "mapping_measures.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

/* A unit triangle or square whose height vectors are spread by up to `spread` sideways. */
static SkinCell spread_cell(RandomStream *r, bool triangle, double spread, double height) {
    SkinCell cell = {.triangle = triangle};
    cell.foot = (BilinearVec){{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}}};
    Vec3 h[4];
    for (int k = 0; k < 4; k++) h[k] = vec3_scale(vec3(between(r, -spread, spread), 1 + between(r, -.6, .6) * spread, between(r, -spread, spread)), height);
    cell.height = (BilinearVec){{h[0], vec3_sub(h[1], h[0]), vec3_sub(h[2], h[0]), {0, 0, 0}}};
    if (!triangle) cell.height.c[3] = vec3_sub(vec3_add(h[0], h[3]), vec3_add(h[1], h[2]));
    cell.bounds = skin_cell_bounds(&cell);
    cell.side = (uint8_t)skin_cell_side(&cell, 1);
    return cell;
}

static SkinPoint random_place(RandomStream *r, bool triangle) {
    SkinPoint p = {0, random_next_unit(r), random_next_unit(r), random_next_unit(r)};
    if (triangle && p.a + p.b > 1) p.a = 1 - p.a, p.b = 1 - p.b;
    return p;
}

static bool among(const SkinPoint *list, int count, const SkinPoint *p, double near) {
    for (int i = 0; i < count; i++)
        if (fabs(list[i].a - p->a) + fabs(list[i].b - p->b) + fabs(list[i].w - p->w) < near) return true;
    return false;
}

static double determinant_at(const SkinCell *cell, const SkinPoint *p) {
    Mat3 j;
    skin_cell_position(cell, p->a, p->b, p->w, &j);
    return mat3_determinant(&j);
}

/* The place a point was made from is found again, and every place found is one of the point; on a fold two become one. */
static void count_missed(bool triangle, int trials, uint64_t seed) {
    RandomStream r = {seed};
    int missed = 0, folded = 0, several = 0;
    for (int i = 0; i < trials; i++) {
        SkinCell cell = spread_cell(&r, triangle, 1.5, 2);
        SkinPoint p = random_place(&r, triangle), found[MOST_PREIMAGES];
        Vec3 world = skin_cell_position(&cell, p.a, p.b, p.w, NULL);
        int count = skin_cell_preimages(&cell, world, 1e-12, found);
        folded += cell.side == CELL_FOLDED;
        several += count > 1;
        missed += fabs(determinant_at(&cell, &p)) > 1e-4 && !among(found, count, &p, 1e-5);
        for (int k = 0; k < count; k++) {
            double miss = vec3_length(vec3_sub(skin_cell_position(&cell, found[k].a, found[k].b, found[k].w, NULL), world));
            if (fabs(determinant_at(&cell, &found[k])) > 1e-4) assert_true(miss < 1e-9);
        }
    }
    printf("%s: %d of %d folded, %d points with several places, %d missed\n", triangle ? "prisms" : "hexahedra", folded, trials, several, missed);
    assert_true(folded > trials / 3 && several > trials / 100);
    assert_int_equal(missed, 0);
}

static void every_place_of_a_point_is_found(void **state) {
    (void)state;
    count_missed(true, 100000, 1);
    count_missed(false, 1500, 2);
}

/* Against 9³ samples of det J: what shows both signs folds, and what is said to fold shows both, were there enough samples. */
static void folds_are_decided(void **state) {
    (void)state;
    RandomStream r = {3};
    int folded = 0, wrong = 0, unseen = 0;
    for (int i = 0; i < 4000; i++) {
        bool triangle = i & 1, low = false, high = false;
        SkinCell cell = spread_cell(&r, triangle, between(&r, 0, 1.5), 1.5);
        for (int k = 0; k < 729; k++) {
            SkinPoint p = {0, k % 9 / 8.0, k / 9 % 9 / 8.0, k / 81 / 8.0};
            if (triangle && p.a + p.b > 1) continue;
            double det = determinant_at(&cell, &p);
            low |= det < 0, high |= det > 0;
        }
        folded += cell.side == CELL_FOLDED;
        wrong += low && high && cell.side != CELL_FOLDED;
        unseen += !(low && high) && cell.side == CELL_FOLDED;
        double safe = skin_cell_unfolded_height(&cell, 1);
        assert_true(safe == 1 ? cell.side != CELL_FOLDED : skin_cell_side(&cell, safe) != CELL_FOLDED && skin_cell_side(&cell, safe + 0.01) == CELL_FOLDED);
    }
    printf("%d of 4000 boxes fold; %d folds overlooked, %d between the samples\n", folded, wrong, unseen);
    assert_true(folded > 400);
    assert_int_equal(wrong, 0);
    assert_true(unseen < folded / 20);
}

/* At random points of rays: as many pieces go through as the point has places. */
static void pieces_are_as_many_as_places(void **state) {
    (void)state;
    RandomStream r = {4};
    int asked = 0, different = 0;
    static SkinPiece pieces[MOST_PIECES];
    for (int i = 0; i < 1200; i++) {
        bool triangle = i % 4 != 0;
        SkinCell cell = spread_cell(&r, triangle, 1.5, 2);
        SkinPoint p = random_place(&r, triangle), found[MOST_PREIMAGES];
        Vec3 d = spread_direction(&r);
        Ray ray = {vec3_madd(skin_cell_position(&cell, p.a, p.b, p.w, NULL), d, -6), d};
        int count = skin_cell_pieces(&cell, 0, &ray, 0, 20, pieces);
        for (int k = 0; k < 4; k++) {
            double t = between(&r, 5, 7);
            int through = 0, places = skin_cell_preimages(&cell, vec3_madd(ray.origin, d, t), 1e-12, found);
            for (int n = 0; n < count; n++) through += pieces[n].t0 <= t && t < pieces[n].t1;
            asked++;
            different += through != places;
        }
    }
    printf("%d of %d points of rays differ\n", different, asked);
    assert_true(different <= asked / 100);
}

/* What Newton's method alone makes of the same points: the cubic and the subdivision are not there for nothing. */
static void newton_alone_goes_astray(void **state) {
    (void)state;
    PlaceCounts mild = measure_places(true, .5, .3, 20000, 1), wild = measure_places(true, 1.5, 2, 20000, 2), cubes = measure_places(false, 1.5, 2, 300, 3);
    printf("Newton's method alone: %.2f steps in prisms that do not fold, %.2f in wild ones, of whose points it finds %.1f %% elsewhere\n",
           mild.newton_steps, wild.newton_steps, 100 * (double)wild.newton_wrong / (double)wild.boxes);
    assert_true(mild.folded == 0 && mild.newton_steps < 4 && mild.wrong_unfolded == 0 && mild.several == 0);
    assert_true(wild.newton_wrong > wild.boxes / 20);
    assert_true(mild.missed == 0 && wild.missed == 0 && cubes.missed == 0);
    assert_true(mild.lost_unfolded == 0 && wild.lost_unfolded == 0 && cubes.lost_unfolded == 0);
}

/* Chords miss whole voxels, quadratics a fraction of one. */
static void ways_are_true_to_a_fraction_of_a_voxel(void **state) {
    (void)state;
    enum { CHORD, QUADRATIC, STRAIGHT, BOX, EXACT };
    WayErrors mild = measure_ways(200, .3, .3, 1), wild = measure_ways(200, .5, .5, 2);
    for (int k = 0; k < MEASURE_WAYS; k++)
        printf("%s is off by %.3f and %.3f voxels in the middle, %.3f and %.3f at 95 %%\n", measure_way_names[k], mild.median[k], wild.median[k],
               mild.percentile_95[k], wild.percentile_95[k]);
    assert_true(mild.ways > 150 && wild.ways > 150);
    assert_true(wild.percentile_95[CHORD] > 2 && fabs(wild.percentile_95[STRAIGHT] / wild.percentile_95[CHORD] - 1) < .05);
    assert_true(wild.percentile_95[BOX] < .3 && wild.percentile_95[BOX] <= wild.percentile_95[QUADRATIC] && mild.percentile_95[BOX] < .1);
    assert_true(wild.percentile_95[EXACT] < .01);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_place_of_a_point_is_found), cmocka_unit_test(folds_are_decided),
                                       cmocka_unit_test(pieces_are_as_many_as_places), cmocka_unit_test(newton_alone_goes_astray),
                                       cmocka_unit_test(ways_are_true_to_a_fraction_of_a_voxel)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
