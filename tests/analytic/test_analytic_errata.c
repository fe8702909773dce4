/* What is printed wrongly in the paper on volumes (B93: Blasi, Le Saec & Schlick 1993), drawn as printed and as it is: doc/volumes.md has the list. */
#include "analytic.h"

#include "base/random.h"
#include "volume/phase.h"

static void assert_near(double found, double wanted, double tolerance) {
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.6g, not %.6g", found, wanted);
}

/* ---- phase functions: Figs. 4 and 7, and a formula that is copied in many places ---- */

static Phase fit(double share, double k, double k2) { return (Phase){{{PHASE_SCHLICK, k, share}, {PHASE_SCHLICK, k2, 1 - share}}, 2}; }
static Phase alone(PhaseKind kind, double k) { return (Phase){{{kind, k, 1}}, 1}; }

static double murky(double mu) { return 0.5 + 16.5 * pow((1 + mu) / 2, 32); }
static double hazy(double mu) { return 0.5 + 4.5 * pow((1 + mu) / 2, 8); }

enum { POINTS = 20000 };

/* How far the function is from what it is to stand for: root of the squares' integral against that of the other, and half the integral of the distance (what share of
 * light goes elsewhere). */
static void distance(const Phase *phase, double (*wanted)(double), double *squares, double *variation) {
    double apart = 0, whole = 0, sum = 0;
    for (int i = 0; i < POINTS; i++) {
        double mu = -1 + 2 * (i + 0.5) / POINTS, w = wanted(mu), d = 4 * VTS_PI * phase_value(phase, mu) - w;
        apart += d * d, whole += w * w, sum += fabs(d) / POINTS / 2;
    }
    *squares = sqrt(apart / whole), *variation = sum;
}

static double mean_cosine(const Phase *phase) {
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        double mu = -1 + 2 * (i + 0.5) / POINTS;
        sum += 4 * VTS_PI * phase_value(phase, mu) * mu / POINTS;
    }
    return sum;
}

static void murky_light_goes_forwards(void **state) {
    (void)state;
    const Phase printed = fit(0.19, -0.65, -0.91), right = fit(0.19, -0.65, 0.91);
    double far, near, unused;
    distance(&printed, murky, &far, &unused);
    distance(&right, murky, &near, &unused);
    printf("Fig. 4: k' = -0.91 is wrong by %.3f, +0.91 by %.3f; mean cosines %.3f and %.3f\n", far, near, mean_cosine(&printed), mean_cosine(&right));
    assert_near(far, 1.406, 2e-3);
    assert_near(near, 0.146, 2e-3);
    assert_near(mean_cosine(&printed), -0.724, 2e-3);
    assert_near(mean_cosine(&right), 0.542, 2e-3);
}

static void better_fits_are_better(void **state) {
    (void)state;
    const struct {
        double (*wanted)(double);
        Phase printed, here;
        double variation[2];
    } cases[] = {{hazy, fit(0.12, -0.50, 0.70), fit(0.222, -0.337, 0.752), {0.043, 0.029}},
                 {murky, fit(0.19, -0.65, 0.91), fit(0.404, -0.128, 0.943), {0.127, 0.061}}};
    for (int i = 0; i < 2; i++) {
        double unused, before, after;
        distance(&cases[i].printed, cases[i].wanted, &unused, &before);
        distance(&cases[i].here, cases[i].wanted, &unused, &after);
        printf("Fig. 7: %.4f of the light goes elsewhere, with ours %.4f\n", before, after);
        assert_near(before, cases[i].variation[0], 1e-3);
        assert_near(after, cases[i].variation[1], 1e-3);
    }
    double wanted = 0;
    for (int i = 0; i < POINTS; i++) {
        double mu = -1 + 2 * (i + 0.5) / POINTS;
        wanted += murky(mu) * mu / POINTS;
    }
    assert_near(wanted, 0.4706, 1e-4);
    assert_near(mean_cosine(&cases[1].printed), 0.542, 2e-3);
    assert_near(mean_cosine(&cases[1].here), 0.467, 2e-3);
}

/* "Henyey-Bernstein" is Henyey's and Greenstein's function, whose k is its mean cosine; the numbers that eq. 23 draws are distributed as eq. 21 has it. */
static void names_and_inverses(void **state) {
    (void)state;
    static const double ks[] = {-0.9, -0.6, 0.3, 0.9};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(ks); i++) {
        const Phase hg = alone(PHASE_HENYEY_GREENSTEIN, ks[i]), schlick = alone(PHASE_SCHLICK, ks[i]);
        double k = ks[i];
        assert_near(mean_cosine(&hg), k, 1e-4);
        for (double u = 0.05; u < 1; u += 0.1) {
            double mu = phase_draw(&schlick, 0, u), below = (1 - k * k) / (2 * k) * (1 / (1 - k * mu) - 1 / (1 + k));
            assert_near(below, u, 1e-12);
        }
    }
}

