/* What lattice noises and their intervals share. */
#ifndef VTS_TAPE_NOISE_INTERVAL_H
#define VTS_TAPE_NOISE_INTERVAL_H

#include "tape/interval.h"
#include "tape/noise_lattice.h"

/* All values of a lattice noise in a box of places; `curve` rises on [0, 1], `most` bounds the noise's absolute value
 * everywhere. Boxes over more than a few cells get that bound. */
Interval lattice_over_box(LatticeFind *find, LatticeCurve *curve, double most, const Interval box[3]);

/* noise_worley() and noise_sparse_convolution() over boxes: of the balls around them. */
Interval interval_worley(const Interval box[3], int index);
/* Of the nodes number 0 … last, in one search. */
void interval_worley_nearest(const Interval box[3], int last, Interval *out);
Interval interval_sparse_convolution(const Interval box[3], int count);

#endif
