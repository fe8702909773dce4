/* Which edges the mapping of a cell bends, against the same in doubles: middles of edges in cells of any shape. */
#include "base/random.h"
#include "render/beam_cell.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

enum { CELLS = 400, EDGES = 50 };

static double between(RandomStream *r, double lo, double hi) { return lo + (hi - lo) * random_next_unit(r); }
static Vec3 anything(RandomStream *r, double size) { return vec3(between(r, -size, size), between(r, -size, size), between(r, -size, size)); }

/* Feet, height vectors, and where `askew` texture coordinates and heights too, are those of no plane. */
static SkinCell random_cell(RandomStream *r, double size, bool askew) {
    SkinCell cell = {.side = CELL_UPRIGHT};
    for (int i = 0; i < 4; i++) cell.foot.c[i] = anything(r, i == 3 ? 0.2 * size : size), cell.height.c[i] = anything(r, i == 0 ? size : 0.4 * size);
    cell.u = (Bilinear){{3, 2, 0.3, askew ? between(r, -0.4, 0.4) : 0}}, cell.v = (Bilinear){{-5, 0.2, 1.5, askew ? between(r, -0.4, 0.4) : 0}};
    cell.w_foot = (Bilinear){{0, askew ? 0.1 : 0, 0, 0}}, cell.w_tip = (Bilinear){{1, 0, askew ? 0.1 : 0, 0}};
    return cell;
}

static Beam random_beam(RandomStream *r) {
    return (Beam){.origin = anything(r, 5), .shift = anything(r, 1), .rows = {anything(r, 3), anything(r, 3), anything(r, 3)}, .perspective = true};
}

static Vec3 bilinear_vec(const BilinearVec *f, double a, double b) {
    return vec3_madd(vec3_madd(vec3_madd(f->c[0], f->c[1], a), f->c[2], b), f->c[3], a * b);
}

static Vec3 place(const SkinCell *cell, Vec3 p) { return vec3_madd(bilinear_vec(&cell->foot, p.x, p.y), bilinear_vec(&cell->height, p.x, p.y), p.z); }

static Vec3 texture(const SkinCell *cell, Vec3 p) {
    double foot = bilinear_at(&cell->w_foot, p.x, p.y), tip = bilinear_at(&cell->w_tip, p.x, p.y);
    return vec3(bilinear_at(&cell->u, p.x, p.y), bilinear_at(&cell->v, p.x, p.y), foot + (tip - foot) * p.z);
}

/* The place of the middle of a line that is straight in texture space. */
static Vec3 middle_of(const SkinCell *cell, Vec3 p, Vec3 q) {
    Vec3 at = vec3_scale(vec3_add(p, q), 0.5), wanted = vec3_scale(vec3_add(texture(cell, p), texture(cell, q)), 0.5);
    const double *u = cell->u.c, *v = cell->v.c;
    for (int i = 0; i < 20; i++) {
        double ua = u[1] + u[3] * at.y, ub = u[2] + u[3] * at.x, va = v[1] + v[3] * at.y, vb = v[2] + v[3] * at.x, det = ua * vb - ub * va;
        Vec3 off = vec3_sub(wanted, texture(cell, at));
        at.x += (vb * off.x - ub * off.y) / det, at.y += (ua * off.y - va * off.x) / det;
    }
    double foot = bilinear_at(&cell->w_foot, at.x, at.y), tip = bilinear_at(&cell->w_tip, at.x, at.y);
    return vec3(at.x, at.y, (wanted.z - foot) / (tip - foot));
}

/* How far the middle lies beside the straight line from p to q: across the direction that the edge has there. */
static double bow(const SkinCell *cell, Vec3 p, Vec3 q, Vec3 middle) {
    const double step = 1e-4;
    Vec3 half = vec3_scale(vec3_add(p, q), 0.5), way = vec3_scale(vec3_sub(q, p), step);
    Vec3 chord = vec3_scale(vec3_add(place(cell, p), place(cell, q)), 0.5), off = vec3_sub(place(cell, middle), chord);
    Vec3 along = vec3_normalize(vec3_sub(place(cell, vec3_add(half, way)), place(cell, vec3_sub(half, way))));
    return vec3_length(vec3_madd(off, along, -vec3_dot(off, along)));
}

