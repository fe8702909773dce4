#include "render/beam_allot.h"

#include <math.h>

/* Between what is random and straight edges; measured on lawns and trees: 1.44 and 1.38. */
static const double FALL = 1.3;
/* The mean square of the error of a mean, from how far the means of its halves are apart: 1/4 if they were random. Measured: test_analytic_sessions. */
static const double HALVES_TO_SQUARE = 0.42 * 0.42;
/* What a pixel's neighbours tell counts as much as so many samples of its own: a few may have missed what is thin. */
static const double NEIGHBOURS = 12;
/* No pass takes a pixel farther than this, against what it has: few samples do not tell enough for more. But where the pass itself takes longer than its samples, another would be
 * dearer than some that are too many. */
enum { GROWTH = 4, DEAR_GROWTH = 12 };
/* Nor is one made for less than these parts of what a pixel has, of what all have taken, or of what passes have taken besides: an error that was asked for is kept, dear as they are. */
static const double LEAST_PART = 0.25, LEAST_PASS = 0.04, LEAST_PAID = 0.006;
enum { HALVINGS = 60 };

double allot_noise(double error, double n) { return error * pow(n, FALL); }

static double samples_at(double noise, const AllotPlan *plan, double worth) {
    if (!(noise > 0)) return plan->first;
    return double_clamp(pow(noise / worth, 1 / (1 + FALL)), plan->first, plan->most);
}

void allot_begin(Allotment *a, const AllotPlan *plan, int columns, int rows, int most_in_pass) {
    *a = (Allotment){.columns = columns, .rows = rows};
    for (int i = 0; i < columns * rows; i++) a->asked[i] = int_min(plan->first, most_in_pass);
}

static void learn(Allotment *a, int i, double apart) {
    int n = a->asked[i], all = a->taken[i] + n;
    if (n < 2 || !(apart >= 0)) return; /* of what is no number nothing is told */
    float part = (float)n / (float)all;
    a->noise[i] = a->noise[i] * (1 - part) + (float)allot_noise(HALVES_TO_SQUARE * apart, n) * part;
}

/* Of a pixel, by its samples and by its neighbours'. */
static double noise_around(const Allotment *a, int i) {
    int column = i % a->columns, row = i / a->columns, count = 0;
    double sum = 0;
    for (int y = int_max(row - 1, 0); y <= int_min(row + 1, a->rows - 1); y++)
        for (int x = int_max(column - 1, 0); x <= int_min(column + 1, a->columns - 1); x++, count++)
            sum += (double)a->noise[y * a->columns + x];
    return (a->taken[i] * (double)a->noise[i] + NEIGHBOURS * sum / count) / (a->taken[i] + NEIGHBOURS);
}

static int ask(const Allotment *a, const AllotPlan *plan, int i, int growth) {
    if (a->taken[i] < plan->first) return plan->first - a->taken[i];
    if (!(plan->worth > 0)) return 0;
    double wanted = samples_at(noise_around(a, i), plan, plan->worth);
    int more = int_min((int)ceil(wanted) - a->taken[i], (growth - 1) * a->taken[i]);
    return more >= 2 && more >= LEAST_PART * a->taken[i] ? more : 0;
}

static double ask_all(Allotment *a, const AllotPlan *plan, int growth) {
    double asked = 0;
    for (int i = 0; i < a->columns * a->rows; i++) asked += a->asked[i] = ask(a, plan, i, growth);
    return asked;
}

bool allot_next(Allotment *a, const AllotPlan *plan, const float *apart, int most_in_pass, double price) {
    int pixels = a->columns * a->rows;
    double taken = 0, room = (double)most_in_pass * pixels;
    a->paid += price;
    for (int i = 0; i < pixels; i++) {
        learn(a, i, (double)apart[i]);
        taken += a->taken[i] += a->asked[i];
    }
    double asked = ask_all(a, plan, GROWTH);
    if (asked < price) asked = ask_all(a, plan, DEAR_GROWTH);
    if (!(asked >= LEAST_PASS * taken + LEAST_PAID * a->paid) || !(asked > 0)) return false;
    for (int i = 0; i < pixels && asked > room; i++) {
        a->asked[i] = (int)(a->asked[i] * (room / asked));
        if (a->asked[i] < 2) a->asked[i] = 0;
    }
    return true;
}

double allot_error_of(const Allotment *a, int i) { return a->taken[i] ? noise_around(a, i) * pow(a->taken[i], -FALL) : 0; }

double allot_error(const Allotment *a) {
    int pixels = a->columns * a->rows;
    double sum = 0;
    for (int i = 0; i < pixels; i++)
        if (a->taken[i]) sum += (double)a->noise[i] * pow(a->taken[i], -FALL);
    return pixels ? sum / pixels : 0;
}

double allot_mean_samples(const double *noises, int count, const AllotPlan *plan) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += samples_at(noises[i], plan, plan->worth);
    return count ? sum / count : 0;
}

double allot_mean_square(const double *noises, int count, const AllotPlan *plan) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += noises[i] * pow(samples_at(noises[i], plan, plan->worth), -FALL);
    return count ? sum / count : 0;
}

double allot_worth(const double *noises, int count, const AllotPlan *plan, double error, double mean) {
    double least = -45, most = 5; /* natural logarithms of what it may be */
    AllotPlan tried = *plan;
    for (int k = 0; k < HALVINGS; k++) {
        double middle = (least + most) / 2;
        tried.worth = exp(middle);
        if (allot_mean_square(noises, count, &tried) > error && allot_mean_samples(noises, count, &tried) < mean) most = middle;
        else least = middle;
    }
    return exp(least);
}

/* error = noise·n^−q and worth = error/n together: the worth goes as the error to the power 1 + 1/q. */
double allot_worth_noisier(double worth, double factor) { return worth * pow(factor * factor, 1 + 1 / FALL); }
