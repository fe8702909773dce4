/* Levels of detail of functions that are sums: terms finer than what is looked at are replaced by their mean.
 *
 * With a width above a term's `full` less of it remains, beyond `gone` its mean alone: the sum is another function for each width,
 * that changes steadily with it. All functions here give bounds, values and gradients of that one. */
#ifndef VTS_TAPE_TAPE_DETAIL_H
#define VTS_TAPE_TAPE_DETAIL_H

#include "tape/affine.h"
#include "tape/tape_gradient.h"
#include "tape/tape_lanes.h"

/* Measures the terms of a sum of three inputs at places of the box. What is steady (its mean and deviation are the same in all parts of the
 * box) is gone where its waves are shorter than some 1.4 widths, but not before its range moves the zeros of what is coarser by less
 * than a width: by half of one at most, by an eighth as a rule. Everything else stays. Returns whether any term may go. */
bool tape_sum_measure(TapeSum *sum, const struct Interval *box, Arena *arena);

/* The scratch of all has scratch_size numbers. */
double tape_sum_value(const TapeSum *sum, Vec3 p, double width, double *scratch);
Dual tape_sum_gradient(const TapeSum *sum, Vec3 p, double width, Dual *scratch);
/* in[3], and the width as a form of the same line. */
AffineForm tape_sum_form(const TapeSum *sum, const AffineForm *in, AffineForm width, AffineForm *scratch);

/* How much of a term there is, in [0, 1]. */
static inline AffineForm tape_term_share(const TapeTerm *term, AffineForm width) {
    Interval range = affine_range(width);
    double by = 1 / (term->gone - term->full), least = (term->gone - range.high) * by, most = (term->gone - range.low) * by;
    if (range.low >= term->full && range.high <= term->gone)
        return affine_rounded((term->gone - width.centre) * by, -width.slope * by, width.error * by, 8, width.nan);
    least = bound_min(bound_max(least - 0x1p-48, 0), 1), most = bound_max(bound_min(most + 0x1p-48, 1), 0);
    return (AffineForm){(least + most) / 2, 0, round_up((most - least) / 2), range.nan};
}

#endif
