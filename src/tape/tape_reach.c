#include "tape/tape_reach.h"

#include "base/random.h"
#include "tape/tape_interval.h"
#include "tape/tape_lanes.h"

enum { BATCHES = 2, SEED = 0x72656163 };

static double random_of(uint64_t sample, uint64_t which) { return random_unit(random_hash(SEED, sample, which, 0)); }

/* Pieces of a length, their middles anywhere in the box, in any direction. */
static void place_batch(const Interval *box, double length, uint64_t batch, AffineLanes in[3]) {
    for (int l = 0; l < AFFINE_LANES; l++) {
        uint64_t sample = batch * AFFINE_LANES + (uint64_t)l;
        double z = 2 * random_of(sample, 0) - 1, around = 2 * VTS_PI * random_of(sample, 1), flat = sqrt(1 - z * z);
        const double way[3] = {flat * cos(around), flat * sin(around), z};
        for (int k = 0; k < 3; k++) {
            in[k].centre[l] = box[k].low + random_of(sample, 2 + (uint64_t)k) * (box[k].high - box[k].low);
            in[k].slope[l] = way[k] * length / 2, in[k].error[l] = 0;
        }
    }
}

/* Adds a term, which its range bounds where its form tells less. */
static void add_term(const TapeTerm *term, const AffineLanes *form, double *slope, double *error) {
    double most = term->half / fabs(term->scale);
    for (int l = 0; l < AFFINE_LANES; l++) {
        bool tells = fabs(form->slope[l]) + form->error[l] < most;
        slope[l] += tells ? form->slope[l] * term->scale : 0;
        error[l] += tells ? form->error[l] * fabs(term->scale) : term->half;
    }
}

/* HUGE_VAL: none is known. */
static double mean_radius(const TapeSum *sum, const Interval *box, double length, AffineLanes *scratch) {
    double total = 0, known = 0;
    for (uint64_t b = 0; b < BATCHES; b++) {
        double slope[AFFINE_LANES] = {0}, error[AFFINE_LANES] = {0};
        AffineLanes in[3], form;
        place_batch(box, length, b, in);
        for (size_t k = 0; k < sum->count; k++) {
            tape_eval_lanes(sum->terms[k].tape, in, &form, scratch);
            add_term(&sum->terms[k], &form, slope, error);
        }
        for (int l = 0; l < AFFINE_LANES; l++) {
            double radius = fabs(slope[l]) + error[l];
            if (radius < HUGE_VAL) total += radius, known++;
        }
    }
    return known > 0 ? total / known : HUGE_VAL;
}

TapeReach tape_reach_of(const TapeSum *sum, const Interval *box, Arena *arena) {
    TapeReach reach = {.length = {0}};
    double squares = 0;
    for (int k = 0; k < 3; k++) squares += (box[k].high - box[k].low) * (box[k].high - box[k].low);
    ArenaMark mark = arena_mark(arena);
    AffineLanes *scratch = arena_new_array(arena, AffineLanes, sum->scratch_size);
    for (int k = TAPE_REACH_LENGTHS; k-- > 0;) {
        double length = ldexp(sqrt(squares), -k), shorter = reach.radius[k + 1], own = mean_radius(sum, box, length, scratch);
        reach.length[k] = length, reach.radius[k] = own < HUGE_VAL ? bound_max(own, shorter) : shorter;
        reach.per_radius[k] = reach.radius[k] > shorter ? (length - reach.length[k + 1]) / (reach.radius[k] - shorter) : 0;
    }
    arena_reset_to(arena, mark);
    return reach;
}

double tape_reach_length(const TapeReach *reach, double radius, int *at) {
    int k = *at;
    while (k > 0 && reach->radius[k] <= radius) k--;
    while (k < TAPE_REACH_LENGTHS - 1 && reach->radius[k + 1] > radius) k++;
    *at = k;
    if (!(radius < reach->radius[k])) return reach->length[k];
    return reach->length[k + 1] + (radius - reach->radius[k + 1]) * reach->per_radius[k];
}
