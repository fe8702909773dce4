/* Who gets how many samples: against closed forms, and against pixels whose noise is known. */
#include "base/random.h"
#include "render/beam_allot.h"

#include <math.h>
#include <stdarg.h>
#include <setjmp.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static double sum_of(const int *counts, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += counts[i];
    return sum;
}

/* Errors at one worth: error/n is the same for all that are within bounds, and no move of samples from one to another lessens the sum. */
static void worth_shares_out_best(void **state) {
    (void)state;
    const AllotPlan plan = {.first = 2, .most = 4096};
    const double noises[] = {0.01, 0.1, 1};
    double q = log(allot_noise(1, 10)) / log(10), error = 1e-3, worth = allot_worth(noises, 3, &plan, error, 1e9), n[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        n[i] = pow(noises[i] / worth, 1 / (1 + q));
        sum += noises[i] * pow(n[i], -q);
    }
    assert_true(fabs(sum / 3 - error) < 1e-6 * error);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double moved = sum - noises[i] * pow(n[i], -q) - noises[k] * pow(n[k], -q);
            moved += noises[i] * pow(n[i] * 1.1, -q) + noises[k] * pow(n[k] - 0.1 * n[i], -q);
            if (i != k && n[k] > 0.1 * n[i]) assert_true(moved > sum);
        }
}

static void worth_keeps_to_the_mean(void **state) {
    (void)state;
    const AllotPlan plan = {.first = 1, .most = 100000};
    const double noises[] = {0.5, 1, 2, 4};
    double q = log(allot_noise(1, 10)) / log(10), worth = allot_worth(noises, 4, &plan, 1e-12, 64), samples = 0;
    for (int i = 0; i < 4; i++) samples += pow(noises[i] / worth, 1 / (1 + q));
    assert_true(fabs(samples / 4 - 64) < 1e-3);
    assert_true(fabs(allot_worth_noisier(worth, 2) / (worth * pow(4, 1 + 1 / q)) - 1) < 1e-9);
}

/* Nothing is noisy, nothing is finite, nothing is there. */
static void worth_of_nothing_is_a_number(void **state) {
    (void)state;
    const AllotPlan plan = {.first = 4, .most = 64};
    const double nothing[] = {0, 0}, wild[] = {INFINITY, NAN};
    double of[] = {allot_worth(nothing, 2, &plan, 1e-4, 64), allot_worth(nothing, 0, &plan, 1e-4, 64), allot_worth(wild, 2, &plan, 1e-4, 64)};
    for (size_t i = 0; i < 3; i++) assert_true(of[i] > 0 && isfinite(of[i]));
}

/* Pixels of random samples with a deviation each, drawn as plans ask: how far their means are off, and what that took. */
typedef struct Trial {
    double wrong, told, samples;
} Trial;

static double gauss(uint64_t bits) { return sqrt(-2 * log(random_unit(bits) + 1e-300)) * cos(6.283185307179586 * random_unit(random_mix(bits))); }

static Trial draw(const AllotPlan *plan, const double *deviations, int columns, int rows, uint64_t seed) {
    static Allotment a;
    static float apart[ALLOT_PIXELS];
    static double sums[ALLOT_PIXELS];
    int pixels = columns * rows;
    for (int i = 0; i < pixels; i++) sums[i] = 0;
    allot_begin(&a, plan, columns, rows, 32);
    do {
        for (int i = 0; i < pixels; i++) {
            double odd = 0, even = 0;
            int n = a.asked[i], odds = n / 2;
            for (int k = 0; k < n; k++) *(k & 1 ? &odd : &even) += deviations[i] * gauss(random_hash((uint64_t)i, (uint64_t)(a.taken[i] + k), 0, seed));
            sums[i] += odd + even;
            apart[i] = odds ? (float)pow(odd / odds - even / (n - odds), 2) : 0;
        }
    } while (allot_next(&a, plan, apart, 32, 0));
    Trial t = {0, allot_error(&a), sum_of(a.taken, pixels)};
    for (int i = 0; i < pixels; i++) t.wrong += pow(sums[i] / a.taken[i], 2) / pixels;
    return t;
}

/* Half of the tile is a hundred times as noisy: at the same number of samples the error is less than when all have as many, and what is told of it is near. */
static void samples_go_where_noise_is(void **state) {
    (void)state;
    static double deviations[ALLOT_PIXELS];
    for (int i = 0; i < ALLOT_PIXELS; i++) deviations[i] = i % 32 < 16 ? 0.1 : 0.01;
    const AllotPlan plan = {.first = 4, .most = 256, .worth = 1e-6};
    double wrong = 0, even = 0, told = 0;
    for (uint64_t seed = 0; seed < 8; seed++) {
        Trial t = draw(&plan, deviations, 32, 32, seed);
        int each = (int)(t.samples / ALLOT_PIXELS);
        const AllotPlan same = {.first = each, .most = each};
        Trial u = draw(&same, deviations, 32, 32, seed);
        assert_true(u.samples == each * ALLOT_PIXELS);
        wrong += t.wrong, told += t.told, even += u.wrong;
    }
    assert_true(wrong < 0.7 * even); /* for noise that falls as 1/n the best is (1 + 0.1)²/(2·1.01) = 0.599 of it; plans are made for edges, too */
    assert_in_range((uint64_t)(1000 * told / wrong), 250, 1000); /* random samples are noisier than those of edges: what is told is of these */
}

static void bounds_are_kept(void **state) {
    (void)state;
    static double deviations[ALLOT_PIXELS];
    for (int i = 0; i < ALLOT_PIXELS; i++) deviations[i] = i % 7 ? 0 : 1e6;
    const AllotPlan plan = {.first = 3, .most = 50, .worth = 1e-12};
    static Allotment a;
    static float apart[ALLOT_PIXELS];
    allot_begin(&a, &plan, 31, 5, 32);
    int passes = 0;
    do {
        double room = 0;
        for (int i = 0; i < 155; i++) {
            apart[i] = (float)deviations[i];
            room += a.asked[i];
            assert_true(a.asked[i] >= 0 && a.asked[i] != 1);
        }
        assert_true(room <= 32 * 155);
        assert_true(++passes < 40);
    } while (allot_next(&a, &plan, apart, 32, 0));
    for (int i = 0; i < 155; i++) assert_true(a.taken[i] >= 3 && a.taken[i] <= 50);
    assert_true(a.taken[7] > 40);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(worth_shares_out_best), cmocka_unit_test(worth_keeps_to_the_mean), cmocka_unit_test(worth_of_nothing_is_a_number),
        cmocka_unit_test(samples_go_where_noise_is), cmocka_unit_test(bounds_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
