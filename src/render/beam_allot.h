/* How many samples each pixel of a tile gets.
 *
 * The mean square of a pixel's error falls with its n samples as noise·n^−q: what is small beside a pixel is random (q = 1), straight edges that low
 * discrepancy sums are better off. A picture has the least error for its time where a further sample would take as much from the sum of squares
 * wherever it were taken, that is where noise·n^−q/n is the same in all pixels: `worth`. What is noisy gets more samples, but not so many that all pixels were equally wrong: on
 * grass that would take half as long again as it does, and as many everywhere three times as long. */
#ifndef VTS_RENDER_BEAM_ALLOT_H
#define VTS_RENDER_BEAM_ALLOT_H

#include "render/film.h"

enum { ALLOT_PIXELS = FILM_TILE * FILM_TILE };

/* Samples a pixel: `first` of them everywhere, then up to `most`, as worth tells (0: no more than the first). */
typedef struct AllotPlan {
    int first, most;
    double worth;
} AllotPlan;

/* A tile's pixels, row by row. Zeroed where the tile has none. */
typedef struct Allotment {
    int columns, rows;
    int taken[ALLOT_PIXELS]; /* samples, before the pass that is being made */
    int asked[ALLOT_PIXELS]; /* in that pass */
    double paid;             /* what the passes have taken besides, in samples */
    float noise[ALLOT_PIXELS]; /* as the passes have told, the mean of them weighed by their samples */
} Allotment;

/* The first pass, of `most_in_pass` samples a pixel at most. */
void allot_begin(Allotment *allotment, const AllotPlan *plan, int columns, int rows, int most_in_pass);
/* Ends a pass: `apart` has for each pixel the square of how far the means of its odd and even samples are apart. Lays the next one, of
 * most_in_pass samples a pixel at most, on the average; false when there is none. `price` is what a pass takes however few its samples are, in samples: where that is
 * much, fewer passes are made of more samples each. */
bool allot_next(Allotment *allotment, const AllotPlan *plan, const float *apart, int most_in_pass, double price);
/* The mean square of the error that is to be expected of pixel i of the tile, by its samples and its neighbours'; 0 where it has none. */
double allot_error_of(const Allotment *allotment, int i);
/* That of a pixel on the average, with the samples that it has. */
double allot_error(const Allotment *allotment);
/* The noise of one sample of pixels whose mean square is `error` with n of them. */
double allot_noise(double error, double n);
/* The worth at which pixels of these noises, `count` of them for all of the picture's, come to the mean square `error`; or to `mean` samples if that takes more.
 * Above 0. */
double allot_worth(const double *noises, int count, const AllotPlan *plan, double error, double mean);
/* That for errors which are larger by `factor`. */
double allot_worth_noisier(double worth, double factor);
/* How many samples pixels of these noises get by the plan, on the mean; and the mean square of the error that is left to them. */
double allot_mean_samples(const double *noises, int count, const AllotPlan *plan);
double allot_mean_square(const double *noises, int count, const AllotPlan *plan);

#endif