static bool bends_among_many(const CellFrame *f, Vec3f p, Vec3f q, float tolerance) {
    enum { MANY = 11, THIS = 6 };
    float pa[MANY] = {[THIS] = p.x}, pb[MANY] = {[THIS] = p.y}, pw[MANY] = {[THIS] = p.z}, qa[MANY] = {[THIS] = q.x}, qb[MANY] = {[THIS] = q.y}, qw[MANY] = {[THIS] = q.z};
    uint32_t bent[MANY];
    cell_frame_bends_of(f, MANY, pa, pb, pw, qa, qb, qw, tolerance, bent);
    return bent[THIS];
}

/* Tolerances a little below and above what the edge needs, in another beam and the other way round. */
static void hold(double size, bool askew) {
    RandomStream r = {askew ? 8 : 7};
    int bent = 0;
    for (int c = 0; c < CELLS; c++) {
        SkinCell cell = random_cell(&r, size, askew);
        Beam one = random_beam(&r), other = random_beam(&r);
        CellFrame f, g;
        assert_true(cell_frame(&f, &one, &cell) && cell_frame(&g, &other, &cell));
        assert_int_equal(f.affine, !askew);
        for (int e = 0; e < EDGES; e++) {
            Vec3 p = vec3(between(&r, 0, 1), between(&r, 0, 1), between(&r, 0, 1)), q = vec3(between(&r, 0, 1), between(&r, 0, 1), between(&r, 0, 1));
            Vec3 middle = middle_of(&cell, p, q);
            double wanted = bow(&cell, p, q, middle);
            if (wanted < 1e-3 * size) continue;
            bent++;
            Vec3f pf = vec3f_from(p), qf = vec3f_from(q), mf = vec3f_from(middle);
            float little = (float)(0.98 * wanted), much = (float)(1.02 * wanted);
            assert_true(cell_frame_bends(&f, pf, qf, mf, little) && cell_frame_bends(&f, qf, pf, mf, little));
            assert_false(cell_frame_bends(&f, pf, qf, mf, much) || cell_frame_bends(&f, qf, pf, mf, much));
            float close = (float)wanted;
            assert_int_equal(cell_frame_bends(&f, pf, qf, mf, close), cell_frame_bends(&g, qf, pf, mf, close));
            if (!askew) assert_int_equal(bends_among_many(&g, pf, qf, close), cell_frame_bends(&f, pf, qf, mf, close));
        }
    }
    assert_true(bent > CELLS * EDGES / 4);
}

static void edges_of_even_cells(void **state) { (void)state; hold(1, false); }
static void edges_of_cells_askew(void **state) { (void)state; hold(1, true); }
/* The squares of squares of such lengths are no floats. */
static void edges_of_huge_and_tiny_cells(void **state) { (void)state; hold(1e12, false); hold(1e12, true); hold(1e-12, false); hold(1e-12, true); }

/* The walls and the foot of a cell are ruled: along its own lines nothing bends. */
static void lines_of_the_cell_are_straight(void **state) {
    (void)state;
    RandomStream r = {9};
    for (int c = 0; c < CELLS; c++) {
        SkinCell cell = random_cell(&r, 1, false);
        Beam beam = random_beam(&r);
        CellFrame f;
        assert_true(cell_frame(&f, &beam, &cell));
        for (int axis = 0; axis < 3; axis++) {
            float at[3] = {(float)between(&r, 0, 1), (float)between(&r, 0, 1), (float)between(&r, 0, 1)};
            Vec3f p = vec3f(axis == 0 ? 0 : at[0], axis == 1 ? 0 : at[1], axis == 2 ? 0 : at[2]);
            Vec3f q = vec3f(axis == 0 ? 1 : at[0], axis == 1 ? 1 : at[1], axis == 2 ? 1 : at[2]);
            assert_false(cell_frame_bends(&f, p, q, vec3f_scale(vec3f_add(p, q), 0.5f), 0));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(edges_of_even_cells), cmocka_unit_test(edges_of_cells_askew),
                                       cmocka_unit_test(edges_of_huge_and_tiny_cells), cmocka_unit_test(lines_of_the_cell_are_straight)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
