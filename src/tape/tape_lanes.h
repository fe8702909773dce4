/* Tapes over reduced affine forms of several pieces of a line at once. */
#ifndef VTS_TAPE_TAPE_LANES_H
#define VTS_TAPE_TAPE_LANES_H

#include "base/vec.h"
#include "tape/affine_lanes.h"
#include "tape/tape.h"
#include "tape/tape_reach.h"

/* As tape_eval_affine(), for every lane; lanes of which nothing is known have an error that is not below infinity. The tape has one
 * output. The scratch has tape_scratch_size() lanes. */
void tape_eval_lanes(const Tape *tape, const AffineLanes *in, AffineLanes *out, AffineLanes *scratch);
/* The same with the inputs where a tape with as many inputs has left them: at the beginning of `scratch`. Returns where the output is:
 * in `scratch`, or, of a constant, *filled. `cells` (node_cache.h): what noises of points keep from one call to the next; or NULL. */
const AffineLanes *tape_eval_lanes_again(const Tape *tape, AffineLanes *scratch, AffineLanes *filled, struct NodeCache *cells);

/* A function as a sum of functions, so that a bound of the sum needs no more of them than tell it apart from zero. */
typedef struct TapeTerm {
    const Tape *tape;
    double scale;
    double low, high; /* of scale times the function, over the box; the widest come first */
    double middle, half; /* the same range; half is infinite where it has no end */
    double rounding;  /* if it is a sum itself: the size of what it adds, over the box */
    /* What stands for it where it is finer than the width of what looks (tape_detail.h): from one width on less of it, from the other
     * on only its mean. Infinite: it stays. */
    double mean, full, gone;
    const struct TapeNoise *noise; /* it is one of a linear function of the place (tape_noise.h); or NULL */
} TapeTerm;

typedef struct TapeSum {
    TapeTerm *terms;
    size_t count, scratch_size; /* of the largest term */
    double constant;
    /* The terms from k on are within rest_half of rest_middle, their absolute values at most rest_size; [count] is 0. */
    const double *rest_middle, *rest_half, *rest_size;
    TapeReach reach;
} TapeSum;

struct Interval;
/* Of a tape with one output, over a box of inputs; lives in `arena`. */
TapeSum tape_sum_of(const Tape *tape, const struct Interval *box, Arena *arena);

/* Bounds of the sum less `level` in all lanes; terms that the answer to "may it be 0?" does not need count as their ranges. What is
 * unknown in a lane is so in the sum. `width`: of what looks, along the same pieces; NULL: 0. The scratch has scratch_size lanes, the inputs
 * first. Returns how many terms were evaluated. */
size_t tape_sum_lanes(const TapeSum *sum, double level, const AffineLanes *width, AffineLanes *restrict out, AffineLanes *restrict scratch);

/* Terms that were bounded on a longer piece, and are so smooth there that parts of it need no more. */
typedef struct TapeSettled {
    uint32_t terms; /* a bit for each, of the first TAPE_SETTLED_MOST; 0: there are none */
    double centre[AFFINE_LANES], slope[AFFINE_LANES], error[AFFINE_LANES]; /* their sum's, on the pieces of the lanes */
    double size[AFFINE_LANES]; /* of what was added up to it */
} TapeSettled;

enum { TAPE_SETTLED_MOST = 24, TAPE_TERMS_MOST = 96 };

/* Bounds of the terms one by one. */
typedef struct TapeEach {
    uint32_t terms; /* a bit for each that was evaluated, of the first TAPE_SETTLED_MOST */
    AffineLanes of[TAPE_SETTLED_MOST];
} TapeEach;

/* The pieces that the forms in the scratch are those of, for terms that need no more: middle ± half of a line from a place along a
 * direction. */
typedef struct TapePieces {
    const double *middle, *half;
    const struct TapeNoiseWay *ways; /* of the terms by their numbers, made by tape_sum_begin() */
} TapePieces;

/* ways[k] for the terms that are noises; there is room for sum->count. */
void tape_sum_begin(const TapeSum *sum, Vec3 origin, Vec3 direction, struct TapeNoiseWay *ways);

/* The same where `settled` stands for some of the terms; *each gets the others that were evaluated, unless it is NULL. `pieces`: or NULL. `cells` as above. */
size_t tape_sum_rest(const TapeSum *sum, double level, const AffineLanes *width, const TapeSettled *settled, const TapePieces *pieces,
                     AffineLanes *restrict out, TapeEach *restrict each, AffineLanes *restrict scratch, struct NodeCache *cells);

#endif
