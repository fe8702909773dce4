#include "tape/tape_detail.h"

#include "base/random.h"
#include "tape/tape_affine.h"
#include "tape/tape_program.h"

#include <stdlib.h>

/* ---- the function of a width ---- */

static double share_of(const TapeTerm *term, double width) {
    double left = (term->gone - width) / (term->gone - term->full);
    return left >= 1 ? 1 : left > 0 ? left : 0;
}

double tape_sum_value(const TapeSum *sum, Vec3 p, double width, double *scratch) {
    double total = sum->constant, out;
    for (size_t k = 0; k < sum->count; k++) {
        const TapeTerm *term = &sum->terms[k];
        double share = term->gone < HUGE_VAL ? share_of(term, width) : 1;
        if (share > 0) {
            tape_eval(term->tape, (double[]){p.x, p.y, p.z}, &out, scratch);
            out *= term->scale;
        }
        total += share == 1 ? out : share > 0 ? term->mean + share * (out - term->mean) : term->mean;
    }
    return total;
}

Dual tape_sum_gradient(const TapeSum *sum, Vec3 p, double width, Dual *scratch) {
    Dual total = {sum->constant, {0, 0, 0}};
    for (size_t k = 0; k < sum->count; k++) {
        const TapeTerm *term = &sum->terms[k];
        double share = term->gone < HUGE_VAL ? share_of(term, width) : 1;
        if (!(share > 0)) {
            total.value += term->mean;
            continue;
        }
        Dual one = tape_eval_gradient(term->tape, p, scratch);
        total.value += term->mean * (1 - share) + share * term->scale * one.value;
        for (int i = 0; i < 3; i++) total.by[i] += share * term->scale * one.by[i];
    }
    return total;
}

AffineForm tape_sum_form(const TapeSum *sum, const AffineForm *in, AffineForm width, AffineForm *scratch) {
    AffineForm total = affine_point(sum->constant);
    double size = fabs(sum->constant), n = (double)sum->count + 2;
    double narrowest = affine_range(width).low, widest = affine_range(width).high;
    for (size_t k = 0; k < sum->count; k++) {
        const TapeTerm *term = &sum->terms[k];
        AffineForm one = affine_point(term->mean);
        if (narrowest < term->gone) {
            tape_eval_affine(term->tape, in, &one, scratch);
            one = affine_MUL(one, affine_point(term->scale));
            if (widest > term->full)
                one = affine_ADD(affine_point(term->mean), affine_MUL(tape_term_share(term, width), affine_SUB(one, affine_point(term->mean))));
        }
        total = affine_ADD(total, one);
        size += affine_size(one) + term->rounding;
    }
    /* Sums are added in several orders, with coefficients multiplied in another. */
    if (total.error < HUGE_VAL && size < HUGE_VAL) total.error = round_up(total.error + n * size * 0x1p-50);
    return total;
}

/* ---- what may go ---- */

enum { SAMPLES = 1024, PARTS = 8, OF_A_PART = SAMPLES / PARTS };

/* Lengths of waves, in widths, from which on a term fades; it is gone at half of that. */
static const double FADES = 1 / 0.35;
/* Parts of something steady differ by this much of its deviation at most: chance makes 1/√128 of it. */
static const double STEADY = 0.36;

typedef struct Measured {
    double mean, deviation, wave, range;
    bool steady;
    Vec3 *slopes; /* at the samples */
} Measured;

/* Places in the octants of the box in turn. */
static Vec3 sample_place(const Interval *box, uint64_t i) {
    double p[3];
    for (uint64_t k = 0; k < 3; k++) {
        double half = (double)(i >> k & 1) / 2, at = half + random_unit(random_hash(0x64657461696C, i, k, 0)) / 2;
        p[k] = box[k].low + at * (box[k].high - box[k].low);
    }
    return vec3(p[0], p[1], p[2]);
}

typedef struct Moments {
    double sum, squares;
} Moments;