/* k = 1.55 g - 0.55 g^3 as the Schlick function of mean cosine g, not B93's but copied in many programs, is no phase function near 1; and far off before. */
static void no_cubic_gives_the_eccentricity(void **state) {
    double g = 0.95, cubic = 1.55 * g - 0.55 * g * g * g;
    Phase printed = alone(PHASE_SCHLICK, cubic);
    assert_true(cubic > 1 && phase_value(&printed, 0) < 0);
    double low = 0, high = 0.9999999;
    for (int i = 0; i < 60; i++) {
        Phase tried = alone(PHASE_SCHLICK, (low + high) / 2);
        double moments[PHASE_MOMENTS];
        phase_moments(&tried, moments);
        *(moments[1] < g ? &low : &high) = (low + high) / 2;
    }
    Phase right = alone(PHASE_SCHLICK, low);
    printf("mean cosine %g: k = %.6f, not %.6f\n", g, low, cubic);
    assert_near(mean_cosine(&right), g, 1e-3);
    char scene[256];
    VtsOptions o = options_of_size(4, 4);
    snprintf(scene, sizeof scene, "camera { location -4*z }\nvolume { box { -1, 1 } scattering 1 phase { schlick %.9g } }", cubic);
    assert_int_equal(bench_try(*state, &o, scene), VTS_ERROR_SCENE);
}

/* ---- light ---- */

/* A density file of one number everywhere, in cells of its own. */
static void write_cells(const Bench *b, int x, int y, int z, char path[256]) {
    snprintf(path, 256, "%s/cells.df3", b->folder);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    const int n[3] = {x, y, z};
    for (int k = 0; k < 3; k++) fputc(n[k] >> 8, f), fputc(n[k] & 255, f);
    for (int i = 0; i < x * y * z; i++) fputc(255, f);
    fclose(f);
}

enum { ROW = 800 };

/* A slab 0 < z < depth, lit straight along z, seen from the side through all of its width: green of a row of pixels along z. */
static void draw_from_side(const Bench *b, double depth, double width, const int cells[3], const char *matter, double out[ROW]) {
    char scene[1024], path[256];
    VtsOptions o = options_of_size(ROW, 1);
    write_cells(b, cells[0], cells[1], cells[2], path);
    snprintf(scene, sizeof scene,
             "global_settings { assumed_gamma 1 samples 1 }\ncamera { orthographic location <-5000, 0, %g> look_at <0, 0, %g> right %g*z up 1e-5*y }\n"
             "light_source { -10000*z, rgb 1 parallel point_at 0 }\n"
             "volume { density { df3 \"%s\" } box { <-%g, -%g, 0>, <%g, %g, %g> } %s }\n",
             depth / 2, depth / 2, depth, path, width, width, width, width, depth, matter);
    Picture p = bench_render(b, &o, scene);
    for (int i = 0; i < ROW; i++) out[i] = (double)pixel_at(&p, i, 0)[1];
    picture_free(&p);
    remove(path);
}

static double sum_of(const double *row, int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; i++) sum += row[i];
    return sum;
}

/* By free paths. */
static double sent_back(double depth) {
    RandomStream random = {7};
    int back = 0, all = 200000;
    for (int i = 0; i < all; i++) {
        double z = 0, mu = 1;
        for (;;) {
            z -= mu * log1p(-random_next_unit(&random));
            if (z < 0 || z > depth) break;
            mu = 2 * random_next_unit(&random) - 1;
        }
        back += z < 0;
    }
    return (double)back / all;
}

/* Sec. 4.2 asks at each step anew, with all of the way since the last scattering: the finer the steps, the more is sent back. What leaves is stored in the last voxel, and nothing
 * dims what is seen: the slab's upper half shows how much was sent back. */
static void interceptions_add_up(void **state) {
    static const struct {
        int cells;
        double back; /* by a walk through a slab that was programmed by itself */
    } steps[] = {{10, 0.750}, {40, 0.870}, {200, 0.940}};
    double row[ROW], right = sent_back(4);
    assert_near(right, 0.6909, 0.004);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(steps); i++) {
        char matter[200];
        snprintf(matter, sizeof matter, "scattering 1 phase { henyey_greenstein 1e-6 } method published rays 20000 step %.9g", 4.0 / steps[i].cells);
        draw_from_side(*state, 4, 200, (int[3]){1, 1, steps[i].cells}, matter, row);
        double back = sum_of(row, 0, ROW / 2) / sum_of(row, 0, ROW);
        printf("steps of %g: %.4f sent back (%.3f), by free paths %.4f\n", 4.0 / steps[i].cells, back, steps[i].back, right);
        assert_near(back, steps[i].back, 0.02);
    }
}

static double mean_depth(const double row[ROW], double depth) {
    double sum = 0;
    for (int i = 0; i < ROW - ROW / 8; i++) sum += row[i] * (i + 0.5) / ROW * depth;
    return sum / sum_of(row, 0, ROW - ROW / 8); /* what passes is stored in the last voxels */
}

