/* How the accepted error is shared out: against a search over all shares. */
#include "render/budget.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static double seconds_of(const BudgetLaw *laws, int count, const double *slack) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += budget_seconds(&laws[i], slack[i]);
    return sum;
}

static double error_of(const BudgetLaw *laws, int count, const double *slack) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += budget_error(&laws[i], slack[i]) * budget_error(&laws[i], slack[i]);
    return sqrt(sum);
}

/* Two stages: the second gets what the first leaves. */
static double least_seconds(const BudgetLaw laws[2], double accepted) {
    double least = INFINITY;
    for (int i = 1; i < 20000; i++) {
        double share = accepted * i / 20000, rest = sqrt(accepted * accepted - share * share);
        double slack[2] = {pow(share / laws[0].error, 1 / laws[0].rise), pow(rest / laws[1].error, 1 / laws[1].rise)};
        if (slack[0] < laws[0].least || slack[0] > laws[0].most || slack[1] < laws[1].least || slack[1] > laws[1].most) continue;
        least = fmin(least, seconds_of(laws, 2, slack));
    }
    return least;
}

static void no_other_shares_take_less_time(void **state) {
    static const BudgetLaw laws[][2] = {
        {{.004, 1, 1, 1.333, 1e-3, 1e3}, {.004, 1, 1, 1.333, 1e-3, 1e3}},
        {{.004, 1, 30, 1.333, 1e-3, 1e3}, {.001, 2, 1, 0.5, 1e-3, 1e3}},
        {{.1, 1, 1, 2.3, 1e-3, 1e3}, {.002, 0.5, 8, 1.7, 1e-3, 1e3}},
        {{.004, 1, 1, 1.333, 0.5, 2}, {.0001, 1, 5, 1, 0.25, 8}},
    };
    (void)state;
    for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
        double slack[2];
        budget_split(laws[k], 2, .004, slack);
        double seconds = seconds_of(laws[k], 2, slack), least = least_seconds(laws[k], .004), error = error_of(laws[k], 2, slack);
        print_message("slacks %.4g %.4g, error %.6f, seconds %.5g, least of a search %.5g\n", slack[0], slack[1], error, seconds, least);
        assert_true(error <= .004 * (1 + 1e-9));
        assert_true(seconds <= least * (1 + 1e-6));
    }
}

static void equal_stages_get_equal_shares(void **state) {
    const BudgetLaw law = {.01, 1, 2, 1.5, 1e-6, 1e6}, laws[4] = {law, law, law, law};
    double slack[4];
    (void)state;
    budget_split(laws, 4, .004, slack);
    for (int i = 0; i < 4; i++) assert_true(fabs(slack[i] - 0.2) < 1e-9); /* .004/2 of .01 */
}

/* What cannot be had is as good as it gets, what costs nothing is had, and what makes no error is let go. */
static void limits_hold(void **state) {
    const BudgetLaw laws[3] = {{1, 1, 1, 1, .5, 2}, {.01, 1, 0, 0, .25, 8}, {0, 1, 1, 1, .25, 8}};
    double slack[3];
    (void)state;
    budget_split(laws, 3, .004, slack);
    assert_true(slack[0] == .5 && slack[1] == .25 && slack[2] == 8);
    budget_split(laws, 3, 1e6, slack);
    assert_true(slack[0] == 2);
}

static void laws_go_through_what_was_found(void **state) {
    BudgetLaw law = budget_law((double[]){.002, .008}, (double[]){3, 1.5}, 4);
    (void)state;
    assert_true(fabs(budget_error(&law, 4) - .008) < 1e-12 && fabs(budget_seconds(&law, 4) - 1.5) < 1e-12);
    law = budget_law((double[]){0, 0}, (double[]){0, 0}, 4);
    assert_true(law.error == 0 && law.seconds == 0 && law.fall == 0 && law.rise > 0);
    law = budget_law((double[]){.002, .001}, (double[]){1, 2}, 4); /* chance */
    assert_true(law.rise > 0 && law.fall == 0);
}

static void noise_gets_what_others_leave(void **state) {
    Budget b;
    (void)state;
    budget_begin(&b);
    assert_true(budget_left(&b, .004) == 1);
    b.known[BUDGET_MEDIA] = true, b.laws[BUDGET_MEDIA] = (BudgetLaw){.0012, 1, 1, 1, .25, 8}, b.slack[BUDGET_MEDIA] = 2;
    assert_true(fabs(budget_left(&b, .004) - 0.8) < 1e-12);
    b.slack[BUDGET_MEDIA] = 100;
    assert_true(budget_left(&b, .004) == BUDGET_LEAST_NOISE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_other_shares_take_less_time), cmocka_unit_test(equal_stages_get_equal_shares),
        cmocka_unit_test(limits_hold),                    cmocka_unit_test(laws_go_through_what_was_found),
        cmocka_unit_test(noise_gets_what_others_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