static double deviation_of(Moments m, double n) { return sqrt(double_max(m.squares / n - m.sum / n * (m.sum / n), 0)); }

static Measured measure(const TapeTerm *term, const Interval *box, Arena *arena) {
    Measured out = {.slopes = arena_new_array(arena, Vec3, SAMPLES)};
    Moments all = {0, 0}, parts[PARTS] = {{0, 0}};
    ArenaMark mark = arena_mark(arena);
    Dual *scratch = arena_new_array(arena, Dual, tape_scratch_size(term->tape));
    double squares = 0;
    for (uint64_t i = 0; i < SAMPLES; i++) {
        Dual d = tape_eval_gradient(term->tape, sample_place(box, i), scratch);
        double value = d.value * term->scale;
        out.slopes[i] = vec3_scale(vec3(d.by[0], d.by[1], d.by[2]), term->scale);
        squares += vec3_length_squared(out.slopes[i]);
        all.sum += value, parts[i % PARTS].sum += value;
        all.squares += value * value, parts[i % PARTS].squares += value * value;
    }
    arena_reset_to(arena, mark);
    out.mean = all.sum / SAMPLES;
    out.deviation = deviation_of(all, SAMPLES);
    out.wave = squares > 0 ? 2 * VTS_PI * out.deviation / sqrt(squares / SAMPLES) : HUGE_VAL;
    out.range = bound_max(term->high - out.mean, out.mean - term->low);
    out.steady = isfinite(out.mean) && isfinite(out.range) && out.wave > 0 && out.deviation > 0;
    for (int k = 0; k < PARTS; k++) {
        double own = deviation_of(parts[k], OF_A_PART);
        out.steady &= fabs(parts[k].sum / OF_A_PART - out.mean) < STEADY * out.deviation;
        out.steady &= own < 1.5 * out.deviation && own > out.deviation / 1.5;
    }
    return out;
}

typedef struct ByWave {
    double wave;
    size_t term;
} ByWave;

static int longer_first(const void *a, const void *b) {
    double x = ((const ByWave *)a)->wave, y = ((const ByWave *)b)->wave;
    return x > y ? -1 : x < y ? 1 : 0;
}

static int smaller_first(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y ? 1 : 0;
}

/* How steep the sum of some terms is in most places: in all but the flattest quarter. */
static double steepness(const Vec3 *slopes, double *lengths) {
    for (int i = 0; i < SAMPLES; i++) lengths[i] = vec3_length(slopes[i]);
    qsort(lengths, SAMPLES, sizeof *lengths, smaller_first);
    return lengths[SAMPLES / 4];
}

bool tape_sum_measure(TapeSum *sum, const Interval *box, Arena *arena) {
    ArenaMark mark = arena_mark(arena);
    size_t count = sum->count;
    Measured *measured = arena_new_array(arena, Measured, count);
    ByWave *order = arena_new_array(arena, ByWave, count);
    Vec3 *slopes = arena_new_array(arena, Vec3, SAMPLES);
    double *lengths = arena_new_array(arena, double, SAMPLES);
    bool any = false;
    for (size_t k = 0; k < count && count > 1; k++) {
        measured[k] = measure(&sum->terms[k], box, arena);
        order[k] = (ByWave){measured[k].steady ? measured[k].wave : HUGE_VAL, k};
    }
    qsort(order, count > 1 ? count : 0, sizeof *order, longer_first);
    for (size_t i = 0; i < count && count > 1; i++) {
        TapeTerm *term = &sum->terms[order[i].term];
        const Measured *m = &measured[order[i].term];
        double steep = i > 0 && m->steady ? steepness(slopes, lengths) : 0;
        if (steep > 0 && isfinite(steep)) {
            term->mean = m->mean;
            term->full = bound_max(m->wave / FADES, m->range / steep);
            term->gone = 2 * term->full;
            any = true;
        }
        for (int k = 0; k < SAMPLES; k++) slopes[k] = vec3_add(slopes[k], m->slopes[k]);
    }
    arena_reset_to(arena, mark);
    return any;
}
