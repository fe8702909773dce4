#include "render/error_laws.h"

#include <string.h>

/* Against random samples, of which n leave 1/n of the variance: what n of a straight edge leave (measured: 0.40 at 5, falling as 1/√n). */
static const double EDGE_GAIN = 0.4;
/* Whoever stops where errors seem to be small stops more often where they only seem so: what was found true of the sum of squares. */
static const double CAUTION = 1.8;
/* Of that, what is not true of tiles that end for want of samples. */
static const double UNSTOPPED = 1.2;
/* What is known of a law by itself counts as much as so many pixels. */
static const double KNOWN = 4, KNOWN_OF_PATTERNS = 0.5;
/* Quiet is what is thought to have so much of the squared error that is accepted; a contrast of half that makes no difference. */
static const double QUIET = 0.25;
/* The squared error of a mean, against the squared difference from that of twice as many samples. */
static const double DOUBLING_TO_ERROR = 2;
/* What is missed by some samples is missed by twice as many, too: about so much of its square. */
static const double MISSED_AGAIN = 0.5;

/* Of what is expected of a contrast the part that was found where it was as large, or next larger. What was missed of quiet pixels; before
 * much was found, about what was of those with half as many samples. */
static void tell(ErrorLaws *laws) {
    double ratio = 1, missed = 0;
    for (int k = 0; k < ERROR_CLASSES; k++)
        laws->ratios[k] = ratio = learned_ratio(&laws->contrasts[k], k % ERROR_OF_PATTERNS ? ratio : 1, k < ERROR_OF_PATTERNS ? KNOWN : KNOWN_OF_PATTERNS);
    for (int k = 0; k < 2; k++) laws->edge_ratios[k] = learned_ratio(&laws->edges[k], 1, KNOWN);
    for (int k = 0; k < QUIET_CLASSES; k++) laws->missed[k] = missed = learned_mean(&laws->quiet[k], MISSED_AGAIN * missed);
}

void error_laws_begin(ErrorLaws *laws, double accepted) {
    *laws = (ErrorLaws){.accepted = accepted};
    tell(laws);
}

bool error_counts(const ErrorLaws *laws, float contrast) { return CAUTION * (double)contrast > QUIET / 2 * laws->accepted; }

static double variance(const Cell *cell) {
    double n = cell_count(cell);
    return cell_variance(cell) + (double)cell->contrast / (n * n);
}

static double error_of_many(const ErrorLaws *laws, const Cell *cell) {
    int count = cell_count(cell);
    double ratio = learned_ratio(&laws->levels[learned_level(count)], EDGE_GAIN * sqrt(5.0 / count), KNOWN);
    return CAUTION * variance(cell) * ratio / count;
}

/* As the pixel by itself seems; 0 of what cannot be refined. */
static double error_alone(const ErrorLaws *laws, const Cell *cell) {
    if (!cell->refinable) return 0;
    if (cell->edged) return CAUTION * (double)cell->edge_error * laws->edge_ratios[cell->traced] + (double)cell->doubt;
    return cell->net && cell_count(cell) > 1 ? error_of_many(laws, cell) : CAUTION * (double)cell->contrast * laws->ratios[cell->class] + (double)cell->doubt;
}

int error_quiet_class(const Cell *cell) { return cell->net ? 1 + learned_level(cell_count(cell)) : 0; }

/* Whether a pixel seems to need nothing; `alone`: error_alone(), not looked at of pixels that have more than their middle. */
static bool is_quiet(const ErrorLaws *laws, const Cell *cell, double alone) {
    double seen = cell->net ? CAUTION * cell_variance(cell) / cell_count(cell) : alone;
    return cell->refinable && seen < QUIET * laws->accepted;
}

bool error_net_is_quiet(const ErrorLaws *laws, const Cell *cell) { return is_quiet(laws, cell, 0); }

double error_expected(const ErrorLaws *laws, const Cell *cell) {
    const double alone = error_alone(laws, cell);
    return is_quiet(laws, cell, alone) ? fmax(alone, laws->missed[error_quiet_class(cell)]) : alone;
}

/* What an edge differs from what better ones, or nets, tell later; these have errors of their own. */
static void learn_edge(ErrorLaws *laws, const Cell *before, const Cell *cell) {
    const double off = (double)light_mean_square(vec3f_sub(before->mean, cell->mean));
    const double own = cell->edged ? (double)cell->edge_error : error_of_many(laws, cell) / CAUTION;
    learn(&laws->edges[before->traced], (double)before->edge_error, fmax(off - own, 0));
}

void error_learn(ErrorLaws *laws, const Cell *before, const Cell *cell) {
    const int count = cell_count(cell);
    if (is_quiet(laws, before, error_alone(laws, before)))
        learn(&laws->quiet[error_quiet_class(before)], 0, (before->net ? DOUBLING_TO_ERROR : 1) * (double)light_mean_square(vec3f_sub(before->mean, cell->mean)));
    if (before->edged) learn_edge(laws, before, cell);
    else if (before->net == 0 && cell->centred)
        learn(&laws->contrasts[cell->class], (double)cell->contrast, (double)light_mean_square(vec3f_sub(cell->first, cell->mean)));
    if (!cell->edged) learn(&laws->levels[learned_level(count)], variance(cell) / count, cell_halves_error(cell));
    tell(laws);
}

double error_of_all(double sum) { return sum / CAUTION; }
double error_of_stopped(double sum) { return sum / UNSTOPPED; }
