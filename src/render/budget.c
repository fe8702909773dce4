#include "render/budget.h"

#include <math.h>

/* How steep laws through two noisy figures may be. */
static const double MOST_RISE = 4, LEAST_RISE = 0.25, MOST_FALL = 4;
/* Prices, squared errors for a second, are sought between these, in so many halvings of their logarithms. */
static const double DEAREST = 1e30, CHEAPEST = 1e-30;
enum { HALVINGS = 100 };

static double within(double low, double x, double high) { return x < low ? low : x > high ? high : x; }

double budget_error(const BudgetLaw *law, double slack) { return law->error * pow(slack, law->rise); }
double budget_seconds(const BudgetLaw *law, double slack) { return law->seconds * pow(slack, -law->fall); }

/* Where a second more takes as much from the squared error as the price: fall·seconds·s^-fall · price = 2·rise·error²·s^(2·rise). */
static double slack_at(const BudgetLaw *law, double price) {
    double worth = 2 * law->rise * law->error * law->error, cost = law->fall * law->seconds * price;
    if (!(worth > 0)) return law->most;
    if (!(cost > 0)) return law->least;
    return within(law->least, pow(cost / worth, 1 / (law->fall + 2 * law->rise)), law->most);
}

static double squares_at(const BudgetLaw *laws, int count, double price) {
    double sum = 0;
    for (int i = 0; i < count; i++) {
        double error = budget_error(&laws[i], slack_at(&laws[i], price));
        sum += error * error;
    }
    return sum;
}

void budget_split(const BudgetLaw *laws, int count, double accepted, double *slack) {
    double low = CHEAPEST, high = DEAREST;
    for (int i = 0; i < HALVINGS; i++) {
        double price = sqrt(low) * sqrt(high);
        if (squares_at(laws, count, price) > accepted * accepted) high = price;
        else low = price;
    }
    for (int i = 0; i < count; i++) slack[i] = slack_at(&laws[i], low);
}

BudgetLaw budget_law(const double errors[2], const double seconds[2], double other) {
    BudgetLaw law = {errors[0], 1, seconds[0], 0, 1, 1};
    if (errors[0] > 0 && errors[1] > 0)
        law.rise = within(LEAST_RISE, log(errors[1] / errors[0]) / log(other), MOST_RISE);
    if (seconds[0] > 0 && seconds[1] > 0)
        law.fall = within(0, -log(seconds[1] / seconds[0]) / log(other), MOST_FALL);
    return law;
}

void budget_begin(Budget *b) {
    *b = (Budget){.known = {false}};
    for (int i = 0; i < BUDGET_STAGES; i++) b->slack[i] = 1;
}

double budget_left(const Budget *b, double accepted) {
    double others = 0;
    for (int i = 0; i < BUDGET_STAGES; i++) {
        double error = i != BUDGET_NOISE && b->known[i] ? budget_error(&b->laws[i], b->slack[i]) / accepted : 0;
        others += error * error;
    }
    return sqrt(fmax(1 - others, BUDGET_LEAST_NOISE * BUDGET_LEAST_NOISE));
}