static void free_paths_shrink_with_the_steps(void **state) {
    double row[ROW];
    draw_from_side(*state, 8, 200, (int[3]){1, 1, 80}, "scattering 1 method published rays 20000 step 0.1", row);
    double coarse = mean_depth(row, 8);
    draw_from_side(*state, 8, 200, (int[3]){1, 1, 800}, "scattering 1 method published rays 20000 step 0.01", row);
    double fine = mean_depth(row, 8);
    draw_from_side(*state, 8, 1e-3, (int[3]){1, 1, 8}, "scattering 1 orders 1", row);
    double right = mean_depth(row, 8), wanted = (1 - 8 * exp(-7.0)) / (1 - exp(-7.0));
    printf("first scattering after %.3f (steps of 0.1), %.3f (0.01), %.3f (free paths; %.3f)\n", coarse, fine, right, wanted);
    assert_near(coarse, 0.40, 0.055); /* sqrt(pi h/2); and it is stored in one of the two voxels between which it is */
    assert_near(fine, 0.125, 0.007);
    assert_near(right, wanted, 0.01);
}

/* Eq. 8 has the albedo, beside the absorption along the way of eqs. 7 and 9. Where hardly any light is lost, half as bright for as much absorption as scattering. */
static void albedo_counts_once(void **state) {
    static const char *const printed[] = {"scattering 0.01 method published rays 200000", "scattering 0.01 absorption 0.01 method published rays 200000"},
                             *const here[] = {"scattering 0.01 orders 1", "scattering 0.01 absorption 0.01 orders 1"};
    double row[ROW], seen[2], right[2];
    for (int i = 0; i < 2; i++) {
        draw_from_side(*state, 1, 1, (int[3]){1, 1, 8}, printed[i], row);
        seen[i] = sum_of(row, 0, ROW * 7 / 8);
        draw_from_side(*state, 1, 1, (int[3]){1, 1, 8}, here[i], row);
        right[i] = sum_of(row, 0, ROW * 7 / 8);
    }
    printf("albedo 1/2 against 1: printed %.3f, here %.3f\n", seen[1] / seen[0], right[1] / right[0]);
    assert_near(seen[1] / seen[0], 0.5, 0.06);
    assert_near(right[1] / right[0], 1, 0.02);
}

/* What is behind a white cloud: the second pass dims by absorption only. */
static void clouds_hide(void **state) {
    double seen[2];
    for (int i = 0; i < 2; i++) {
        char scene[512];
        VtsOptions o = options_of_size(4, 4);
        snprintf(scene, sizeof scene,
                 "global_settings { assumed_gamma 1 }\ncamera { orthographic location -9*z look_at 0 right x up y }\nbackground { rgb 1 }\n"
                 "volume { box { -2, 2 } scattering 1.25 %s }\n", i ? "" : "method published");
        Picture p = bench_render(*state, &o, scene);
        seen[i] = picture_mean(&p);
        picture_free(&p);
    }
    printf("behind depth 5: printed %.4f, here %.6f (%.6f)\n", seen[0], seen[1], exp(-5.0));
    assert_near(seen[0], 1, 0);
    assert_near(seen[1], exp(-5.0), 1e-6);
}

/* Radiance is added for each ray that meets a voxel, and for each voxel that is seen: the same matter in voxels an eighth as long is four times as bright, for a voxel has a quarter
 * of the face, gets an eighth of the rays, and eight are seen. What was scattered evenly is not scattered again: so many orders are as one. */
static void voxels_do_not_matter(void **state) {
    double row[ROW], seen[2], right[2], orders[2];
    for (int i = 0; i < 2; i++) {
        draw_from_side(*state, 1, 1, (int[3]){i ? 8 : 1, 1, 8}, "scattering 0.05 method published rays 100000", row);
        seen[i] = sum_of(row, 0, ROW * 7 / 8);
        draw_from_side(*state, 1, 1, (int[3]){i ? 8 : 1, 1, 8}, "scattering 0.05 orders 1", row);
        right[i] = sum_of(row, 0, ROW * 7 / 8);
        char matter[128];
        snprintf(matter, sizeof matter, "scattering 2 method published rays 4000 orders %s", i ? "all" : "1");
        draw_from_side(*state, 1, 1, (int[3]){1, 1, 8}, matter, row);
        orders[i] = sum_of(row, 0, ROW * 7 / 8);
    }
    printf("eight voxels for one: printed %.3f, here %.3f as bright; all orders as one: %.4f\n", seen[1] / seen[0], right[1] / right[0], orders[1] / orders[0]);
    assert_near(seen[1] / seen[0], 4, 0.1);
    assert_near(right[1] / right[0], 1, 1e-3);
    assert_near(orders[1] / orders[0], 1, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(murky_light_goes_forwards), cmocka_unit_test(better_fits_are_better),           cmocka_unit_test(names_and_inverses),
        cmocka_unit_test(no_cubic_gives_the_eccentricity), cmocka_unit_test(interceptions_add_up),       cmocka_unit_test(free_paths_shrink_with_the_steps),
        cmocka_unit_test(albedo_counts_once),        cmocka_unit_test(clouds_hide),                      cmocka_unit_test(voxels_do_not_matter),
    };
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
